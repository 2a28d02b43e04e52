// Gmsh's MSH 4.1. Node tags are indices plus one and element tags run through segments, triangles and tets in the order
// of the mesh, so that a reader can restore that order although the file groups everything by entity. What MSH has no
// place for (unit, colours, names longer than Gmsh takes) goes to a section of our own at the end, which other readers
// skip.
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "io/labels.h"
#include "io/writers.h"

namespace curvetet {

namespace {

/// The numbers of a record, as text separated by blanks or as the format's binary types.
class Fields {
 public:
  Fields(OutputFile& file, bool binary) : file_(file), binary_(binary) {}
  void integer(std::int64_t value) {
    if (binary_) {
      file_.raw(static_cast<std::int32_t>(value));
    } else {
      text(value);
    }
  }
  void count(std::size_t value) {
    if (binary_) {
      file_.raw(static_cast<std::uint64_t>(value));
    } else {
      text(value);
    }
  }
  void real(double value) {
    const double safe = std::isfinite(value) ? value : 0;
    if (binary_) {
      file_.raw(safe);
    } else {
      text(safe);
    }
  }
  void end() {
    if (!binary_) file_.put('\n');
    first_ = true;
  }
  void end_section(const char* name) {
    if (binary_) file_.put('\n');
    file_.line(name);
  }

 private:
  template <class Number>
  void text(Number value) {
    if (!first_) file_.put(' ');
    first_ = false;
    file_.put(value);
  }
  OutputFile& file_;
  bool binary_ = false;
  bool first_ = true;
};

/// Indices of the items of each entity, in ascending order.
class ByEntity {
 public:
  ByEntity(std::size_t entities, std::size_t items, const auto& entity_of) : first_(entities + 1, 0), items_(items) {
    for (std::size_t i = 0; i < items; ++i) ++first_[entity_of(i) + 1];
    for (std::size_t e = 0; e < entities; ++e) first_[e + 1] += first_[e];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < items; ++i) items_[next[entity_of(i)]++] = static_cast<std::uint32_t>(i);
  }
  std::span<const std::uint32_t> of(std::size_t entity) const {
    return std::span(items_).subspan(first_[entity], first_[entity + 1] - first_[entity]);
  }
  std::size_t blocks() const {
    std::size_t n = 0;
    for (std::size_t e = 0; e + 1 < first_.size(); ++e) n += first_[e + 1] > first_[e] ? 1 : 0;
    return n;
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> items_;
};

using AllGroups = std::array<PhysicalGroups, 4>;

void write_names(const AllGroups& groups, OutputFile& file) {
  std::size_t n = 0;
  for (const PhysicalGroups& of_dimension : groups) n += of_dimension.groups.size();
  file.line("$PhysicalNames");
  file.line(n);
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (const PhysicalGroup& group : groups[static_cast<std::size_t>(dimension)].groups) {
      file.line(dimension, group.tag, '"' + group.name + '"');
    }
  }
  file.line("$EndPhysicalNames");
}

void write_entity(const Mesh& mesh, int dimension, std::size_t index, std::uint32_t group,
                  const std::set<std::uint32_t>& lower, Fields& fields) {
  const Entity& entity = entities_of(mesh, dimension)[index];
  fields.integer(entity.cad_id);
  for (std::size_t i = 0; i < (dimension == 0 ? 3U : 6U); ++i) fields.real(entity.box[i]);
  fields.count(1);
  fields.integer(group);
  if (dimension > 0) {
    std::vector<std::int32_t> known;
    for (const std::int32_t id : entity.boundary) {
      if (lower.contains(static_cast<std::uint32_t>(id < 0 ? -std::int64_t{id} : id))) known.push_back(id);
    }
    fields.count(known.size());
    for (const std::int32_t id : known) fields.integer(id);
  }
  fields.end();
}

void write_entities(const Mesh& mesh, const AllGroups& groups, OutputFile& file, Fields& fields) {
  file.line("$Entities");
  for (int dimension = 0; dimension < 4; ++dimension) fields.count(entities_of(mesh, dimension).size());
  fields.end();
  std::set<std::uint32_t> lower;
  for (int dimension = 0; dimension < 4; ++dimension) {
    const std::vector<Entity>& entities = entities_of(mesh, dimension);
    for (std::size_t i = 0; i < entities.size(); ++i) {
      write_entity(mesh, dimension, i, groups[static_cast<std::size_t>(dimension)].tag_of_entity[i], lower, fields);
    }
    lower.clear();
    for (const Entity& entity : entities) lower.insert(entity.cad_id);
  }
  fields.end_section("$EndEntities");
}

void write_node_block(const Mesh& mesh, int dimension, std::uint32_t tag, std::span<const std::uint32_t> nodes,
                      bool with_parameters, Fields& fields) {
  const bool parametric = with_parameters && (dimension == 1 || dimension == 2);
  fields.integer(dimension);
  fields.integer(tag);
  fields.integer(parametric ? 1 : 0);
  fields.count(nodes.size());
  fields.end();
  for (const std::uint32_t node : nodes) {
    fields.count(std::size_t{node} + 1);
    fields.end();
  }
  for (const std::uint32_t node : nodes) {
    for (const double coordinate : mesh.points[node]) fields.real(coordinate);
    for (int i = 0; parametric && i < dimension; ++i) {
      fields.real(mesh.nodes[node].parameter[static_cast<std::size_t>(i)]);
    }
    fields.end();
  }
}

void write_nodes(const Mesh& mesh, bool with_parameters, OutputFile& file, Fields& fields) {
  // All dimensions in one numbering of entities, lowest dimension first.
  std::array<std::size_t, 5> first{};
  for (int d = 0; d < 4; ++d)
    first[static_cast<std::size_t>(d) + 1] = first[static_cast<std::size_t>(d)] + entities_of(mesh, d).size();
  const ByEntity nodes(first[4], mesh.points.size(),
                       [&](std::size_t i) { return first[mesh.nodes[i].dimension] + mesh.nodes[i].entity; });
  file.line("$Nodes");
  fields.count(nodes.blocks());
  fields.count(mesh.points.size());
  fields.count(mesh.points.empty() ? 0 : 1);
  fields.count(mesh.points.size());
  fields.end();
  for (int dimension = 0; dimension < 4; ++dimension) {
    const std::vector<Entity>& entities = entities_of(mesh, dimension);
    for (std::size_t i = 0; i < entities.size(); ++i) {
      const auto block = nodes.of(first[static_cast<std::size_t>(dimension)] + i);
      if (!block.empty()) write_node_block(mesh, dimension, entities[i].cad_id, block, with_parameters, fields);
    }
  }
  fields.end_section("$EndNodes");
}

/// Node tag and parameters of every node on an edge or face, as text: readers find the end of a section that they do
/// not know by looking for a line with '$', which binary data could hold by chance.
void write_parameters(const Mesh& mesh, OutputFile& file) {
  file.line("$CurvetetParameters");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const NodeOnCad& node = mesh.nodes[i];
    if (node.dimension == 1) file.line(i + 1, node.parameter[0]);
    if (node.dimension == 2) file.line(i + 1, node.parameter[0], node.parameter[1]);
  }
  file.line("$EndCurvetetParameters");
}

