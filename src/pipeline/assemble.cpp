#include "pipeline/assemble.h"

#include <algorithm>
#include <bit>
#include <set>

#include "base/fnv.h"
#include "base/hilbert.h"
#include "boundary/surface_triangles.h"

namespace curvetet {

namespace {

class Assembly {
 public:
  Assembly(const Conjoint& conjoint, const Settings& settings)
      : conjoint_(conjoint),
        model_(conjoint.model()),
        settings_(settings),
        number_(conjoint.vertices().size(), kNoNode) {}

  Mesh run() {
    mesh_.unit = settings_.unit;
    number_vertices();
    add_tets();
    add_triangles();
    add_segments();
    add_entities();
    return std::move(mesh_);
  }

 private:
  /// Along a Hilbert curve, so that neighbours in space are neighbours in memory for all who use the mesh.
  void number_vertices() {
    const TetComplex& complex = conjoint_.tets()->complex();
    std::vector<char> used(number_.size(), 0);
    for (std::size_t t = 0; t < complex.slots(); ++t)
      if (is_inside(TetId(t)))
        for (VertexId v : complex.vertices(TetId(t))) used[v.value()] = 1;
    std::vector<std::pair<std::uint64_t, VertexId>> order;
    for (std::size_t v = 0; v < used.size(); ++v)
      if (used[v] != 0) order.emplace_back(hilbert_index(conjoint_.vertices().position(VertexId(v))), VertexId(v));
    std::sort(order.begin(), order.end());
    for (const auto& [place, v] : order) {
      number_[v.value()] = static_cast<std::uint32_t>(mesh_.points.size());
      add_point(v);
    }
  }

  bool is_inside(TetId t) const {
    const TetComplex& complex = conjoint_.tets()->complex();
    return complex.is_alive(t) && complex.region(t) > 0;
  }

  void add_point(VertexId v) {
    const Vec3 p = settings_.unit_scale * model_.frame.to_cad(conjoint_.vertices().position(v));
    mesh_.points.push_back({p.x, p.y, p.z});
    const Owner owner = conjoint_.vertices().owner(v);
    const Vec2 q = conjoint_.vertices().parameter(v);
    NodeOnCad node;
    node.dimension = static_cast<std::uint8_t>(owner.kind);
    node.entity = owner.index;
    node.parameter = {owner.kind == OwnerKind::edge ? model_.edges[EdgeId(owner.index)].own_parameter(q.x) : q.x, q.y};
    mesh_.nodes.push_back(node);
  }

  /// Refinement has put them in order along the curve, too.
  void add_tets() {
    const TetComplex& complex = conjoint_.tets()->complex();
    for (std::size_t t = 0; t < complex.slots(); ++t) {
      if (!is_inside(TetId(t))) continue;
      const auto& v = complex.vertices(TetId(t));
      mesh_.tets.push_back({number(v[0]), number(v[1]), number(v[2]), number(v[3])});
      mesh_.tet_solid.push_back(complex.region(TetId(t)) - 1);
    }
  }

  std::uint32_t number(VertexId v) const { return number_[v.value()]; }

  void add_triangles() {
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary())) {
      const bool reversed = model_.faces[t.face].reversed;
      mesh_.triangles.push_back(
          {number(t.vertices[0]), number(t.vertices[reversed ? 2 : 1]), number(t.vertices[reversed ? 1 : 2])});
      mesh_.triangle_face.push_back(t.face.value());
    }
  }

  void add_segments() {
    for (const Conjoint::Segment& s : conjoint_.segments()) {
      if (number(s.a) == kNoNode || number(s.b) == kNoNode) continue;
      mesh_.segments.push_back({number(s.a), number(s.b)});
      mesh_.segment_edge.push_back(s.edge.value());
    }
    for (VertexId v : conjoint_.boundary().cad_vertices) mesh_.corner_nodes.push_back(v.valid() ? number(v) : kNoNode);
  }

  /// What bounds what, as this mesh has it.
  void add_entities() {
    add_labels(mesh_, model_);
    for (std::size_t f = 0; f < model_.faces.size(); ++f) add_face_boundary(FaceId(f));
    add_boxes();
  }

