// The floating-point rung of orient3d and insphere, inline for the kernel's loops. Internal to predicates and spatial.
//
// Error bounds, with u = 2^-53 and every coordinate on the grid: differences are exact, nothing underflows (the
// smallest product of ten grid steps is 2^-420) and nothing overflows.
//   orient3d: with X, Y, Z the largest |differences| of each coordinate, a 2x2 minor is off by at most 4u YZ and at
//   most 2YZ large; its product with x is off by 6u XYZ; the sum of the three by 3*6 + 4 + 6 = 28 u XYZ. We use 32.
//   insphere: 3x3 minors are off by 28u XYZ and at most 6 XYZ large; the lift, at most L, by 3u L; their product by
//   28 + 18 + 6 = 52 u XYZL; the sum of the four by 4*52 + 12 + 12 + 24 = 256 u XYZL. We use 288.
//   As XYZ is at most L^(3/2), det^2 > (288 u)^2 L^5 decides too; it is cheaper and mostly enough.
// The margins absorb the terms in u^2 and the rounding of the bound itself.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace curvetet::filters {

inline constexpr int kUnknown = 2;  ///< what a rung returns when it cannot decide

/// Sign of orient3d, or kUnknown.
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double det = p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
  const double x = std::max(std::max(std::fabs(p.x), std::fabs(q.x)), std::fabs(r.x));
  const double y = std::max(std::max(std::fabs(p.y), std::fabs(q.y)), std::fabs(r.y));
  const double z = std::max(std::max(std::fabs(p.z), std::fabs(q.z)), std::fabs(r.z));
  const double bound = 32 * 0x1p-53 * (x * y * z);
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return bound == 0 ? 0 : kUnknown;  // a whole column of zeros: a plane parallel to a coordinate plane
}

/// Sign of insphere, or kUnknown.
inline int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  const Vec3 p = a - e;
  const Vec3 q = b - e;
  const Vec3 r = c - e;
  const Vec3 s = d - e;
  const double pq = p.x * q.y - p.y * q.x;
  const double qr = q.x * r.y - q.y * r.x;
  const double rs = r.x * s.y - r.y * s.x;
  const double sp = s.x * p.y - s.y * p.x;
  const double pr = p.x * r.y - p.y * r.x;
  const double qs = q.x * s.y - q.y * s.x;
  const double pqr = p.z * qr - q.z * pr + r.z * pq;
  const double qrs = q.z * rs - r.z * qs + s.z * qr;
  const double rsp = r.z * sp + s.z * pr + p.z * rs;
  const double spq = s.z * pq + p.z * qs + q.z * sp;
  const double lp = norm2(p);
  const double lq = norm2(q);
  const double lr = norm2(r);
  const double ls = norm2(s);
  const double det = (lp * qrs - lq * rsp) + (lr * spq - ls * pqr);
  constexpr double kUnit = 288 * 0x1p-53;
  const double l = std::max(std::max(lp, lq), std::max(lr, ls));
  if (det * det > (kUnit * kUnit) * (l * l) * (l * l) * l) return det > 0 ? 1 : -1;
  const double x = std::max(std::max(std::fabs(p.x), std::fabs(q.x)), std::max(std::fabs(r.x), std::fabs(s.x)));
  const double y = std::max(std::max(std::fabs(p.y), std::fabs(q.y)), std::max(std::fabs(r.y), std::fabs(s.y)));
  const double z = std::max(std::max(std::fabs(p.z), std::fabs(q.z)), std::max(std::fabs(r.z), std::fabs(s.z)));
  const double bound = kUnit * (x * y * z * l);
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return bound == 0 ? 0 : kUnknown;
}

}  // namespace curvetet::filters
