// All edges first, each kept as soon as it is there, then the facets: a facet can only be recovered once its edges are.
// The existing facets of the face are locked for the time being, so that one gain does not undo another.
#include "boundary/reconnect.h"

#include "boundary/temporary_locks.h"
#include "spatial/flips.h"

namespace curvetet {

namespace {

class Reconnection {
 public:
  Reconnection(Conjoint& conjoint, FaceId face)
      : tets_(*conjoint.tets()), mesh_(conjoint.boundary().faces[face]), face_(face), locks_(tets_, face) {}

  ReconnectResult run() {
    for (const SurfaceTriangle& t : surface_triangles(mesh_, face_))
      if (!locks_.add(t)) missing_.push_back(t);
    for (const SurfaceTriangle& t : missing_)
      for (std::size_t k = 0; k < 3; ++k) recover_edge(t.vertices[k], t.vertices[(k + 1) % 3]);
    for (const SurfaceTriangle& t : missing_) recover_facet(t);
    for (const auto& [a, b] : kept_) tets_.release_segment(a, b);
    return std::move(result_);
  }

 private:
  void recover_edge(VertexId a, VertexId b) {
    if (tets_.is_kept(a, b)) return;
    if (!tets_.find_edge(a, b) && !recover_edge_by_flips(tets_, a, b)) return;
    tets_.keep_segment(a, b);
    kept_.emplace_back(a, b);
  }

  void recover_facet(const SurfaceTriangle& t) {
    const auto& v = t.vertices;
    bool edges = true;
    for (std::size_t k = 0; k < 3; ++k) edges = edges && tets_.find_edge(v[k], v[(k + 1) % 3]).has_value();
    if (edges && recover_facet_by_flips(tets_, v[0], v[1], v[2]) && locks_.add(t))
      ++result_.recovered;
    else
      result_.missing.push_back(t);
  }

  Tetrahedralization& tets_;
  const FaceMesh& mesh_;
  FaceId face_;
  TemporaryLocks locks_;
  ReconnectResult result_;
  std::vector<SurfaceTriangle> missing_;
  std::vector<std::pair<VertexId, VertexId>> kept_;
};

}  // namespace

std::vector<SurfaceTriangle> missing_triangles(const Conjoint& conjoint, FaceId face) {
  const Tetrahedralization& tets = *conjoint.tets();
  std::vector<SurfaceTriangle> missing;
  for (const SurfaceTriangle& t : surface_triangles(conjoint.boundary().faces[face], face)) {
    const auto f = tets.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
    const FaceId owner = f ? tets.complex().locked_face(*f) : FaceId();
    if (!f || (owner.valid() && owner != face)) missing.push_back(t);
  }
  return missing;
}

ReconnectResult reconnect_face(Conjoint& conjoint, FaceId face) { return Reconnection(conjoint, face).run(); }

}  // namespace curvetet
