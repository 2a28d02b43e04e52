// Cavities are grown tet by tet, and each asks for its neighbours: their spheres are evaluated side by side in vectors
// of four doubles, which the compiler splits where the processor has none. The formulas are those of filters.h.
//
// Rejected: spheres kept with their tets (as many bytes as the tets themselves, and each is asked only twice).
#include "spatial/insphere_four.h"

#include <cmath>
#include <cstddef>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

// Vectors are passed between functions that are all inlined: how they would be passed is of no concern.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace curvetet::kernel {

namespace {

using Four [[gnu::vector_size(32)]] = double;
using Bits [[gnu::vector_size(32)]] = std::int64_t;

struct Points {
  Four x, y, z;
};

[[gnu::always_inline]] inline Four row(const void* sites, VertexId v) {
  Four out;
  std::memcpy(&out, static_cast<const std::byte*>(sites) + sizeof(Four) * v.value(), sizeof(Four));
  return out;
}

/// Vertices of four tets, seen from p.
[[gnu::always_inline]] inline Points seen_from(const void* sites, VertexId a, VertexId b, VertexId c, VertexId d,
                                               const Vec3& p) {
  const Four row0 = row(sites, a), row1 = row(sites, b), row2 = row(sites, c), row3 = row(sites, d);
  const Four even01 = __builtin_shufflevector(row0, row1, 0, 4, 2, 6);  // x0 x1 z0 z1
  const Four even23 = __builtin_shufflevector(row2, row3, 0, 4, 2, 6);  // x2 x3 z2 z3
  const Four odd01 = __builtin_shufflevector(row0, row1, 1, 5, 3, 7);   // y0 y1, then what is no coordinate
  const Four odd23 = __builtin_shufflevector(row2, row3, 1, 5, 3, 7);   // y2 y3
  return {__builtin_shufflevector(even01, even23, 0, 1, 4, 5) - p.x,
          __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5) - p.y,
          __builtin_shufflevector(even01, even23, 2, 3, 6, 7) - p.z};
}

[[gnu::always_inline]] inline Four minor(const Points& a, const Points& b) { return a.x * b.y - a.y * b.x; }
[[gnu::always_inline]] inline Four lift(const Points& a) { return a.x * a.x + a.y * a.y + a.z * a.z; }
[[gnu::always_inline]] inline Four larger(Four a, Four b) { return a > b ? a : b; }

/// All ones in the lanes where it holds.
struct Lanes {
  Bits known, inside, on;
};

[[gnu::always_inline]] inline Lanes evaluate(const void* sites, const Corners& first, const Corners& second,
                                             const Corners& third, const Corners& fourth, const Vec3& from,
                                             double exact) {
  const Points p = seen_from(sites, first[0], second[0], third[0], fourth[0], from),
               q = seen_from(sites, first[1], second[1], third[1], fourth[1], from),
               r = seen_from(sites, first[2], second[2], third[2], fourth[2], from),
               s = seen_from(sites, first[3], second[3], third[3], fourth[3], from);
  const Four pq = minor(p, q), qr = minor(q, r), rs = minor(r, s), sp = minor(s, p), pr = minor(p, r), qs = minor(q, s);
  const Four lp = lift(p), lq = lift(q), lr = lift(r), ls = lift(s);
  const Four det = (lp * (q.z * rs - r.z * qs + s.z * qr) - lq * (r.z * sp + s.z * pr + p.z * rs)) +
                   (lr * (s.z * pq + p.z * qs + q.z * sp) - ls * (p.z * qr - q.z * pr + r.z * pq));
  const Four most = larger(larger(lp, lq), larger(lr, ls)), squared = most * most, size = squared * squared * most;
  constexpr double kUnit = 288 * 0x1p-53;
  return {(det * det > (kUnit * kUnit) * size) | (size <= exact), det > 0, det == 0};
}

#ifdef __x86_64__
[[gnu::target("avx2")]] Verdicts evaluate_avx2(const void* sites, const Corners& first, const Corners& second,
                                               const Corners& third, const Corners& fourth, const Vec3& p,
                                               double exact) {
  const Lanes lanes = evaluate(sites, first, second, third, fourth, p, exact);
  __m256d known, inside, on;
  std::memcpy(&known, &lanes.known, sizeof(known));
  std::memcpy(&inside, &lanes.inside, sizeof(inside));
  std::memcpy(&on, &lanes.on, sizeof(on));
  return {static_cast<unsigned>(_mm256_movemask_pd(known)), static_cast<unsigned>(_mm256_movemask_pd(inside)),
          static_cast<unsigned>(_mm256_movemask_pd(on))};
}
#endif

Verdicts evaluate_plain(const void* sites, const Corners& first, const Corners& second, const Corners& third,
                        const Corners& fourth, const Vec3& p, double exact) {
  const Lanes lanes = evaluate(sites, first, second, third, fourth, p, exact);
  Verdicts verdicts;
  for (unsigned k = 0; k < 4; ++k) {
    verdicts.known |= static_cast<unsigned>(lanes.known[k] & 1) << k;
    verdicts.inside |= static_cast<unsigned>(lanes.inside[k] & 1) << k;
    verdicts.on |= static_cast<unsigned>(lanes.on[k] & 1) << k;
  }
  return verdicts;
}

}  // namespace

double exact_below(double power) {
  // 128 XYZL <= 2^53 g^5 is enough, and XYZ <= L^(3/2); squared, that is 2^14 L^5 <= 2^106 g^10.
  return 0x1p92 * std::pow(power, 10);
}

InsphereFour insphere_four() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return evaluate_avx2;
#endif
  return evaluate_plain;
}

InsphereFour plain_insphere_four() { return evaluate_plain; }

}  // namespace curvetet::kernel
