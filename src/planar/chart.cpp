// Grid points keep every predicate of the face mesh exact; the map back is not rounded.
#include "planar/chart.h"

namespace curvetet {
namespace {

double to_grid(double x) { return std::nearbyint(x * 0x1p42) * 0x1p-42; }

}  // namespace

Vec2 Chart::to_chart(Vec2 uv) const {
  return {to_grid(scale_u * (uv.x - centre.x)), to_grid(scale_v * (uv.y - centre.y))};
}

}  // namespace curvetet
