// Facets of a face that are to stay while others of it are sought.
#pragma once

#include <array>
#include <vector>

#include "boundary/surface_triangles.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

/// Locks facets for as long as it lives.
class TemporaryLocks {
 public:
  TemporaryLocks(Tetrahedralization& tets, FaceId face) : tets_(tets), face_(face) {}
  TemporaryLocks(const TemporaryLocks&) = delete;
  TemporaryLocks& operator=(const TemporaryLocks&) = delete;
  ~TemporaryLocks() {
    for (const auto& v : locked_)
      if (const auto facet = tets_.find_facet(v[0], v[1], v[2])) tets_.complex().unlock(*facet);
  }

  /// False if the triangle is no facet, or one that another face has locked.
  bool add(const SurfaceTriangle& t) {
    const auto facet = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
    if (!facet) return false;
    const FaceId owner = tets_.complex().locked_face(*facet);
    if (owner.valid()) return owner == face_;
    tets_.lock(*facet, face_);
    locked_.push_back(t.vertices);
    return true;
  }

 private:
  Tetrahedralization& tets_;
  FaceId face_;
  std::vector<std::array<VertexId, 3>> locked_;
};

}  // namespace curvetet
