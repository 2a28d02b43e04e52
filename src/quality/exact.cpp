// Filter: the determinant of differences in double with Shewchuk's a-priori bound (Shewchuk97, section 4.2), which
// covers the rounding of the differences themselves; where the magnitudes could under- or overflow the filter abstains.
//
// Exact rung: all coordinates are integers times one power of two. They are shifted to integers and the determinant is
// taken over these: 512 bits on the stack where the shifted coordinates fit into 160 bits, which is nearly always, and
// integers of any width otherwise. Expansions would avoid Boost here, but they break down silently at under- and
// overflow, and files may contain any number.
#include "quality/exact.h"

#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>

namespace curvetet::exact {
namespace {

using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<576, 576, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
using Unlimited = boost::multiprecision::cpp_int;

constexpr int kUndecided = 2;
constexpr double kEpsilon = 0x1p-53;
/// Below this a product of three numbers may have lost bits to underflow; above its inverse it may overflow.
constexpr double kTiny = 1e-250;
/// Bits of a shifted coordinate that the 576-bit determinant of differences has room for: 3 * (181 + 1) + 5 < 576.
constexpr int kWideBits = 181;

/// A double as mantissa * 2^exponent.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Dyadic dyadic(double x) {
  if (x == 0) return {};
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  Dyadic result{static_cast<std::int64_t>(std::ldexp(fraction, 53)), exponent - 53};
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(std::abs(result.mantissa)));
  return {result.mantissa >> zeros, result.exponent + zeros};
}

/// Lowest exponent over the numbers that are not zero, and the bits needed once all are shifted to it.
struct Span {
  int lowest = 0, bits = 0;
};

template <std::size_t n>
Span span_of(const std::array<Dyadic, n>& numbers) {
  int lowest = 4096, highest = -4096;
  for (const Dyadic& d : numbers) {
    if (d.mantissa == 0) continue;
    lowest = std::min(lowest, d.exponent);
    const auto width = std::bit_width(static_cast<std::uint64_t>(std::abs(d.mantissa)));
    highest = std::max(highest, d.exponent + static_cast<int>(width));
  }
  return highest < lowest ? Span{} : Span{lowest, highest - lowest};
}

template <class Integer, std::size_t n>
std::array<Integer, n> shifted(const std::array<Dyadic, n>& numbers, int lowest) {
  std::array<Integer, n> result;
  for (std::size_t i = 0; i < n; ++i) {
    result[i] = numbers[i].mantissa;
    if (numbers[i].mantissa != 0) result[i] <<= static_cast<unsigned>(numbers[i].exponent - lowest);
  }
  return result;
}

template <class Integer>
int orientation_of(const std::array<Dyadic, 12>& numbers, int lowest) {
  const std::array<Integer, 12> x = shifted<Integer>(numbers, lowest);
  std::array<Integer, 9> m;
  for (std::size_t i = 0; i < 9; ++i) m[i] = x[i + 3] - x[i % 3];
  const Integer det =
      m[0] * (m[4] * m[8] - m[5] * m[7]) + m[1] * (m[5] * m[6] - m[3] * m[8]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
  return det.sign();
}

template <class Integer>
int turn_of(const std::array<Dyadic, 6>& numbers, int lowest) {
  const std::array<Integer, 6> x = shifted<Integer>(numbers, lowest);
  const Integer det = (x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]);
  return det.sign();
}

int sign_within(double det, double permanent, double bound) {
  if (!(permanent > kTiny && permanent < 1 / kTiny)) return kUndecided;
  if (det > bound * permanent) return 1;
  if (det < -bound * permanent) return -1;
  return kUndecided;
}

int orientation_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  // A difference of doubles is zero only if they are equal: four points of one plane across an axis, as CAD has many.
  if ((u.x == 0 && v.x == 0 && w.x == 0) || (u.y == 0 && v.y == 0 && w.y == 0) || (u.z == 0 && v.z == 0 && w.z == 0))
    return 0;
  const double yz = v.y * w.z, zy = v.z * w.y, zx = v.z * w.x, xz = v.x * w.z, xy = v.x * w.y, yx = v.y * w.x;
  const double det = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx);
  const double permanent = std::abs(u.x) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(u.y) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(u.z) * (std::abs(xy) + std::abs(yx));
  return sign_within(det, permanent, (7 + 56 * kEpsilon) * kEpsilon);
}

