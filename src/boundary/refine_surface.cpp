// The order of points follows how often they agree with the tetrahedralization: the surface ball's centre is the
// spatial Delaunay criterion itself, the ellipse's centre is the paper's choice, the others are for triangles whose
// centres fall far away.
#include "boundary/refine_surface.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "boundary/boundary_mesh.h"
#include "boundary/criteria.h"
#include "quality/model_checks.h"

namespace curvetet {

namespace {

/// Cosine of the angle to the surface's normal at a corner, 66 degrees, from which the surface below may be turned by a
/// right angle.
constexpr double kLeaning = 0.4;

/// Cosine to the normal of a triangle that no flip nearby turns round again; one that leans less may be flipped.
constexpr double kTurnedBack = -0.5;

Vec2 chart_centroid(const FaceMesh& mesh, TriangleId t) {
  const FaceTriangle& triangle = mesh.triangle(t);
  Vec2 sum{};
  for (NodeId n : triangle.node) sum = sum + mesh.node(n).q;
  return (1.0 / 3) * sum;
}

/// Corners of a triangle in the chart and in space.
struct Places {
  std::array<Vec2, 3> q;
  std::array<Vec3, 3> p;
};

Places places_of(const Conjoint& conjoint, FaceId face, const std::array<NodeId, 3>& nodes) {
  Places at;
  for (std::size_t k = 0; k < 3; ++k) {
    const FaceNode& node = conjoint.boundary().faces[face].node(nodes[k]);
    at.q[k] = node.q;
    at.p[k] = conjoint.vertices().position(node.vertex);
  }
  return at;
}

class TriangleRefiner {
 public:
  TriangleRefiner(Conjoint& conjoint, FaceId face, TriangleId triangle, const SurfaceRefinement& options)
      : conjoint_(conjoint),
        face_(face),
        mesh_(conjoint.boundary().faces[face]),
        triangle_(triangle),
        options_(options) {}

  ConjointResult run() {
    if (longest_edge(conjoint_.vertices(), mesh_.vertices(triangle_)) < options_.floor)
      return {ConjointRefusal::too_small, {}};
    const ModelFace& face = conjoint_.model().faces[face_];
    ConjointResult last{ConjointRefusal::outside_domain, {}};
    const std::array<std::optional<Vec2>, 4> points{surface_ball_centre(mesh_, triangle_, conjoint_.vertices(), face),
                                                    ellipse_centre(mesh_, triangle_, face),
                                                    chart_centroid(mesh_, triangle_), middle_of_longest_edge()};
    for (const std::optional<Vec2>& q : points) {
      if (!q) continue;
      last = try_point(*q);
      if (last.ok()) return last;
    }
    return split_longest_segment(triangle_, last);
  }

 private:
  std::optional<Vec2> middle_of_longest_edge() const {
    const FaceTriangle& t = mesh_.triangle(triangle_);
    double longest = -1;
    Vec2 middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.use[k] >= 0) continue;
      const FaceNode &a = mesh_.node(t.node[(k + 1) % 3]), &b = mesh_.node(t.node[(k + 2) % 3]);
      const double length = distance(conjoint_.vertices().position(a.vertex), conjoint_.vertices().position(b.vertex));
      if (length > longest) {
        longest = length;
        middle = 0.5 * (a.q + b.q);
      }
    }
    return longest < 0 ? std::nullopt : std::optional<Vec2>(middle);
  }

  ConjointResult try_point(Vec2 q) {
    const Vec2 on_grid = mesh_.chart.to_chart(mesh_.chart.to_uv(q));
    const auto at = mesh_.locate(on_grid, triangle_);
    if (!at) return {ConjointRefusal::outside_domain, {}};
    const Vec3 p = conjoint_.model().faces[face_].surface->value(mesh_.chart.to_uv(on_grid));
    for (VertexId v : mesh_.vertices(*at))
      if (distance(conjoint_.vertices().position(v), p) < 0.25 * options_.floor)
        return {ConjointRefusal::too_small, {}};
    if (const auto split = split_encroached(*at, p)) return *split;
    if (would_fold(*at, on_grid, p)) return {ConjointRefusal::folded, {}};
    return conjoint_.insert_on_face(face_, on_grid, *at, options_.origin);
  }

