// Every insertion is judged in all triangulations concerned before any of them is changed: the face meshes by
// FaceMesh::judge_*, the tetrahedralization by its (const) cavity. Rejected: committing face by face with an undo log;
// a judged insertion needs none.
#include "conjoint/conjoint.h"

#include <algorithm>

#include "base/error.h"

namespace curvetet {

const char* name(ConjointRefusal refusal) {
  switch (refusal) {
    case ConjointRefusal::none:
      return "none";
    case ConjointRefusal::outside_domain:
      return "outside_domain";
    case ConjointRefusal::curved_segment:
      return "curved_segment";
    case ConjointRefusal::coincident:
      return "coincident";
    case ConjointRefusal::locked_cavity:
      return "locked_cavity";
    case ConjointRefusal::folded:
      return "folded";
    case ConjointRefusal::too_small:
      return "too_small";
    case ConjointRefusal::no_segment:
      return "no_segment";
  }
  return "none";
}

Conjoint::Conjoint(const Model& model, VertexStore& vertices, BoundaryMesh& boundary, const Criterion& criterion)
    : model_(&model), vertices_(&vertices), boundary_(&boundary), uses_(model.edges.size()) {
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceId face(f);
    criteria_.push_back(criterion(face));
    self_.push_back({face});
    const std::vector<UseRef>& refs = boundary.uses[face];
    for (std::size_t k = 0; k < refs.size(); ++k)
      uses_[refs[k].edge].push_back({face, static_cast<std::int32_t>(k), refs[k].use->curve.get()});
  }
  for (std::size_t v = 0; v < model.vertices.size(); ++v) faces_at_vertex_.push_back(model.faces_at(CadVertexId(v)));
  for (const Segment& s : segments()) segment_edge_[edge_key(s.a, s.b)] = s.edge;
}

std::vector<Conjoint::Segment> Conjoint::segments() const {
  std::vector<Segment> all;
  for (std::size_t e = 0; e < boundary_->curves.size(); ++e) {
    const CurveMesh& curve = boundary_->curves[EdgeId(e)];
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
      if (curve.vertices[i] != curve.vertices[i + 1])
        all.push_back({EdgeId(e), curve.vertices[i], curve.vertices[i + 1]});
  }
  return all;
}

EdgeId Conjoint::segment_edge(VertexId a, VertexId b) const {
  const auto found = segment_edge_.find(edge_key(a, b));
  return found == segment_edge_.end() ? EdgeId() : found->second;
}

const std::vector<FaceId>& Conjoint::faces_of(VertexId v) const {
  const Owner owner = vertices_->owner(v);
  switch (owner.kind) {
    case OwnerKind::vertex:
      return faces_at_vertex_[CadVertexId(owner.index)];
    case OwnerKind::edge:
      return model_->edges[EdgeId(owner.index)].faces;
    case OwnerKind::face:
      return self_[FaceId(owner.index)];
    case OwnerKind::interior:
      return none_;
  }
  return none_;
}

ConjointResult Conjoint::insert_on_face(FaceId face, Vec2 q, TriangleId triangle, Origin origin) {
  FaceMesh& mesh = boundary_->faces[face];
  if (mesh.judge_insert(q, triangle) != PlanarRefusal::none) return {ConjointRefusal::outside_domain, {}};
  const Vec2 uv = mesh.chart.to_uv(q);
  const Vec3 position = snap(model_->faces[face].surface->value(uv));
  if (!finite(position)) return {ConjointRefusal::outside_domain, {}};
  for (VertexId v : mesh.vertices(triangle))
    if (vertices_->position(v) == position) return {ConjointRefusal::coincident, {}};
  const VertexId vertex = vertices_->add(position, Owner::of(face), uv, origin);
  Cavity cavity;
  if (tets_ != nullptr) {
    cavity = tets_->find_cavity(vertex, tets_->tet_of(mesh.vertices(triangle)[0]));
    if (cavity.refusal == Refusal::duplicate) return {ConjointRefusal::coincident, {}};
    if (!cavity.ok()) return {ConjointRefusal::locked_cavity, {}};
  }
  std::vector<TriangleId> changed;
  mesh.insert(vertex, q, triangle, criteria_[face], changed);
  if (tets_ != nullptr) tets_->commit(cavity);
  touched_.assign(1, {face, std::move(changed)});
  return {ConjointRefusal::none, vertex};
}

