#include "pipeline/join_parts.h"

#include <algorithm>

#include "pipeline/assemble.h"

namespace curvetet {

namespace {

template <class Key>
std::map<std::uint32_t, double> local_sizes(const std::map<std::uint32_t, double>& whole,
                                            const IndexedVector<Key, Key>& of_whole) {
  std::map<std::uint32_t, double> own;
  for (std::size_t i = 0; i < of_whole.size(); ++i) {
    const auto found = whole.find(of_whole[Key(i)].value());
    if (found != whole.end()) own.emplace(static_cast<std::uint32_t>(i), found->second);
  }
  return own;
}

/// What assembling adds to an entity's labels. Parts share edges and vertices; their boxes are the same but for where
/// the curve was cut, so the first one's will do.
template <class Key>
void take_entities(std::vector<Entity>& into, const std::vector<Entity>& own, const IndexedVector<Key, Key>& of_whole) {
  for (std::size_t i = 0; i < own.size(); ++i) {
    Entity& entity = into[of_whole[Key(i)].value()];
    if (entity.boundary.empty()) entity.boundary = own[i].boundary;
    if (entity.box == std::array<double, 6>{}) entity.box = own[i].box;
  }
}

template <class Key, std::size_t N>
void take_elements(std::vector<std::array<std::uint32_t, N>>& into, std::vector<std::uint32_t>& entity_of,
                   const std::vector<std::array<std::uint32_t, N>>& own, const std::vector<std::uint32_t>& own_entity,
                   const IndexedVector<Key, Key>& of_whole, std::uint32_t offset) {
  for (std::size_t i = 0; i < own.size(); ++i) {
    into.push_back(own[i]);
    for (std::uint32_t& node : into.back()) node += offset;
    entity_of.push_back(of_whole[Key(own_entity[i])].value());
  }
}

std::uint32_t entity_of_whole(const NodeOnCad& node, const Part& part) {
  switch (node.dimension) {
    case 0:
      return part.vertices[CadVertexId(node.entity)].value();
    case 1:
      return part.edges[EdgeId(node.entity)].value();
    case 2:
      return part.faces[FaceId(node.entity)].value();
    default:
      return part.solids[SolidId(node.entity)].value();
  }
}

template <class Row>
void sort_by(std::vector<Row>& rows, const std::vector<Entity>& entities) {
  std::map<std::uint32_t, std::size_t> place;
  for (std::size_t i = 0; i < entities.size(); ++i) place.emplace(entities[i].cad_id, i);
  std::sort(rows.begin(), rows.end(),
            [&](const Row& a, const Row& b) { return place.at(a.cad_id) < place.at(b.cad_id); });
}

}  // namespace

Settings settings_of(const Part& part, const Settings& whole) {
  Settings own = whole;
  own.sizing.face_size = local_sizes(whole.sizing.face_size, part.faces);
  own.sizing.edge_size = local_sizes(whole.sizing.edge_size, part.edges);
  own.sizing.solid_size = local_sizes(whole.sizing.solid_size, part.solids);
  return own;
}

Mesh empty_mesh(const Model& whole, const Settings& settings) {
  Mesh mesh;
  mesh.unit = settings.unit;
  add_labels(mesh, whole);
  mesh.corner_nodes.assign(mesh.vertices.size(), kNoNode);
  return mesh;
}

void append(Mesh& mesh, const Mesh& of_part, const Part& part) {
  const auto offset = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), of_part.points.begin(), of_part.points.end());
  for (NodeOnCad node : of_part.nodes) {
    node.entity = entity_of_whole(node, part);
    mesh.nodes.push_back(node);
  }
  take_elements(mesh.tets, mesh.tet_solid, of_part.tets, of_part.tet_solid, part.solids, offset);
  take_elements(mesh.triangles, mesh.triangle_face, of_part.triangles, of_part.triangle_face, part.faces, offset);
  take_elements(mesh.segments, mesh.segment_edge, of_part.segments, of_part.segment_edge, part.edges, offset);
  for (std::size_t v = 0; v < of_part.corner_nodes.size(); ++v) {
    std::uint32_t& corner = mesh.corner_nodes[part.vertices[CadVertexId(v)].value()];
    if (corner == kNoNode && of_part.corner_nodes[v] != kNoNode) corner = of_part.corner_nodes[v] + offset;
  }
  take_entities(mesh.solids, of_part.solids, part.solids);
  take_entities(mesh.faces, of_part.faces, part.faces);
  take_entities(mesh.edges, of_part.edges, part.edges);
  take_entities(mesh.vertices, of_part.vertices, part.vertices);
}

void sort_entities(Report& report, const Mesh& mesh) {
  sort_by(report.faces, mesh.faces);
  sort_by(report.solids, mesh.solids);
}

}  // namespace curvetet
