#include "geometry/frame.h"

#include <algorithm>

namespace curvetet {

Frame Frame::of(const Box3& box) {
  Frame frame;
  if (box.empty()) return frame;
  frame.centre = box.centre();
  const Vec3 extent = box.high - box.low;
  const double largest = std::max({extent.x, extent.y, extent.z});
  if (!(largest > 0) || !std::isfinite(largest)) return frame;
  // frexp: largest = mantissa * 2^exponent with mantissa in [1/2, 1), so the scaled extent is in [3/8, 3/4): a quarter
  // of the unit box at least stays free for points that curves and surfaces put beyond the box.
  int exponent = 0;
  const double mantissa = std::frexp(largest, &exponent);
  frame.scale = std::ldexp(1.0, mantissa > 0.75 ? -exponent - 1 : -exponent);
  return frame;
}

}  // namespace curvetet