  /// Would a new triangle at p turn its back on the surface? Where the parameters are sheared, the image of a point of
  /// the triangle may lie far outside of the triangle's own.
  bool would_fold(TriangleId at, Vec2 q, Vec3 p) const {
    const Vec3 normal = conjoint_.model().faces[face_].surface->normal(mesh_.chart.to_uv(q));
    const std::array<VertexId, 3> v = mesh_.vertices(at);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = conjoint_.vertices().position(v[k]), b = conjoint_.vertices().position(v[(k + 1) % 3]);
      if (dot(normalized(cross(b - a, p - a)), normal) < kTurnedBack) return true;
    }
    return false;
  }

  EdgeId edge_of(std::int32_t use) const {
    return conjoint_.boundary().uses[face_][static_cast<std::size_t>(use)].edge;
  }

  bool may_split(EdgeId edge) const { return !options_.may_split || options_.may_split(edge); }

  // The segment of the triangle whose diametral sphere holds p, split; nothing if there is none.
  std::optional<ConjointResult> split_encroached(TriangleId at, Vec3 p) {
    const FaceTriangle& t = mesh_.triangle(at);
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.use[k] < 0) continue;
      const VertexId a = mesh_.node(t.node[(k + 1) % 3]).vertex, b = mesh_.node(t.node[(k + 2) % 3]).vertex;
      if (a == b) continue;
      const Vec3 pa = conjoint_.vertices().position(a), pb = conjoint_.vertices().position(b);
      if (dot(pa - p, pb - p) >= 0) continue;
      const EdgeId edge = edge_of(t.use[k]);
      if (!may_split(edge)) return ConjointResult{ConjointRefusal::curved_segment, {}};
      return refine_segment(conjoint_, edge, a, b, options_);
    }
    return std::nullopt;
  }

  ConjointResult split_longest_segment(TriangleId at, ConjointResult otherwise) {
    const FaceTriangle& t = mesh_.triangle(at);
    double longest = 0;
    std::size_t best = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      if (t.use[k] < 0 || !may_split(edge_of(t.use[k]))) continue;
      const double length = distance(conjoint_.vertices().position(mesh_.node(t.node[(k + 1) % 3]).vertex),
                                     conjoint_.vertices().position(mesh_.node(t.node[(k + 2) % 3]).vertex));
      if (length > longest) {
        longest = length;
        best = k;
      }
    }
    if (best == 3) return otherwise;
    return refine_segment(conjoint_, edge_of(t.use[best]), mesh_.node(t.node[(best + 1) % 3]).vertex,
                          mesh_.node(t.node[(best + 2) % 3]).vertex, options_);
  }

  Conjoint& conjoint_;
  FaceId face_;
  FaceMesh& mesh_;
  TriangleId triangle_;
  const SurfaceRefinement& options_;
};

}  // namespace

ConjointResult refine_triangle(Conjoint& conjoint, FaceId face, TriangleId triangle, const SurfaceRefinement& options) {
  return TriangleRefiner(conjoint, face, triangle, options).run();
}

ConjointResult refine_segment(Conjoint& conjoint, EdgeId edge, VertexId a, VertexId b,
                              const SurfaceRefinement& options) {
  if (distance(conjoint.vertices().position(a), conjoint.vertices().position(b)) < options.floor)
    return {ConjointRefusal::too_small, {}};
  if (options.before_split) options.before_split(edge);
  return conjoint.split_segment(edge, a, b, options.origin);
}

double longest_edge(const VertexStore& vertices, const std::array<VertexId, 3>& v) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, distance(vertices.position(v[k]), vertices.position(v[(k + 1) % 3])));
  return longest;
}

double deviation(const Conjoint& conjoint, FaceId face, TriangleId triangle) {
  const FaceMesh& mesh = conjoint.boundary().faces[face];
  Vec3 centroid{};
  for (VertexId v : mesh.vertices(triangle)) centroid = centroid + (1.0 / 3) * conjoint.vertices().position(v);
  const Vec2 uv = mesh.chart.to_uv(chart_centroid(mesh, triangle));
  return distance(centroid, conjoint.model().faces[face].surface->value(uv));
}

