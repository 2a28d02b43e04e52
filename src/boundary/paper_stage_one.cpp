// Definition 1 of the paper: a triangle and a vertex are adjacent when some vertex of the triangle and the vertex lie
// on a common face. Vertices in a sphere are found through an octree; the paper does not say how it finds them.
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "boundary/boundary_mesh.h"
#include "boundary/paper_recovery.h"
#include "boundary/point_octree.h"
#include "boundary/refine_surface.h"
#include "quality/measures.h"

namespace curvetet {

namespace {

class PaperStageOne {
 public:
  PaperStageOne(Conjoint& conjoint, double floor, PaperCounts& counts, Context& context)
      : conjoint_(conjoint), vertices_(conjoint.vertices()), floor_(floor), counts_(counts), context_(context) {}

  Status run() {
    std::set<VertexId> used;
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary())) {
      queue_.push_back(t);
      used.insert(t.vertices.begin(), t.vertices.end());
    }
    for (VertexId v : used) placed_.add(v, vertices_.position(v));
    while (!queue_.empty()) {
      if (context_.should_stop()) return context_.stop_error("first stage of face recovery");
      const SurfaceTriangle t = queue_.front();
      queue_.pop_front();
      const FaceMesh& mesh = conjoint_.boundary().faces[t.face];
      if (mesh.triangle(t.triangle).alive() && mesh.vertices(t.triangle) == t.vertices) treat(t);
    }
    return Done{};
  }

 private:
  bool share_face(VertexId a, VertexId b) const {
    for (FaceId f : conjoint_.faces_of(a))
      for (FaceId g : conjoint_.faces_of(b))
        if (f == g) return true;
    return false;
  }

  bool adjacent(const std::array<VertexId, 3>& t, VertexId v) const {
    return std::any_of(t.begin(), t.end(), [&](VertexId w) { return w == v || share_face(w, v); });
  }

  VertexId prohibited(const SurfaceTriangle& t) const {
    const Vec3 a = vertices_.position(t.vertices[0]);
    const Vec3 centre = equatorial_centre(a, vertices_.position(t.vertices[1]), vertices_.position(t.vertices[2]));
    const double radius = distance(centre, a);
    if (!std::isfinite(radius) || radius > 1) return {};
    const auto allowed = allowed_.find(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
    VertexId found;
    placed_.visit_ball(centre, radius, [&](VertexId v) {
      if ((found.valid() && found < v) || adjacent(t.vertices, v)) return;
      if (allowed != allowed_.end() && allowed->second.count(v)) return;
      found = v;
    });
    return found;
  }

  void treat(const SurfaceTriangle& t) {
    const VertexId v = prohibited(t);
    if (!v.valid()) return;
    if (cancelled_by(t, v) || !split(t)) {
      allowed_[facet_key(t.vertices[0], t.vertices[1], t.vertices[2])].insert(v);
      ++counts_.stage_one_allowed;
      queue_.push_back(t);
    }
  }

  // The cancel rule: the new vertex would fall into a triangle adjacent to the prohibited vertex.
  bool cancelled_by(const SurfaceTriangle& t, VertexId v) const {
    const FaceMesh& mesh = conjoint_.boundary().faces[t.face];
    const auto q = ellipse_centre(mesh, t.triangle, conjoint_.model().faces[t.face]);
    if (!q) return true;
    const auto at = mesh.locate(*q, t.triangle);
    return at && adjacent(mesh.vertices(*at), v);
  }

  bool split(const SurfaceTriangle& t) {
    SurfaceRefinement refinement;
    refinement.floor = floor_;
    refinement.origin = Origin::stage_one;
    const ConjointResult done = refine_triangle(conjoint_, t.face, t.triangle, refinement);
    if (!done.ok()) return false;
    ++counts_.stage_one_points;
    placed_.add(done.vertex, vertices_.position(done.vertex));
    for (const auto& [face, triangles] : conjoint_.touched())
      for (TriangleId id : triangles) {
        const FaceMesh& mesh = conjoint_.boundary().faces[face];
        if (!mesh.triangle(id).alive()) continue;
        const auto w = mesh.vertices(id);
        if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) queue_.push_back({face, id, w});
      }
    return true;
  }

  Conjoint& conjoint_;
  const VertexStore& vertices_;
  double floor_;
  PaperCounts& counts_;
  Context& context_;
  PointOctree placed_;
  std::deque<SurfaceTriangle> queue_;
  std::map<FacetKey, std::set<VertexId>> allowed_;
};

}  // namespace

Status paper_stage_one(Conjoint& conjoint, double floor, PaperCounts& counts, Context& context) {
  return PaperStageOne(conjoint, floor, counts, context).run();
}

}  // namespace curvetet