/// The elements of one dimension: type 15, 1, 2 or 4.
struct ElementList {
  int dimension = 0, type = 0;
  std::size_t first_tag = 1;
  const std::uint32_t* corners = nullptr;
  std::size_t corners_each = 1;
  ByEntity by_entity;
};

void write_elements(const Mesh& mesh, OutputFile& file, Fields& fields) {
  std::vector<std::uint32_t> corner_vertex, corner_node;
  for (std::size_t v = 0; v < mesh.corner_nodes.size(); ++v) {
    if (mesh.corner_nodes[v] == UINT32_MAX) continue;
    corner_vertex.push_back(static_cast<std::uint32_t>(v));
    corner_node.push_back(mesh.corner_nodes[v]);
  }
  const auto grouped = [&](const std::vector<Entity>& entities, const std::vector<std::uint32_t>& entity_of) {
    return ByEntity(entities.size(), entity_of.size(), [&](std::size_t i) { return entity_of[i]; });
  };
  const std::size_t segments = 1 + corner_node.size(), triangles = segments + mesh.segments.size(),
                    tets = triangles + mesh.triangles.size(), last = tets + mesh.tets.size() - 1;
  const std::array<ElementList, 4> lists{
      ElementList{0, 15, 1, corner_node.data(), 1, grouped(mesh.vertices, corner_vertex)},
      ElementList{1, 1, segments, mesh.segments.empty() ? nullptr : mesh.segments[0].data(), 2,
                  grouped(mesh.edges, mesh.segment_edge)},
      ElementList{2, 2, triangles, mesh.triangles.empty() ? nullptr : mesh.triangles[0].data(), 3,
                  grouped(mesh.faces, mesh.triangle_face)},
      ElementList{3, 4, tets, mesh.tets.empty() ? nullptr : mesh.tets[0].data(), 4,
                  grouped(mesh.solids, mesh.tet_solid)}};
  std::size_t blocks = 0;
  for (const ElementList& list : lists) blocks += list.by_entity.blocks();
  file.line("$Elements");
  fields.count(blocks);
  fields.count(last);
  fields.count(last > 0 ? 1 : 0);
  fields.count(last);
  fields.end();
  for (const ElementList& list : lists) {
    const std::vector<Entity>& entities = entities_of(mesh, list.dimension);
    for (std::size_t e = 0; e < entities.size(); ++e) {
      const auto block = list.by_entity.of(e);
      if (block.empty()) continue;
      fields.integer(list.dimension);
      fields.integer(entities[e].cad_id);
      fields.integer(list.type);
      fields.count(block.size());
      fields.end();
      for (const std::uint32_t element : block) {
        fields.count(list.first_tag + element);
        for (std::size_t c = 0; c < list.corners_each; ++c) {
          fields.count(std::size_t{list.corners[element * list.corners_each + c]} + 1);
        }
        fields.end();
      }
    }
  }
  fields.end_section("$EndElements");
}

}  // namespace

void write_msh41(const Mesh& mesh, const Msh41Options& options, OutputFile& file) {
  AllGroups groups;
  for (int d = 0; d < 4; ++d) groups[static_cast<std::size_t>(d)] = physical_groups(entities_of(mesh, d), d);
  Fields fields(file, options.binary);
  file.line("$MeshFormat");
  file.line("4.1", options.binary ? 1 : 0, 8);
  if (options.binary) {
    file.raw(std::int32_t{1});
    file.put('\n');
  }
  file.line("$EndMeshFormat");
  write_names(groups, file);
  write_entities(mesh, groups, file, fields);
  write_nodes(mesh, options.parametric_nodes, file, fields);
  write_elements(mesh, file, fields);
  if (!options.parametric_nodes) write_parameters(mesh, file);
  file.line("$CurvetetLabels");
  for (const std::string& label : label_lines(mesh, false)) file.line(label);
  file.line("$EndCurvetetLabels");
}

}  // namespace curvetet
