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
#include <cstdint>

#include "base/vec.h"

namespace curvetet::filters {

inline constexpr int kUnknown = 2;  ///< what a rung returns when it cannot decide

/// orient3d in double, not rounded where the insphere of the points and a fifth one is not (see Insphere::narrow): with
/// XYZL below 2^46 g^5 and L at least g^2, XYZ is below 2^46 g^3.
inline double orient3d_value(const Vec3& p, const Vec3& q, const Vec3& r) {
  return p.x * (q.y * r.z - q.z * r.y) + p.y * (q.z * r.x - q.x * r.z) + p.z * (q.x * r.y - q.y * r.x);
}

/// Sign of orient3d, or kUnknown.
inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  const Vec3 r = d - a;
  const double det = orient3d_value(p, q, r);
  const double x = std::max(std::max(std::fabs(p.x), std::fabs(q.x)), std::fabs(r.x));
  const double y = std::max(std::max(std::fabs(p.y), std::fabs(q.y)), std::fabs(r.y));
  const double z = std::max(std::max(std::fabs(p.z), std::fabs(q.z)), std::fabs(r.z));
  const double bound = 32 * 0x1p-53 * (x * y * z);
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return bound == 0 ? 0 : kUnknown;  // a whole column of zeros: a plane parallel to a coordinate plane
}

/// insphere in double: the determinant and what bounds its error.
class Insphere {
 public:
  Insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e)
      : p_(a - e), q_(b - e), r_(c - e), s_(d - e) {
    const double pq = p_.x * q_.y - p_.y * q_.x;
    const double qr = q_.x * r_.y - q_.y * r_.x;
    const double rs = r_.x * s_.y - r_.y * s_.x;
    const double sp = s_.x * p_.y - s_.y * p_.x;
    const double pr = p_.x * r_.y - p_.y * r_.x;
    const double qs = q_.x * s_.y - q_.y * s_.x;
    const double pqr = p_.z * qr - q_.z * pr + r_.z * pq;
    const double qrs = q_.z * rs - r_.z * qs + s_.z * qr;
    const double rsp = r_.z * sp + s_.z * pr + p_.z * rs;
    const double spq = s_.z * pq + p_.z * qs + q_.z * sp;
    const double lp = norm2(p_);
    const double lq = norm2(q_);
    const double lr = norm2(r_);
    const double ls = norm2(s_);
    det_ = (lp * qrs - lq * rsp) + (lr * spq - ls * pqr);
    lift_ = std::max(std::max(lp, lq), std::max(lr, ls));
  }

  /// The sign by the error bound, or kUnknown.
  int filtered() const {
    constexpr double kUnit = 288 * 0x1p-53;
    const double l2 = lift_ * lift_;
    if (det_ * det_ > (kUnit * kUnit) * l2 * l2 * lift_) return det_ > 0 ? 1 : -1;
    const double bound = kUnit * size();
    if (det_ > bound) return 1;
    if (det_ < -bound) return -1;
    return bound == 0 ? 0 : kUnknown;
  }

  /// The sign where nothing was rounded, or kUnknown: with g the common power of two of the differences, every value on
  /// the way is a multiple of a power of g, at most 72 XYZL and g^5 in the end, and so fits a double if XYZL is small.
  int narrow() const {
    const double g = common_power();
    const double g2 = g * g;
    if (128 * size() > 0x1p53 * (g2 * g2 * g)) return kUnknown;
    return det_ > 0 ? 1 : det_ < 0 ? -1 : 0;
  }

  /// The sign by the rungs after the filter.
  int unfiltered() const;

 private:
  double size() const {
    const double x = std::max(std::max(std::fabs(p_.x), std::fabs(q_.x)), std::max(std::fabs(r_.x), std::fabs(s_.x)));
    const double y = std::max(std::max(std::fabs(p_.y), std::fabs(q_.y)), std::max(std::fabs(r_.y), std::fabs(s_.y)));
    const double z = std::max(std::max(std::fabs(p_.z), std::fabs(q_.z)), std::max(std::fabs(r_.z), std::fabs(s_.z)));
    return x * y * z * lift_;
  }
  double common_power() const {
    const auto steps = [](double x) { return static_cast<std::int64_t>(x * 0x1p42); };
    const auto bits = [&](const Vec3& v) { return steps(v.x) | steps(v.y) | steps(v.z); };
    const std::int64_t all = bits(p_) | bits(q_) | bits(r_) | bits(s_);
    return 0x1p-42 * static_cast<double>(all & -all);
  }

  Vec3 p_, q_, r_, s_;
  double det_ = 0, lift_ = 0;
};

}  // namespace curvetet::filters
