// Facets of a tetrahedralization never cross, so a triangle that crosses a locked facet could only be had at that one's
// cost. Of the face's own triangles those that exist cannot cross each other, and the triangles of faces still to come
// need no look: where they cross what is recovered here, they are the ones that are refused.
#include "boundary/facet_fallback.h"

#include <fmt/format.h>

#include <algorithm>

#include "boundary/fill_holes.h"
#include "boundary/reconnect.h"

namespace curvetet {

namespace {

class Fallback {
 public:
  Fallback(Conjoint& conjoint, FaceId face, FaceRecoveryResult& result, const Context& context)
      : conjoint_(conjoint), face_(face), result_(result), context_(context) {}

  bool run() {
    FaceCertificate& certificate = result_.faces[face_];
    certificate.fallback = true;
    const std::size_t tried = missing_triangles(conjoint_, face_).size();
    certificate.ladder.fallback.tried += tried;
    if (tried == 0) return true;
    if (refuse_crossings()) return false;
    recover_facets();
    const std::vector<SurfaceTriangle> missing = missing_triangles(conjoint_, face_);
    certificate.ladder.fallback.recovered += tried - missing.size();
    if (!missing.empty()) report_missing(missing);
    return missing.empty();
  }

 private:
  bool refuse_crossings() {
    std::vector<SurfaceTriangle> triangles = surface_triangles(conjoint_.boundary().faces[face_], face_);
    const std::size_t own = triangles.size();
    add_locked(triangles);
    return report_crossings(triangles, own, "a facet crosses one of a face that is locked");
  }

  /// One failure for each face whose facets cross those of this one, which are the first `own`.
  bool report_crossings(const std::vector<SurfaceTriangle>& triangles, std::size_t own, const char* what) {
    std::vector<char> is_own(triangles.size(), 0);
    std::fill_n(is_own.begin(), own, 1);
    std::set<FaceId> told;
    for (const auto& [i, j] : crossing_pairs(conjoint_.vertices(), triangles, is_own, kAllPairs, context_)) {
      const FaceId other = triangles[j].face;
      if (!told.insert(other).second) continue;
      RecoveryFailure failure = failure_at(triangles[i]);
      failure.faces.push_back(other);
      failure.what = other == face_ ? "facets of the surface mesh cross" : what;
      failure.crossing = true;
      result_.failures.push_back(std::move(failure));
    }
    return !told.empty();
  }

  void add_locked(std::vector<SurfaceTriangle>& triangles) const {
    const auto locked = locked_facets(*conjoint_.tets(), conjoint_.model().faces.size());
    for (std::size_t f = 0; f < locked.size(); ++f) {
      if (FaceId(f) == face_) continue;
      for (const FacetKey& v : locked[FaceId(f)])
        triangles.push_back({FaceId(f), TriangleId(), {VertexId(v[0]), VertexId(v[1]), VertexId(v[2])}});
    }
  }

  void recover_facets() {
    reconnect_face(conjoint_, face_);
    for (std::size_t recovered = 1; recovered > 0 && !context_.should_stop();) {
      recovered = 0;
      for (const bool with_points : {false, true}) {
        const FillResult filled = fill_holes(conjoint_, face_, with_points);
        recovered += filled.recovered;
        result_.volume_points += filled.points;
      }
    }
  }

  void report_missing(const std::vector<SurfaceTriangle>& missing) {
    std::vector<SurfaceTriangle> triangles = missing;
    for (std::size_t f = 0; f < conjoint_.model().faces.size(); ++f) {
      if (FaceId(f) == face_) continue;
      const std::vector<SurfaceTriangle> others = surface_triangles(conjoint_.boundary().faces[FaceId(f)], FaceId(f));
      triangles.insert(triangles.end(), others.begin(), others.end());
    }
    if (report_crossings(triangles, missing.size(), "a facet crosses one of another face")) return;
    RecoveryFailure failure = failure_at(missing.front());
    failure.what = fmt::format("{} facets are not recovered, not even one by one", missing.size());
    result_.failures.push_back(std::move(failure));
  }

  RecoveryFailure failure_at(const SurfaceTriangle& t) const {
    const VertexStore& vertices = conjoint_.vertices();
    RecoveryFailure failure;
    failure.faces = {face_};
    for (VertexId v : t.vertices) failure.where = failure.where + (1.0 / 3) * vertices.position(v);
    failure.size = 0.5 * distance(vertices.position(t.vertices[0]), vertices.position(t.vertices[1]));
    return failure;
  }

  Conjoint& conjoint_;
  FaceId face_;
  FaceRecoveryResult& result_;
  const Context& context_;
};

}  // namespace

bool fall_back(Conjoint& conjoint, FaceId face, FaceRecoveryResult& result, const Context& context) {
  return Fallback(conjoint, face, result, context).run();
}

}  // namespace curvetet
