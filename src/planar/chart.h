// The plane a face mesh lives in: (u,v) moved, scaled by the mean lengths of the surface's derivatives, on the grid.
#pragma once

#include "base/vec.h"

namespace curvetet {

/// q = (scale_u * (u - centre_u), scale_v * (v - centre_v)), rounded to 2^-42; the trimmed domain fits into [-1/2,
/// 1/2]^2 with room around. The scales make the metric at q as near to a multiple of the identity as a constant scaling
/// can.
struct Chart {
  Vec2 centre{};
  double scale_u = 1, scale_v = 1;
  Vec2 to_chart(Vec2 uv) const;  ///< on the grid
  Vec2 to_uv(Vec2 q) const { return {q.x / scale_u + centre.x, q.y / scale_v + centre.y}; }
};

}  // namespace curvetet