  void add_face_boundary(FaceId f) {
    std::set<std::int32_t> seen;
    for (const UseRef& use : conjoint_.boundary().uses[f]) {
      const ModelEdge& edge = model_.edges[use.edge];
      if (edge.degenerate) continue;
      const auto id = static_cast<std::int32_t>(edge.label.cad_id);
      if (seen.insert(id).second) mesh_.faces[f.value()].boundary.push_back(use.use->reversed ? -id : id);
    }
  }

  void add_boxes() {
    std::vector<Box3> solids(mesh_.solids.size()), faces(mesh_.faces.size()), edges(mesh_.edges.size()),
        vertices(mesh_.vertices.size());
    const auto extend = [&](Box3& box, std::uint32_t p) {
      box.extend({mesh_.points[p][0], mesh_.points[p][1], mesh_.points[p][2]});
    };
    for (std::size_t i = 0; i < mesh_.tets.size(); ++i)
      for (std::uint32_t p : mesh_.tets[i]) extend(solids[mesh_.tet_solid[i]], p);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (std::uint32_t p : mesh_.triangles[i]) extend(faces[mesh_.triangle_face[i]], p);
    for (std::size_t i = 0; i < mesh_.segments.size(); ++i)
      for (std::uint32_t p : mesh_.segments[i]) extend(edges[mesh_.segment_edge[i]], p);
    for (std::size_t i = 0; i < mesh_.corner_nodes.size(); ++i)
      if (mesh_.corner_nodes[i] != kNoNode) extend(vertices[i], mesh_.corner_nodes[i]);
    set_boxes(mesh_.solids, solids);
    set_boxes(mesh_.faces, faces);
    set_boxes(mesh_.edges, edges);
    set_boxes(mesh_.vertices, vertices);
  }

  static void set_boxes(std::vector<Entity>& entities, const std::vector<Box3>& boxes) {
    for (std::size_t i = 0; i < entities.size(); ++i)
      if (!boxes[i].empty())
        entities[i].box = {boxes[i].low.x,  boxes[i].low.y,  boxes[i].low.z,
                           boxes[i].high.x, boxes[i].high.y, boxes[i].high.z};
  }

  const Conjoint& conjoint_;
  const Model& model_;
  const Settings& settings_;
  std::vector<std::uint32_t> number_;
  Mesh mesh_;
};

Entity entity(const Label& label, std::string name) {
  Entity e;
  e.cad_id = label.cad_id;
  e.name = std::move(name);
  if (label.colour) e.colour = std::array<double, 3>{label.colour->red, label.colour->green, label.colour->blue};
  return e;
}

Entity edge_entity(const Model& model, EdgeId id) {
  const ModelEdge& edge = model.edges[id];
  Entity made = entity(edge.label, model.edge_name(id));
  made.boundary = {-static_cast<std::int32_t>(model.vertices[edge.start].label.cad_id),
                   static_cast<std::int32_t>(model.vertices[edge.end].label.cad_id)};
  return made;
}

Entity solid_entity(const Model& model, SolidId s) {
  Entity made = entity(model.solids[s].label, model.solid_name(s));
  for (FaceId f : model.solids[s].faces) {
    const auto id = static_cast<std::int32_t>(model.faces[f].label.cad_id);
    made.boundary.push_back(model.faces[f].back == s ? id : -id);
  }
  return made;
}

}  // namespace

void add_labels(Mesh& mesh, const Model& model) {
  for (const ModelVertex& vertex : model.vertices)
    mesh.vertices.push_back(entity(vertex.label, "vertex_" + std::to_string(vertex.label.cad_id)));
  for (std::size_t e = 0; e < model.edges.size(); ++e) mesh.edges.push_back(edge_entity(model, EdgeId(e)));
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    mesh.faces.push_back(entity(model.faces[FaceId(f)].label, model.face_name(FaceId(f))));
  for (std::size_t s = 0; s < model.solids.size(); ++s) mesh.solids.push_back(solid_entity(model, SolidId(s)));
}

Mesh assemble(const Conjoint& conjoint, const Settings& settings) { return Assembly(conjoint, settings).run(); }

std::uint64_t mesh_hash(const Mesh& mesh) {
  Fnv1a hash;
  for (const Point& p : mesh.points)
    for (double x : p) hash.add(std::bit_cast<std::uint64_t>(x));
  for (const auto& t : mesh.tets)
    for (std::uint32_t v : t) hash.add(v);
  for (const auto& t : mesh.triangles)
    for (std::uint32_t v : t) hash.add(v);
  return hash.value();
}

}  // namespace curvetet
