// Gmsh's MSH 4.1 and 2.2, also those that Gmsh itself wrote. Our own sections are looked for first, since they hold the
// order and the exact names of the entities. An element type that a Mesh has no place for is an error, never skipped.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "io/mesh_builder.h"
#include "io/readers.h"
#include "io/scanner.h"

namespace curvetet {

namespace {

/// Dimension of an element type that we read.
int dimension_of(std::int64_t type) {
  switch (type) {
    case 15:
      return 0;
    case 1:
      return 1;
    case 2:
      return 2;
    case 4:
      return 3;
    default:
      break;
  }
  throw BadFile{
      fmt::format("element type {} is not read: only points, lines, triangles and tetrahedra of first order", type)};
}

class MshReader {
 public:
  explicit MshReader(std::string_view file) : in_(file), file_(file) {}
  Mesh read();

 private:
  std::int64_t integer() { return binary_ ? in_.raw<std::int32_t>() : in_.number<std::int64_t>(); }
  std::uint64_t count() { return binary_ && !old_ ? in_.raw<std::uint64_t>() : in_.number<std::uint64_t>(); }
  double real() { return binary_ ? in_.raw<double>() : in_.number<double>(); }

  void read_format();
  void read_own_labels();
  void read_own_parameters();
  void read_physical_names();
  void read_entities();
  void read_nodes();
  void read_node_block();
  void read_elements();
  void read_old_nodes();
  void read_old_elements();
  void read_old_binary_elements(std::uint64_t n);
  void add_old_element(std::int64_t tag, std::int64_t type, std::int64_t n_tags);
  void read_section(std::string_view section);
  void name_by_groups();

  Scanner in_;
  std::string_view file_;
  bool binary_ = false, old_ = false;
  MeshBuilder builder_;
  std::map<std::pair<int, std::int64_t>, std::string> group_names_;               // by dimension and tag
  std::map<std::pair<int, std::uint32_t>, std::vector<std::int64_t>> groups_of_;  // by dimension and entity
};

void MshReader::read_format() {
  if (in_.line() != "$MeshFormat") in_.fail("the file does not begin with $MeshFormat");
  const std::string version(in_.word());
  binary_ = in_.number<int>() == 1;
  const int data_size = in_.number<int>();
  in_.line();
  old_ = version == "2.2" || version == "2.1" || version == "2";
  if (!old_ && version != "4.1")
    in_.fail("MSH version " + Scanner::shown(version) + " is not read: save as 4.1 or 2.2");
  if (data_size != 8) in_.fail("only files with a data size of 8 are read");
  if (binary_ && in_.raw<std::int32_t>() != 1) in_.fail("the file has the byte order of another kind of machine");
  in_.skip_past("$EndMeshFormat");
  in_.line();
}

void MshReader::read_own_labels() {
  const std::string_view begin = "$CurvetetLabels\n";
  const std::size_t found = file_.rfind(begin);
  if (found == std::string_view::npos) return;
  Scanner labels(file_.substr(found + begin.size()));
  while (!labels.at_end()) {
    const std::string_view line = labels.line();
    if (line.starts_with('$')) return;
    if (!builder_.entities().apply_label_line(line)) labels.fail("a line of $CurvetetLabels is not a label");
  }
}

void MshReader::read_own_parameters() {
  for (in_.skip_blanks(); !in_.rest().starts_with('$'); in_.skip_blanks()) {
    Scanner line(in_.line());
    const auto tag = line.number<std::uint64_t>();
    std::array<double, 2> parameter{line.number<double>(), 0};
    line.skip_blanks();
    if (!line.at_end()) parameter[1] = line.number<double>();
    builder_.set_parameter(tag, parameter);
  }
}

void MshReader::read_physical_names() {
  const auto n = in_.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < n; ++i) {
    const int dimension = in_.number<int>();
    const auto tag = in_.number<std::int64_t>();
    const std::string_view text = in_.line();
    const std::size_t open = text.find('"'), close = text.rfind('"');
    if (open == close) in_.fail("a physical name has no quotes");
    group_names_[{dimension, tag}] = std::string(text.substr(open + 1, close - open - 1));
  }
}

void MshReader::read_entities() {
  std::array<std::uint64_t, 4> n{};
  for (std::uint64_t& of_dimension : n) of_dimension = count();
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::uint64_t i = 0; i < n[static_cast<std::size_t>(dimension)]; ++i) {
      const std::int64_t tag = integer();
      if (tag < 0) in_.fail("an entity has a negative tag");
      const std::uint32_t index = builder_.entities().find_or_add(dimension, static_cast<std::uint32_t>(tag));
      std::array<double, 6> box{};
      for (std::size_t b = 0; b < (dimension == 0 ? 3U : 6U); ++b) box[b] = real();
      if (dimension == 0) std::copy_n(box.begin(), 3, box.begin() + 3);
      std::vector<std::int64_t>& groups = groups_of_[{dimension, index}];
      for (std::uint64_t left = count(); left > 0; --left) groups.push_back(std::abs(integer()));
      std::vector<std::int32_t> boundary;
      for (std::uint64_t left = dimension > 0 ? count() : 0; left > 0; --left) {
        boundary.push_back(static_cast<std::int32_t>(integer()));
      }
      Entity& entity = entities_of(builder_.mesh(), dimension)[index];
      entity.box = box;
      entity.boundary = std::move(boundary);
    }
  }
}

