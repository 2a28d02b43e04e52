// Reads the .vtu files of write_vtu and no others: VTK's XML has too many forms to read them all for nothing but a
// check, and a foreign file would lack the labels. The directory is read tag by tag; the arrays are taken from the
// appended data.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/mesh_builder.h"
#include "io/readers.h"
#include "io/scanner.h"

namespace curvetet {

namespace {

std::string_view attribute(std::string_view tag, const std::string& name) {
  const std::string opening = " " + name + "=\"";
  const std::size_t begin = tag.find(opening);
  if (begin == std::string_view::npos) return {};
  const std::size_t from = begin + opening.size(), end = tag.find('"', from);
  return end == std::string_view::npos ? std::string_view() : tag.substr(from, end - from);
}

class VtuReader {
 public:
  explicit VtuReader(std::string_view file) : file_(file) {}
  Mesh read();

 private:
  struct Place {
    std::string type;
    std::uint64_t offset = 0;
  };
  void read_directory();
  void read_tag(std::string_view tag);
  std::string_view bytes_of(const std::string& name, const std::string& type) const;
  template <class T>
  std::vector<T> values(const std::string& name, const std::string& type) const;
  void add_nodes();
  void add_cells();

  std::string_view file_, data_;
  std::string section_;
  std::map<std::string, Place> places_;  // by "section/name"
  std::uint64_t points_ = 0;
  MeshBuilder builder_;
};

void VtuReader::read_tag(std::string_view tag) {
  if (tag.starts_with("VTKFile") &&
      (attribute(tag, "type") != "UnstructuredGrid" || attribute(tag, "byte_order") != "LittleEndian" ||
       attribute(tag, "header_type") != "UInt64" || !attribute(tag, "compressor").empty())) {
    throw BadFile{"the file is not one that curvetet wrote; convert it to .msh"};
  }
  for (const char* section : {"FieldData", "PointData", "CellData", "Points", "Cells"}) {
    if (tag == section || tag.starts_with(std::string(section) + " ")) section_ = section;
  }
  if (tag.starts_with("Piece ")) points_ = Scanner(attribute(tag, "NumberOfPoints")).number<std::uint64_t>();
  if (!tag.starts_with("DataArray ")) return;
  if (attribute(tag, "format") != "appended")
    throw BadFile{"an array is not appended: the file is not one that curvetet wrote"};
  Place& place = places_[section_ + "/" + std::string(attribute(tag, "Name"))];
  place.type = attribute(tag, "type");
  place.offset = Scanner(attribute(tag, "offset")).number<std::uint64_t>();
}

void VtuReader::read_directory() {
  Scanner in(file_);
  for (;;) {
    in.skip_past("<");
    const std::string_view rest = in.rest();
    const std::string_view tag = rest.substr(0, rest.find('>'));
    in.skip_past(">");
    if (tag.starts_with("AppendedData")) {
      if (attribute(tag, "encoding") != "raw") in.fail("the appended data are not raw");
      in.skip_past("_");
      data_ = in.rest();
      return;
    }
    read_tag(tag);
  }
}

std::string_view VtuReader::bytes_of(const std::string& name, const std::string& type) const {
  const auto place = places_.find(name);
  if (place == places_.end() || place->second.type != type) {
    throw BadFile{fmt::format("there is no {} array {}: the file is not one that curvetet wrote", type, name)};
  }
  if (place->second.offset > data_.size()) throw BadFile{"the file ends too early"};
  Scanner in(data_.substr(place->second.offset));
  const auto size = in.raw<std::uint64_t>();
  if (size > in.remaining()) in.fail("the file ends too early");
  return in.rest().substr(0, size);
}

template <class T>
std::vector<T> VtuReader::values(const std::string& name, const std::string& type) const {
  const std::string_view bytes = bytes_of(name, type);
  std::vector<T> result(bytes.size() / sizeof(T));
  if (!result.empty()) std::memcpy(result.data(), bytes.data(), result.size() * sizeof(T));
  return result;
}

void VtuReader::add_nodes() {
  const auto coordinates = values<double>("Points/points", "Float64");
  const auto dimensions = values<std::uint8_t>("PointData/cad_dimension", "UInt8");
  const auto ids = values<std::int32_t>("PointData/cad_id", "Int32");
  const auto parameters = values<double>("PointData/cad_parameter", "Float64");
  const std::size_t n = dimensions.size();
  if (points_ != n || coordinates.size() != 3 * n || ids.size() != n || parameters.size() != 2 * n) {
    throw BadFile{"the arrays of the points do not have the same length"};
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (dimensions[i] > 3) throw BadFile{fmt::format("point {} has an impossible dimension", i)};
    builder_.add_node(i, {coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}, dimensions[i], ids[i],
                      {parameters[2 * i], parameters[2 * i + 1]});
  }
}

void VtuReader::add_cells() {
  const auto connectivity = values<std::int32_t>("Cells/connectivity", "Int32");
  const auto dimensions = values<std::uint8_t>("CellData/dimension", "UInt8");
  std::array<std::vector<std::int32_t>, 4> ids;
  constexpr const char* kNames[] = {"vertex", "edge", "face", "solid"};
  for (std::size_t d = 0; d < 4; ++d) {
    ids[d] = values<std::int32_t>(std::string("CellData/") + kNames[d], "Int32");
    if (ids[d].size() != dimensions.size()) throw BadFile{"the arrays of the cells do not have the same length"};
  }
  std::size_t at = 0;
  std::array<std::uint64_t, 4> nodes{};
  for (std::size_t i = 0; i < dimensions.size(); ++i) {
    const std::size_t d = dimensions[i];
    if (d > 3 || at + d + 1 > connectivity.size()) throw BadFile{fmt::format("cell {} is broken", i)};
    for (std::size_t c = 0; c <= d; ++c) nodes[c] = static_cast<std::uint64_t>(std::int64_t{connectivity[at + c]});
    at += d + 1;
    builder_.add_element(static_cast<int>(d), i, ids[d][i], std::span(nodes).first(d + 1));
  }
  if (at != connectivity.size()) throw BadFile{"the cells do not use all of the connectivity"};
}

Mesh VtuReader::read() {
  read_directory();
  Scanner labels(bytes_of("FieldData/labels", "UInt8"));
  while (!labels.at_end()) {
    if (!builder_.entities().apply_label_line(labels.line())) labels.fail("a line of the labels is not a label");
  }
  add_nodes();
  add_cells();
  return builder_.finish();
}

}  // namespace

Mesh read_vtu(std::string_view file) { return VtuReader(file).read(); }

}  // namespace curvetet
