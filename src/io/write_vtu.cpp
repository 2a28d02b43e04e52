// VTK's XML for unstructured grids, with raw appended data: the fastest form for ParaView, and meshio reads it. One
// grid holds the tets, then the labelled triangles, segments and corners, told apart by the cell array "dimension".
// Names are UTF-8 bytes in field data and not VTK strings, because meshio refuses a file with strings in it.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "io/labels.h"
#include "io/writers.h"

namespace curvetet {

namespace {

/// One array of the file: how it is announced, how long it is, and what puts its bytes.
struct Array {
  std::string name, type;
  int components = 1;
  std::size_t bytes = 0;
  std::function<void(OutputFile&)> put;
};

template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

/// An array of n values of type T, given by index.
template <class T>
Array array_of(std::string name, int components, std::size_t n, std::function<T(std::size_t)> value) {
  return {std::move(name), vtk_type<T>(), components, n * sizeof(T), [n, value = std::move(value)](OutputFile& file) {
            for (std::size_t i = 0; i < n; ++i) file.raw(value(i));
          }};
}

/// All cells in the order tets, triangles, segments, corners.
class Cells {
 public:
  explicit Cells(const Mesh& mesh) : mesh_(mesh) {
    for (std::size_t v = 0; v < mesh.corner_nodes.size(); ++v) {
      if (mesh.corner_nodes[v] != UINT32_MAX) corners_.push_back(static_cast<std::uint32_t>(v));
    }
    first_[1] = mesh.tets.size();
    first_[2] = first_[1] + mesh.triangles.size();
    first_[3] = first_[2] + mesh.segments.size();
    first_[4] = first_[3] + corners_.size();
    CURVETET_CHECK(connections() <= std::size_t{std::numeric_limits<std::int32_t>::max()});
  }
  std::size_t size() const { return first_[4]; }
  std::size_t connections() const { return offset(size()); }
  int dimension(std::size_t cell) const {
    return cell < first_[1] ? 3 : cell < first_[2] ? 2 : cell < first_[3] ? 1 : 0;
  }
  /// Where the nodes of a cell begin among the nodes of all cells.
  std::size_t offset(std::size_t cell) const {
    const auto within = [&](int list) { return std::clamp(cell, first_[list], first_[list + 1]) - first_[list]; };
    return 4 * within(0) + 3 * within(1) + 2 * within(2) + within(3);
  }
  /// Cad id of a cell's entity if it has this dimension, else 0.
  std::int32_t cad_id(std::size_t cell, int dimension_wanted) const {
    if (dimension(cell) != dimension_wanted) return 0;
    const std::size_t i = cell - first_[3 - dimension_wanted];
    const std::uint32_t entity = dimension_wanted == 3   ? mesh_.tet_solid[i]
                                 : dimension_wanted == 2 ? mesh_.triangle_face[i]
                                 : dimension_wanted == 1 ? mesh_.segment_edge[i]
                                                         : corners_[i];
    return static_cast<std::int32_t>(entities_of(mesh_, dimension_wanted)[entity].cad_id);
  }
  void put_nodes(OutputFile& file) const {
    const auto put = [&](const auto& list) {
      for (const auto& element : list) {
        for (const std::uint32_t node : element) file.raw(static_cast<std::int32_t>(node));
      }
    };
    put(mesh_.tets);
    put(mesh_.triangles);
    put(mesh_.segments);
    for (const std::uint32_t v : corners_) file.raw(static_cast<std::int32_t>(mesh_.corner_nodes[v]));
  }

