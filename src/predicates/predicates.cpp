// Every coordinate is an integer multiple of 2^-42, so all determinants are integers in disguise, at most 135 bits
// (orient3d), 177 bits (incircle) and 223 bits (insphere) wide.
//
// Rungs, cheapest first:
//   filter    double with the bounds derived in filters.h and below;
//   extended  (insphere) the same doubles, where the common power of two of the differences shows that nothing was
//             rounded; so it is on the lattices that CAD bodies love;
//   exact     limbs of 44 bits whose products are summed in 128-bit columns and carried once at the end.
// The exact rungs allocate nothing and do not branch on the data.
//
// Rejected: double-double as the middle rung (it costs as much as the exact rung and still cannot see a zero, which is
// what the filter meets in practice), floating-point expansions (they need no fixed grid, but we have one) and a
// general fixed-width integer (it carries after every operation).
#include "predicates/predicates.h"

#include <array>
#include <cstdlib>

#include "predicates/filters.h"

namespace curvetet {

namespace {

__extension__ using Wide = __int128;

constexpr int kLimb = 44;
constexpr std::int64_t kLimbMask = (std::int64_t{1} << kLimb) - 1;

int sign(Wide x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
int sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// A difference of two grid points in grid steps, at most 2^43 in absolute value.
struct Step3 {
  std::int64_t x, y, z;
};
std::int64_t steps(double difference) { return static_cast<std::int64_t>(difference * 0x1p42); }
Step3 steps(Vec3 a, Vec3 b) { return {steps(a.x - b.x), steps(a.y - b.y), steps(a.z - b.z)}; }

/// x1 y2 - y1 x2, below 2^88.
Wide minor(std::int64_t x1, std::int64_t y1, std::int64_t x2, std::int64_t y2) {
  return static_cast<Wide>(x1) * y2 - static_cast<Wide>(y1) * x2;
}

/// high * 2^44 + low with low in [0, 2^44).
struct Split {
  Wide high;
  std::int64_t low;
};
Split split(Wide x) { return {x >> kLimb, static_cast<std::int64_t>(x & kLimbMask)}; }

/// z1 m1 + z2 m2 + z3 m3 for |z| <= 2^43, |m| < 2^88, as high * 2^44 + low; |high| < 2^90.
Split combine(std::int64_t z1, Wide m1, std::int64_t z2, Wide m2, std::int64_t z3, Wide m3) {
  const Split s1 = split(m1);
  const Split s2 = split(m2);
  const Split s3 = split(m3);
  const Wide low = static_cast<Wide>(s1.low) * z1 + static_cast<Wide>(s2.low) * z2 + static_cast<Wide>(s3.low) * z3;
  const Wide high = s1.high * z1 + s2.high * z2 + s3.high * z3;
  const Split carried = split(low);
  return {high + carried.high, carried.low};
}

int sign(Split s) { return s.high != 0 ? sign(s.high) : s.low != 0 ? 1 : 0; }

/// A sum of products, as columns of weight 2^(44 k); each column stays below 2^100.
struct Columns {
  std::array<Wide, 4> column{};

  /// Adds factor * (minor * lift), |minor| < 2^135 in split form, 0 <= lift < 2^88, factor +-1.
  void add(int factor, Split minor3, Wide lift) {
    const Split upper = split(minor3.high);
    const auto m2 = static_cast<std::int64_t>(upper.high) * factor;
    const std::int64_t m1 = upper.low * factor;
    const std::int64_t m0 = minor3.low * factor;
    const auto l1 = static_cast<std::int64_t>(lift >> kLimb);
    const auto l0 = static_cast<std::int64_t>(lift & kLimbMask);
    column[0] += static_cast<Wide>(m0) * l0;
    column[1] += static_cast<Wide>(m0) * l1 + static_cast<Wide>(m1) * l0;
    column[2] += static_cast<Wide>(m1) * l1 + static_cast<Wide>(m2) * l0;
    column[3] += static_cast<Wide>(m2) * l1;
  }

  int sign() const {
    Wide carry = 0;
    bool below = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const Wide sum = column[k] + carry;
      carry = sum >> kLimb;
      below = below || (sum & kLimbMask) != 0;
    }
    const Wide top = column[3] + carry;
    return top > 0 ? 1 : top < 0 ? -1 : below ? 1 : 0;
  }
};

Wide lift(const Step3& p) {
  return static_cast<Wide>(p.x) * p.x + static_cast<Wide>(p.y) * p.y + static_cast<Wide>(p.z) * p.z;
}

/// insphere of differences from the fifth point.
int insphere_of(const Step3& p, const Step3& q, const Step3& r, const Step3& s) {
  const Wide pq = minor(p.x, p.y, q.x, q.y);
  const Wide qr = minor(q.x, q.y, r.x, r.y);
  const Wide rs = minor(r.x, r.y, s.x, s.y);
  const Wide sp = minor(s.x, s.y, p.x, p.y);
  const Wide pr = minor(p.x, p.y, r.x, r.y);
  const Wide qs = minor(q.x, q.y, s.x, s.y);
  Columns sum;
  sum.add(1, combine(q.z, rs, -r.z, qs, s.z, qr), lift(p));
  sum.add(-1, combine(r.z, sp, s.z, pr, p.z, rs), lift(q));
  sum.add(1, combine(s.z, pq, p.z, qs, q.z, sp), lift(r));
  sum.add(-1, combine(p.z, qr, -q.z, pr, r.z, pq), lift(s));
  return sum.sign();
}

Vec2 drop(Vec3 a, int axis) { return axis == 0 ? Vec2{a.y, a.z} : axis == 1 ? Vec2{a.z, a.x} : Vec2{a.x, a.y}; }

/// Closed intervals [p,q] and [a,b] of the line share a point.
bool intervals_meet(double p, double q, double a, double b) {
  return std::min(p, q) <= std::max(a, b) && std::min(a, b) <= std::max(p, q);
}

/// Closed segments pq and ab share a point.
bool segments_meet(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  if (orient3d(p, q, a, b) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int pqa = orient2d_dropped(p, q, a, axis);
    const int pqb = orient2d_dropped(p, q, b, axis);
    const int abp = orient2d_dropped(a, b, p, axis);
    const int abq = orient2d_dropped(a, b, q, axis);
    // The common plane is seen without loss on this axis if any triple of the four is.
    if (pqa != 0 || pqb != 0 || abp != 0 || abq != 0) return pqa * pqb <= 0 && abp * abq <= 0;
  }
  return intervals_meet(p.x, q.x, a.x, b.x) && intervals_meet(p.y, q.y, a.y, b.y) && intervals_meet(p.z, q.z, a.z, b.z);
}

/// p, in the plane of the triangle, lies in the closed triangle. False for a degenerate triangle.
bool triangle_contains(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  for (int axis = 0; axis < 3; ++axis) {
    const int turn = orient2d_dropped(a, b, c, axis);
    if (turn == 0) continue;
    return turn * orient2d_dropped(a, b, p, axis) >= 0 && turn * orient2d_dropped(b, c, p, axis) >= 0 &&
           turn * orient2d_dropped(c, a, p, axis) >= 0;
  }
  return false;
}

/// All five points in one plane, or a degenerate triangle.
SegmentTriangle segment_triangle_flat(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const bool flat = orient3d(a, b, c, p) == 0;
  const bool meet = (flat && (triangle_contains(p, a, b, c) || triangle_contains(q, a, b, c))) ||
                    segments_meet(p, q, a, b) || segments_meet(p, q, b, c) || segments_meet(p, q, c, a);
  return meet ? SegmentTriangle::touches : SegmentTriangle::disjoint;
}

}  // namespace

PredicateCounts& predicate_counts() {
  static thread_local constinit PredicateCounts counts;
  return counts;
}

int rungs::orient3d_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return filters::orient3d(a, b, c, d); }