int turn_filter(Vec2 a, Vec2 b, Vec2 c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
  return sign_within(left - right, std::abs(left) + std::abs(right), (3 + 16 * kEpsilon) * kEpsilon);
}

Vec2 shadow(Vec3 p, int axis) { return {p[(axis + 1) % 3], p[(axis + 2) % 3]}; }

bool in_box(Vec2 p, Vec2 a, Vec2 b) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

/// Closed segments of one plane, seen along `axis`.
bool coplanar_segments_meet(Vec3 p, Vec3 q, Vec3 a, Vec3 b, int axis) {
  const int pa = turn(a, b, p, axis), qa = turn(a, b, q, axis);
  const int ap = turn(p, q, a, axis), bp = turn(p, q, b, axis);
  if (pa * qa < 0 && ap * bp < 0) return true;
  return (pa == 0 && in_box(shadow(p, axis), shadow(a, axis), shadow(b, axis))) ||
         (qa == 0 && in_box(shadow(q, axis), shadow(a, axis), shadow(b, axis))) ||
         (ap == 0 && in_box(shadow(a, axis), shadow(p, axis), shadow(q, axis))) ||
         (bp == 0 && in_box(shadow(b, axis), shadow(p, axis), shadow(q, axis)));
}

bool coplanar_segment_meets(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const int axis = shadow_axis(a, b, c);
  if (axis < 0) return false;
  const int side = turn(a, b, c, axis);
  const bool inside = turn(a, b, p, axis) != -side && turn(b, c, p, axis) != -side && turn(c, a, p, axis) != -side;
  return inside || coplanar_segments_meet(p, q, a, b, axis) || coplanar_segments_meet(p, q, b, c, axis) ||
         coplanar_segments_meet(p, q, c, a, axis);
}

}  // namespace

int orientation(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const int quick = orientation_filter(a, b, c, d);
  if (quick != kUndecided) return quick;
  const std::array<Dyadic, 12> numbers{dyadic(a.x), dyadic(a.y), dyadic(a.z), dyadic(b.x), dyadic(b.y), dyadic(b.z),
                                       dyadic(c.x), dyadic(c.y), dyadic(c.z), dyadic(d.x), dyadic(d.y), dyadic(d.z)};
  const Span span = span_of(numbers);
  return span.bits <= kWideBits ? orientation_of<Wide>(numbers, span.lowest)
                                : orientation_of<Unlimited>(numbers, span.lowest);
}

int turn(Vec3 a, Vec3 b, Vec3 c, int axis) {
  const Vec2 p = shadow(a, axis), q = shadow(b, axis), r = shadow(c, axis);
  const int quick = turn_filter(p, q, r);
  if (quick != kUndecided) return quick;
  const std::array<Dyadic, 6> numbers{dyadic(p.x), dyadic(p.y), dyadic(q.x), dyadic(q.y), dyadic(r.x), dyadic(r.y)};
  const Span span = span_of(numbers);
  return span.bits <= kWideBits ? turn_of<Wide>(numbers, span.lowest) : turn_of<Unlimited>(numbers, span.lowest);
}

int shadow_axis(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
  }
  for (int i = 0; i < 3; ++i) {
    if (turn(a, b, c, (axis + i) % 3) != 0) return (axis + i) % 3;
  }
  return -1;
}

bool segment_meets_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const int above = orientation(a, b, c, p), below = orientation(a, b, c, q);
  if (above * below > 0) return false;
  if (above == 0 && below == 0) return coplanar_segment_meets(p, q, a, b, c);
  const int ab = orientation(p, q, a, b), bc = orientation(p, q, b, c), ca = orientation(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

}  // namespace curvetet::exact
