#include "boundary/point_octree.h"

namespace curvetet {

void PointOctree::add(VertexId v, Vec3 p) {
  std::uint32_t cell = 0;
  Vec3 centre{};
  double half = kHalf;
  int depth = 0;
  while (cells_[cell].children != 0) {
    const std::uint32_t k = octant(centre, p);
    cell = cells_[cell].children + k;
    centre = child_centre(centre, half, k);
    half *= 0.5;
    ++depth;
  }
  cells_[cell].entries.push_back({v, p});
  if (cells_[cell].entries.size() > kLeaf && depth < kDepth) split(cell, centre);
}

void PointOctree::split(std::uint32_t cell, Vec3 centre) {
  const auto first = static_cast<std::uint32_t>(cells_.size());
  cells_.resize(cells_.size() + 8);
  for (const Entry& e : cells_[cell].entries) cells_[first + octant(centre, e.position)].entries.push_back(e);
  cells_[cell].entries.clear();
  cells_[cell].entries.shrink_to_fit();
  cells_[cell].children = first;
}

}  // namespace curvetet