int rungs::orient3d_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Step3 p = steps(b, a);
  const Step3 q = steps(c, a);
  const Step3 r = steps(d, a);
  return sign(combine(p.z, minor(q.x, q.y, r.x, r.y), q.z, minor(r.x, r.y, p.x, p.y), r.z, minor(p.x, p.y, q.x, q.y)));
}

int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  PredicateCounts& counts = predicate_counts();
  const int filtered = filters::orient3d(a, b, c, d);
  if (filtered != filters::kUnknown) {
    ++counts.filter;
    return filtered;
  }
  ++counts.exact;
  return rungs::orient3d_exact(a, b, c, d);
}

int rungs::insphere_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  return filters::Insphere(a, b, c, d, e).filtered();
}

int rungs::insphere_extended(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  return filters::Insphere(a, b, c, d, e).narrow();
}

int rungs::insphere_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  return insphere_of(steps(a, e), steps(b, e), steps(c, e), steps(d, e));
}

int filters::Insphere::unfiltered() const {
  PredicateCounts& counts = predicate_counts();
  const int sign_if_narrow = narrow();
  if (sign_if_narrow != kUnknown) {
    ++counts.extended;
    return sign_if_narrow;
  }
  ++counts.exact;
  return insphere_of(steps(p_, {}), steps(q_, {}), steps(r_, {}), steps(s_, {}));
}

int insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  const filters::Insphere value(a, b, c, d, e);
  const int filtered = value.filtered();
  if (filtered == filters::kUnknown) return value.unfiltered();
  ++predicate_counts().filter;
  return filtered;
}

