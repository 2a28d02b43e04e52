// Exact signs for any finite doubles, also off the grid: a filter, then integers as wide as the numbers need. The
// validator's own arithmetic, so that a fault in the kernel's predicates cannot hide itself.
#pragma once

#include "base/vec.h"

namespace curvetet::exact {

/// Sign of det[b-a, c-a, d-a]: positive when d lies on the side that the normal (b-a) x (c-a) points to. Exact for all
/// finite arguments, however large or small.
int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// Sign of the turn a, b, c after dropping coordinate `axis` (0, 1 or 2): x drops to (y,z), y to (z,x), z to (x,y).
/// Exact.
int turn(Vec3 a, Vec3 b, Vec3 c, int axis);

/// An axis along which the triangle's shadow has area; -1 when the three points are exactly collinear.
int shadow_axis(Vec3 a, Vec3 b, Vec3 c);

/// True when the closed segment pq and the closed triangle abc, which is not collinear, have a common point. Exact.
bool segment_meets_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c);

}  // namespace curvetet::exact