double facing(const Conjoint& conjoint, FaceId face, TriangleId triangle) {
  const FaceMesh& mesh = conjoint.boundary().faces[face];
  const Places at = places_of(conjoint, face, mesh.triangle(triangle).node);
  return facing(*conjoint.model().faces[face].surface, mesh.chart, at.q, at.p);
}

std::optional<SurfaceFoot> foot_of(const Conjoint& conjoint, FaceId face, const std::array<NodeId, 3>& nodes) {
  const FaceMesh& mesh = conjoint.boundary().faces[face];
  const Surface& surface = *conjoint.model().faces[face].surface;
  const auto [q, p] = places_of(conjoint, face, nodes);
  const Vec3 centroid = (1.0 / 3) * (p[0] + p[1] + p[2]);
  std::optional<SurfaceFoot> foot;
  for (const Vec2 guess : {(1.0 / 3) * (q[0] + q[1] + q[2]), q[0], q[1], q[2]}) {
    const auto found = surface.project(centroid, mesh.chart.to_uv(guess));
    if (!found) continue;
    // Beyond its border the face's surface may turn back: the closest point of the face is on the border then.
    const Vec2 uv = within_box(conjoint.model().faces[face], *found);
    const double away = distance(surface.value(uv), centroid);
    if (!foot || away < foot->distance) foot = SurfaceFoot{uv, away};
  }
  return foot;
}

double facing_at_foot(const Conjoint& conjoint, FaceId face, const std::array<NodeId, 3>& nodes) {
  const auto foot = foot_of(conjoint, face, nodes);
  const std::array<Vec3, 3> p = places_of(conjoint, face, nodes).p;
  const Surface& surface = *conjoint.model().faces[face].surface;
  return foot ? dot(normalized(cross(p[1] - p[0], p[2] - p[0])), surface.normal(foot->uv)) : 1;
}

std::vector<SurfaceTriangle> facets_turned_away(const Conjoint& conjoint) {
  std::vector<SurfaceTriangle> found;
  std::optional<checks::FaceProjector> projector;  // of the face of the last triangle that leaned
  FaceId projected;
  for (const SurfaceTriangle& t : surface_triangles(conjoint.boundary())) {
    const FaceMesh& mesh = conjoint.boundary().faces[t.face];
    const ModelFace& face = conjoint.model().faces[t.face];
    const auto [q, p] = places_of(conjoint, t.face, mesh.triangle(t.triangle).node);
    const Vec3 normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
    std::array<Vec2, 3> uv;
    std::transform(q.begin(), q.end(), uv.begin(), [&](Vec2 at) { return mesh.chart.to_uv(at); });
    const bool leans =
        std::any_of(uv.begin(), uv.end(), [&](Vec2 at) { return dot(normal, face.surface->normal(at)) < kLeaning; });
    if (!leans) continue;
    if (projected != t.face) projector.emplace(face);
    projected = t.face;
    const Vec3 centroid = (1.0 / 3) * (p[0] + p[1] + p[2]);
    const auto foot = projector->project(centroid, uv, std::numeric_limits<double>::infinity());
    if (foot && projector->looks_away(centroid, face.reversed ? -normal : normal, *foot)) found.push_back(t);
  }
  return found;
}

Bend bend_below(const FaceMesh& mesh, TriangleId triangle, const Surface& surface) {
  const Vec2 uv = mesh.chart.to_uv(chart_centroid(mesh, triangle));
  return {surface.value(uv), 1 / surface.curvatures(uv).x};
}

double segment_deviation(const Conjoint& conjoint, EdgeId edge, VertexId a, VertexId b) {
  const CurveMesh& curve = conjoint.boundary().curves[edge];
  for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
    const bool same = (curve.vertices[i] == a && curve.vertices[i + 1] == b) ||
                      (curve.vertices[i] == b && curve.vertices[i + 1] == a);
    if (!same) continue;
    const double t = 0.5 * (curve.parameters[i] + curve.parameters[i + 1]);
    const Vec3 middle = 0.5 * (conjoint.vertices().position(a) + conjoint.vertices().position(b));
    return distance(middle, conjoint.model().edges[edge].curve->value(t));
  }
  return 0;
}

}  // namespace curvetet