std::vector<FaceEdge> Conjoint::chart_edges(const Use& use, VertexId a, VertexId b) const {
  const FaceMesh& mesh = boundary_->faces[use.face];
  std::vector<FaceEdge> found;
  for (NodeId m : mesh.nodes_of(a))
    for (NodeId n : mesh.nodes_of(b)) {
      const auto edge = mesh.find_edge(m, n);
      if (edge && mesh.triangle(edge->triangle).use[static_cast<std::size_t>(edge->local)] == use.number)
        found.push_back(*edge);
    }
  return found;
}

ConjointRefusal Conjoint::judge_uses(EdgeId edge, VertexId a, VertexId b, double t) const {
  for (const Use& use : uses_[edge]) {
    const FaceMesh& mesh = boundary_->faces[use.face];
    const Vec2 q = mesh.chart.to_chart(use.curve->value(t));
    for (const FaceEdge& chart_edge : chart_edges(use, a, b))
      if (mesh.judge_split(chart_edge, q) != PlanarRefusal::none) return ConjointRefusal::curved_segment;
  }
  return ConjointRefusal::none;
}

void Conjoint::split_uses(EdgeId edge, VertexId a, VertexId b, VertexId middle, double t) {
  touched_.clear();
  for (const Use& use : uses_[edge]) {
    FaceMesh& mesh = boundary_->faces[use.face];
    const Vec2 q = mesh.chart.to_chart(use.curve->value(t));
    const std::vector<FaceEdge> edges = chart_edges(use, a, b);
    if (edges.empty()) continue;
    std::vector<TriangleId> changed;
    const NodeId node = mesh.split(edges.front(), middle, q, criteria_[use.face], changed);
    if (!node.valid()) throw InternalError("a judged split of a segment was refused");
    touched_.emplace_back(use.face, std::move(changed));
  }
}

ConjointResult Conjoint::split_segment(EdgeId edge, VertexId a, VertexId b, Origin origin) {
  CurveMesh& curve = boundary_->curves[edge];
  std::size_t i = 0;
  const std::size_t n = curve.vertices.size();
  const auto joins = [&](std::size_t k) {
    return (curve.vertices[k] == a && curve.vertices[k + 1] == b) ||
           (curve.vertices[k] == b && curve.vertices[k + 1] == a);
  };
  while (i + 1 < n && !joins(i)) ++i;
  if (i + 1 >= n) return {ConjointRefusal::no_segment, {}};
  const double t = 0.5 * (curve.parameters[i] + curve.parameters[i + 1]);
  if (!(t > curve.parameters[i] && t < curve.parameters[i + 1])) return {ConjointRefusal::too_small, {}};
  const Vec3 position = snap(model_->edges[edge].curve->value(t));
  if (position == vertices_->position(a) || position == vertices_->position(b)) return {ConjointRefusal::too_small, {}};
  const ConjointRefusal refusal = judge_uses(edge, a, b, t);
  if (refusal != ConjointRefusal::none) return {refusal, {}};

  const VertexId middle = vertices_->add(position, Owner::of(edge), {t, 0}, origin);
  Cavity cavity;
  if (tets_ != nullptr) {
    const bool kept = tets_->is_kept(a, b);
    if (kept) tets_->release_segment(a, b);
    cavity = tets_->find_cavity(middle, tets_->tet_of(a));
    if (!cavity.ok()) {
      if (kept) tets_->keep_segment(a, b);
      return {cavity.refusal == Refusal::duplicate ? ConjointRefusal::coincident : ConjointRefusal::locked_cavity, {}};
    }
  }
  split_uses(edge, a, b, middle, t);
  if (tets_ != nullptr) tets_->commit(cavity);
  const auto at = static_cast<std::ptrdiff_t>(i) + 1;
  curve.vertices.insert(curve.vertices.begin() + at, middle);
  curve.parameters.insert(curve.parameters.begin() + at, t);
  segment_edge_.erase(edge_key(a, b));
  segment_edge_[edge_key(a, middle)] = edge;
  segment_edge_[edge_key(middle, b)] = edge;
  return {ConjointRefusal::none, middle};
}

}  // namespace curvetet