void MshReader::read_node_block() {
  const std::int64_t dimension = integer(), entity = integer(), parametric = integer();
  if (dimension < 0 || dimension > 3) in_.fail("a block of nodes has an impossible dimension");
  const std::uint64_t n = count();
  std::vector<std::uint64_t> tags;
  for (std::uint64_t i = 0; i < n; ++i) tags.push_back(count());
  for (const std::uint64_t tag : tags) {
    Point point{};
    for (double& coordinate : point) coordinate = real();
    std::array<double, 3> parameter{};
    for (std::int64_t p = 0; parametric != 0 && p < dimension; ++p) parameter[static_cast<std::size_t>(p)] = real();
    builder_.add_node(tag, point, static_cast<std::uint8_t>(dimension), entity,
                      dimension == 3 ? std::array<double, 2>{} : std::array<double, 2>{parameter[0], parameter[1]});
  }
}

void MshReader::read_nodes() {
  const std::uint64_t blocks = count();
  for (int i = 0; i < 3; ++i) count();
  for (std::uint64_t b = 0; b < blocks; ++b) read_node_block();
}

void MshReader::read_elements() {
  const std::uint64_t blocks = count();
  for (int i = 0; i < 3; ++i) count();
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::int64_t dimension = integer(), entity = integer(), type = integer();
    if (dimension_of(type) != dimension) in_.fail("a block of elements has the wrong dimension");
    std::array<std::uint64_t, 4> nodes{};
    const std::size_t corners = static_cast<std::size_t>(dimension) + 1;
    for (std::uint64_t n = count(); n > 0; --n) {
      const std::uint64_t tag = count();
      for (std::size_t c = 0; c < corners; ++c) nodes[c] = count();
      builder_.add_element(static_cast<int>(dimension), tag, entity, std::span(nodes).first(corners));
    }
  }
}

void MshReader::read_old_nodes() {
  const auto n = in_.number<std::uint64_t>();
  in_.line();
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::int64_t tag = integer();
    if (tag < 0) in_.fail("a node has a negative tag");
    Point point{};
    for (double& coordinate : point) coordinate = real();
    builder_.add_node(static_cast<std::uint64_t>(tag), point, MeshBuilder::kUnknown, 0, {});
  }
}

void MshReader::add_old_element(std::int64_t tag, std::int64_t type, std::int64_t n_tags) {
  const int dimension = dimension_of(type);
  std::int64_t group = 0, entity = 0;
  if (tag < 0 || n_tags < 0) in_.fail("an element has a negative tag");
  for (std::int64_t i = 0; i < n_tags; ++i) {
    const std::int64_t value = integer();
    if (i == 0) group = entity = value;
    if (i == 1) entity = value;
  }
  std::array<std::uint64_t, 4> nodes{};
  const std::size_t corners = static_cast<std::size_t>(dimension) + 1;
  for (std::size_t c = 0; c < corners; ++c) {
    const std::int64_t node = integer();
    if (node < 0) in_.fail("a node has a negative tag");
    nodes[c] = static_cast<std::uint64_t>(node);
  }
  builder_.add_element(dimension, static_cast<std::uint64_t>(tag), entity, std::span(nodes).first(corners));
  std::vector<std::int64_t>& groups =
      groups_of_[{dimension, builder_.entities().find_or_add(dimension, static_cast<std::uint32_t>(entity))}];
  if (groups.empty()) groups.push_back(group);
}

void MshReader::read_old_binary_elements(std::uint64_t n) {
  while (n > 0) {
    const std::int64_t type = integer(), in_block = integer(), n_tags = integer();
    if (in_block <= 0 || static_cast<std::uint64_t>(in_block) > n)
      in_.fail("a block of elements has an impossible size");
    for (std::int64_t i = 0; i < in_block; ++i) add_old_element(integer(), type, n_tags);
    n -= static_cast<std::uint64_t>(in_block);
  }
}

void MshReader::read_old_elements() {
  const auto n = in_.number<std::uint64_t>();
  in_.line();
  if (binary_) return read_old_binary_elements(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    const std::int64_t tag = integer(), type = integer(), n_tags = integer();
    add_old_element(tag, type, n_tags);
  }
}

void MshReader::read_section(std::string_view section) {
  if (section == "PhysicalNames") {
    read_physical_names();
  } else if (section == "Entities" && !old_) {
    read_entities();
  } else if (section == "Nodes") {
    old_ ? read_old_nodes() : read_nodes();
  } else if (section == "Elements") {
    old_ ? read_old_elements() : read_elements();
  } else if (section == "CurvetetParameters") {
    read_own_parameters();
  }
  in_.skip_past("$End" + std::string(section));
  in_.line();
}

void MshReader::name_by_groups() {
  for (const auto& [key, groups] : groups_of_) {
    const auto& [dimension, index] = key;
    Entity& entity = entities_of(builder_.mesh(), dimension)[index];
    for (const std::int64_t group : groups) {
      const auto name = group_names_.find({dimension, group});
      if (entity.name.empty() && name != group_names_.end()) entity.name = name->second;
    }
  }
}

Mesh MshReader::read() {
  read_format();
  read_own_labels();
  for (in_.skip_blanks(); !in_.at_end(); in_.skip_blanks()) {
    const std::string_view line = in_.line();
    if (!line.starts_with('$')) in_.fail("a section was expected, not '" + Scanner::shown(line) + "'");
    read_section(line.substr(1));
  }
  name_by_groups();
  return builder_.finish();
}

}  // namespace

Mesh read_msh(std::string_view file) { return MshReader(file).read(); }

}  // namespace curvetet
