// Vertices near a place, while more are added: an octree over the working box, split where vertices are dense.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh/vertex_store.h"

namespace curvetet {

class PointOctree {
 public:
  PointOctree() : cells_(1) {}

  void add(VertexId v, Vec3 p);

  /// Calls `visit(v)` for every vertex in the closed ball, in no particular order.
  template <class Visit>
  void visit_ball(Vec3 centre, double radius, const Visit& visit) const {
    visit_ball(0, Vec3{}, kHalf, centre, radius, visit);
  }

 private:
  static constexpr double kHalf = 1;  ///< of the edge of the root: working coordinates are in [-1,1]
  static constexpr std::size_t kLeaf = 16;
  static constexpr int kDepth = 24;

  struct Entry {
    VertexId vertex;
    Vec3 position;
  };
  struct Cell {
    std::uint32_t children = 0;  ///< first of eight; 0: a leaf
    std::vector<Entry> entries;
  };

  static std::uint32_t octant(Vec3 centre, Vec3 p) {
    return (p.x >= centre.x ? 1U : 0U) + (p.y >= centre.y ? 2U : 0U) + (p.z >= centre.z ? 4U : 0U);
  }
  static Vec3 child_centre(Vec3 centre, double half, std::uint32_t octant) {
    const double q = 0.5 * half;
    return {centre.x + ((octant & 1U) != 0 ? q : -q), centre.y + ((octant & 2U) != 0 ? q : -q),
            centre.z + ((octant & 4U) != 0 ? q : -q)};
  }
  void split(std::uint32_t cell, Vec3 centre);

  template <class Visit>
  void visit_ball(std::uint32_t cell, Vec3 at, double half, Vec3 centre, double radius, const Visit& visit) const {
    for (const Entry& e : cells_[cell].entries)
      if (distance(e.position, centre) <= radius) visit(e.vertex);
    if (cells_[cell].children == 0) return;
    for (std::uint32_t k = 0; k < 8; ++k) {
      const Vec3 c = child_centre(at, half, k);
      const double h = 0.5 * half;
      const Vec3 outside{std::max(std::abs(centre.x - c.x) - h, 0.0), std::max(std::abs(centre.y - c.y) - h, 0.0),
                         std::max(std::abs(centre.z - c.z) - h, 0.0)};
      if (norm2(outside) <= radius * radius) visit_ball(cells_[cell].children + k, c, h, centre, radius, visit);
    }
  }

  std::vector<Cell> cells_;
};

}  // namespace curvetet