 private:
  const Mesh& mesh_;
  std::vector<std::uint32_t> corners_;
  std::size_t first_[5]{};
};

std::vector<Array> cell_arrays(const Cells& cells) {
  return {{"connectivity", "Int32", 1, cells.connections() * sizeof(std::int32_t),
           [&cells](OutputFile& file) { cells.put_nodes(file); }},
          array_of<std::int32_t>("offsets", 1, cells.size(),
                                 [&cells](std::size_t i) { return static_cast<std::int32_t>(cells.offset(i + 1)); }),
          array_of<std::uint8_t>("types", 1, cells.size(), [&cells](std::size_t i) {
            constexpr std::uint8_t kTypes[] = {1, 3, 5, 10};
            return kTypes[cells.dimension(i)];
          })};
}

std::vector<Array> cell_data(const Cells& cells) {
  std::vector<Array> arrays{array_of<std::uint8_t>(
      "dimension", 1, cells.size(), [&cells](std::size_t i) { return static_cast<std::uint8_t>(cells.dimension(i)); })};
  constexpr const char* kNames[] = {"vertex", "edge", "face", "solid"};
  for (int d = 3; d >= 0; --d) {
    arrays.push_back(
        array_of<std::int32_t>(kNames[d], 1, cells.size(), [&cells, d](std::size_t i) { return cells.cad_id(i, d); }));
  }
  return arrays;
}

std::vector<Array> point_data(const Mesh& mesh) {
  return {
      array_of<std::uint8_t>("cad_dimension", 1, mesh.nodes.size(),
                             [&mesh](std::size_t i) { return mesh.nodes[i].dimension; }),
      array_of<std::int32_t>("cad_id", 1, mesh.nodes.size(),
                             [&mesh](std::size_t i) {
                               const NodeOnCad& node = mesh.nodes[i];
                               return static_cast<std::int32_t>(entities_of(mesh, node.dimension)[node.entity].cad_id);
                             }),
      array_of<double>("cad_parameter", 2, 2 * mesh.nodes.size(),
                       [&mesh](std::size_t i) { return mesh.nodes[i / 2].parameter[i % 2]; })};
}

/// Announces arrays and gives each its place behind those announced before.
class Directory {
 public:
  explicit Directory(OutputFile& file) : file_(file) {}
  void section(const std::string& tag, const std::string& attributes, const std::vector<Array>& arrays) {
    file_.put("<" + tag + attributes + ">\n");
    for (const Array& array : arrays) {
      file_.put("<DataArray type=\"" + array.type + "\" Name=\"" + array.name + "\" NumberOfComponents=\"" +
                std::to_string(array.components) + "\"");
      if (tag == "FieldData") file_.put(" NumberOfTuples=\"" + std::to_string(array.bytes) + "\"");
      file_.put(" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n");
      offset_ += sizeof(std::uint64_t) + array.bytes;
      all_.push_back(&array);
    }
    file_.put("</" + tag + ">\n");
  }
  void put_data() const {
    for (const Array* array : all_) {
      file_.raw(static_cast<std::uint64_t>(array->bytes));
      array->put(file_);
    }
  }

 private:
  OutputFile& file_;
  std::size_t offset_ = 0;
  std::vector<const Array*> all_;
};

}  // namespace

void write_vtu(const Mesh& mesh, OutputFile& file) {
  std::string labels;
  for (const std::string& line : label_lines(mesh, true)) labels += line + '\n';
  const std::vector<Array> fields{
      {"labels", "UInt8", 1, labels.size(), [&labels](OutputFile& out) { out.put(labels); }}};
  const Cells cells(mesh);
  const std::vector<Array> points{array_of<double>("points", 3, 3 * mesh.points.size(),
                                                   [&mesh](std::size_t i) { return mesh.points[i / 3][i % 3]; })};
  const std::vector<Array> on_points = point_data(mesh), on_cells = cell_data(cells), grid = cell_arrays(cells);

  file.put(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n");
  Directory directory(file);
  directory.section("FieldData", "", fields);
  file.put("<Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
           std::to_string(cells.size()) + "\">\n");
  directory.section("PointData", "", on_points);
  directory.section("CellData", " Scalars=\"solid\"", on_cells);
  directory.section("Points", "", points);
  directory.section("Cells", "", grid);
  file.put("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  directory.put_data();
  file.put("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace curvetet
