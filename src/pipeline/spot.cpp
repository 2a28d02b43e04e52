#include "pipeline/spot.h"

#include <algorithm>
#include <array>
#include <span>

#include "boundary/surface_triangles.h"
#include "pipeline/assemble.h"
#include "sizing/closest_pair.h"

namespace curvetet {

namespace {

class Spot {
 public:
  Spot(const Model& model, const Settings& settings, const BodyMesh& body, const RecoveryFailure& failure, double reach)
      : model_(model),
        settings_(settings),
        body_(body),
        failure_(failure),
        reach_(reach),
        number_(body.vertices.size(), kNoNode) {}

  Mesh run() {
    mesh_.unit = settings_.unit;
    add_labels(mesh_, model_);
    for (const SurfaceTriangle& t : surface_triangles(body_.boundary)) add(t);
    for (std::size_t e = 0; e < body_.boundary.curves.size(); ++e) add(EdgeId(e));
    for (const VertexId v : body_.boundary.cad_vertices)
      mesh_.corner_nodes.push_back(v.valid() ? number_[v.value()] : kNoNode);
    return std::move(mesh_);
  }

 private:
  bool concerns(FaceId f) const {
    return std::find(failure_.faces.begin(), failure_.faces.end(), f) != failure_.faces.end();
  }

  /// By the box of the vertices: a large element may pass the place with all its corners far away.
  bool is_near(std::span<const VertexId> vertices) const {
    Box3 box;
    for (const VertexId v : vertices) box.extend(body_.vertices.position(v));
    Vec3 closest = failure_.where;
    for (int i = 0; i < 3; ++i) closest[i] = std::clamp(closest[i], box.low[i], box.high[i]);
    return distance(closest, failure_.where) <= reach_;
  }

  void add(const SurfaceTriangle& t) {
    if (!concerns(t.face) && !is_near(t.vertices)) return;
    std::array<std::uint32_t, 3> nodes{number(t.vertices[0]), number(t.vertices[1]), number(t.vertices[2])};
    if (model_.faces[t.face].reversed) std::swap(nodes[1], nodes[2]);
    mesh_.triangles.push_back(nodes);
    mesh_.triangle_face.push_back(t.face.value());
  }

  void add(EdgeId e) {
    const std::vector<VertexId>& chain = body_.boundary.curves[e].vertices;
    const std::vector<FaceId>& faces = model_.edges[e].faces;
    const bool all = std::any_of(faces.begin(), faces.end(), [&](FaceId f) { return concerns(f); });
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const std::array<VertexId, 2> ends{chain[i], chain[i + 1]};
      if (!all && !is_near(ends)) continue;
      mesh_.segments.push_back({number(ends[0]), number(ends[1])});
      mesh_.segment_edge.push_back(e.value());
    }
  }

  std::uint32_t number(VertexId v) {
    std::uint32_t& number = number_[v.value()];
    if (number != kNoNode) return number;
    number = static_cast<std::uint32_t>(mesh_.points.size());
    const Vec3 p = settings_.unit_scale * model_.frame.to_cad(body_.vertices.position(v));
    mesh_.points.push_back({p.x, p.y, p.z});
    const Owner owner = body_.vertices.owner(v);
    const Vec2 q = body_.vertices.parameter(v);
    const double first = owner.kind == OwnerKind::edge ? model_.edges[EdgeId(owner.index)].own_parameter(q.x) : q.x;
    mesh_.nodes.push_back({static_cast<std::uint8_t>(owner.kind), owner.index, {first, q.y}});
    return number;
  }

  const Model& model_;
  const Settings& settings_;
  const BodyMesh& body_;
  const RecoveryFailure& failure_;
  double reach_;
  std::vector<std::uint32_t> number_;
  Mesh mesh_;
};

std::vector<CadVertexId> corners_of(const Model& model, FaceId face) {
  std::vector<CadVertexId> corners = model.faces[face].internal_vertices;
  const auto add = [&](const EdgeUse& use) {
    corners.push_back(model.edges[use.edge].start);
    corners.push_back(model.edges[use.edge].end);
  };
  for (const Loop& loop : model.faces[face].loops) std::for_each(loop.uses.begin(), loop.uses.end(), add);
  std::for_each(model.faces[face].internal_edges.begin(), model.faces[face].internal_edges.end(), add);
  return corners;
}

bool share_a_corner(const Model& model, FaceId one, FaceId two) {
  const std::vector<CadVertexId> a = corners_of(model, one), b = corners_of(model, two);
  return std::any_of(a.begin(), a.end(), [&](CadVertexId v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

/// Parameters of the node of a face mesh that is nearest to a place.
std::optional<Vec2> nearest_node(const BodyMesh& body, FaceId face, Vec3 place) {
  const FaceMesh& mesh = body.boundary.faces[face];
  std::optional<Vec2> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    if (!mesh.triangle_at(NodeId(n)).valid()) continue;
    const double away = distance(body.vertices.position(mesh.node(NodeId(n)).vertex), place);
    if (!(away < least)) continue;
    least = away;
    nearest = mesh.chart.to_uv(mesh.node(NodeId(n)).q);
  }
  return nearest;
}

bool is_on_face(const BodyMesh& body, FaceId face, Vec2 uv) {
  const FaceMesh& mesh = body.boundary.faces[face];
  return mesh.locate(mesh.chart.to_chart(uv)).has_value();
}

}  // namespace

Mesh spot_of(const Model& model, const Settings& settings, const BodyMesh& body, const RecoveryFailure& failure,
             double reach) {
  return Spot(model, settings, body, failure, reach).run();
}

std::optional<FaceGap> gap_between(const Model& model, const BodyMesh& body, const RecoveryFailure& failure,
                                   double reach) {
  if (failure.faces.size() != 2 || failure.proved) return std::nullopt;
  const FaceId one = failure.faces[0], two = failure.faces[1];
  if (one == two || share_a_corner(model, one, two)) return std::nullopt;
  const auto from_one = nearest_node(body, one, failure.where), from_two = nearest_node(body, two, failure.where);
  if (!from_one || !from_two) return std::nullopt;
  const ModelFace &a = model.faces[one], &b = model.faces[two];
  const auto foot = b.surface->project(a.surface->value(*from_one), *from_two);
  const sizing::ParameterPair start{*from_one, foot.value_or(*from_two)};
  const double contact = std::max({a.tolerance, b.tolerance, 8 * kGrid});
  if (sizing::meeting_point(*a.surface, *b.surface, start, contact, reach)) return std::nullopt;
  sizing::ParameterPair pair = sizing::approach(*a.surface, *b.surface, start, reach);
  // Along surfaces that keep their distance the closest pair may run far away.
  if (distance(a.surface->value(pair.one), failure.where) > reach) pair = start;
  if (!is_on_face(body, one, pair.one) || !is_on_face(body, two, pair.two)) return std::nullopt;
  const Vec3 p = a.surface->value(pair.one), q = b.surface->value(pair.two);
  const FaceGap gap{distance(p, q), 0.5 * (p + q)};
  if (!(gap.length > contact) || gap.length > reach || distance(gap.where, failure.where) > reach) return std::nullopt;
  return gap;
}

}  // namespace curvetet