int insphere_perturbed(const std::array<Vec3, 5>& points, const std::array<VertexId, 5>& ids) {
  const auto& [a, b, c, d, e] = points;
  const int exact = insphere(a, b, c, d, e);
  if (exact != 0) return exact;
  unsigned tried = 0;
  for (int round = 0; round < 5; ++round) {
    // The largest id not yet tried: the first mostly decides, so nothing is sorted.
    std::size_t raised = 5;
    for (std::size_t k = 0; k < 5; ++k) {
      if ((tried >> k & 1U) == 0 && (raised == 5 || ids[raised] < ids[k])) raised = k;
    }
    tried |= 1U << raised;
    // The coefficient of the raised point's height in the determinant.
    const int coefficient = raised == 0   ? orient3d(e, b, c, d)
                            : raised == 1 ? orient3d(a, e, c, d)
                            : raised == 2 ? orient3d(a, b, e, d)
                            : raised == 3 ? orient3d(a, b, c, e)
                                          : -orient3d(a, b, c, d);
    if (coefficient != 0) return coefficient;
  }
  return 0;
}

int orient2d(Vec2 a, Vec2 b, Vec2 c) {
  const Vec2 p = b - a;
  const Vec2 q = c - a;
  const double left = p.x * q.y;
  const double right = p.y * q.x;
  const double det = left - right;
  // Two products and a difference: at most 2u(|left| + |right|) to first order.
  const double bound = 3 * 0x1p-53 * (std::fabs(left) + std::fabs(right));
  if (std::fabs(det) > bound || bound == 0) return sign(det);
  return sign(minor(steps(p.x), steps(p.y), steps(q.x), steps(q.y)));
}

int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const Vec2 p = a - d;
  const Vec2 q = b - d;
  const Vec2 r = c - d;
  const double lp = norm2(p);
  const double lq = norm2(q);
  const double lr = norm2(r);
  const double det = lp * cross(q, r) + lq * cross(r, p) + lr * cross(p, q);
  const double permanent = lp * (std::fabs(q.x * r.y) + std::fabs(q.y * r.x)) +
                           lq * (std::fabs(r.x * p.y) + std::fabs(r.y * p.x)) +
                           lr * (std::fabs(p.x * q.y) + std::fabs(p.y * q.x));
  // Minor and lift are each off by 2u of their permanents, their product by one u more, the two sums by two: 7u.
  const double bound = 10 * 0x1p-53 * permanent;
  if (std::fabs(det) > bound || bound == 0) return sign(det);
  const Step3 i{steps(p.x), steps(p.y), 0};
  const Step3 j{steps(q.x), steps(q.y), 0};
  const Step3 k{steps(r.x), steps(r.y), 0};
  Columns sum;
  sum.add(1, split(minor(j.x, j.y, k.x, k.y)), lift(i));
  sum.add(1, split(minor(k.x, k.y, i.x, i.y)), lift(j));
  sum.add(1, split(minor(i.x, i.y, j.x, j.y)), lift(k));
  return sum.sign();
}

int orient2d_dropped(Vec3 a, Vec3 b, Vec3 c, int axis) { return orient2d(drop(a, axis), drop(b, axis), drop(c, axis)); }

bool collinear(Vec3 a, Vec3 b, Vec3 c) {
  return orient2d_dropped(a, b, c, 2) == 0 && orient2d_dropped(a, b, c, 1) == 0 && orient2d_dropped(a, b, c, 0) == 0;
}

bool segments_cross(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  if (orient3d(p, q, a, b) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int sa = orient2d_dropped(p, q, a, axis), sb = orient2d_dropped(p, q, b, axis);
    if (sa * sb > 0) return false;
    if (sa * sb == 0) continue;
    return orient2d_dropped(a, b, p, axis) * orient2d_dropped(a, b, q, axis) < 0;
  }
  return false;
}

SegmentTriangle segment_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c) {
  const int side_p = orient3d(a, b, c, p);
  const int side_q = orient3d(a, b, c, q);
  if (side_p == 0 && side_q == 0) return segment_triangle_flat(p, q, a, b, c);
  if (side_p * side_q > 0) return SegmentTriangle::disjoint;
  const int ab = orient3d(p, q, a, b);
  const int bc = orient3d(p, q, b, c);
  const int ca = orient3d(p, q, c, a);
  const bool left = ab >= 0 && bc >= 0 && ca >= 0;
  const bool right = ab <= 0 && bc <= 0 && ca <= 0;
  if (!left && !right) return SegmentTriangle::disjoint;
  const bool interior = ab != 0 && bc != 0 && ca != 0 && side_p != 0 && side_q != 0;
  return interior ? SegmentTriangle::crosses : SegmentTriangle::touches;
}

}  // namespace curvetet
