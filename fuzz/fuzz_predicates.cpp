// Five grid points from the bytes: the predicates against determinants of unlimited integers, and against the
// validator's own arithmetic. Coordinates are small steps or full width by the first byte, so that ties are frequent.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "oracle/exact_predicates.h"
#include "predicates/predicates.h"
#include "quality/exact.h"

namespace {

double grid_number(const std::uint8_t* bytes, bool coarse) {
  std::int64_t raw = 0;
  std::memcpy(&raw, bytes, sizeof(raw));
  const std::int64_t steps = coarse ? (raw % 5) * (std::int64_t{1} << 39) : raw % (std::int64_t{1} << 42);
  return static_cast<double>(steps) * 0x1p-42;
}

void expect(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace curvetet;
  constexpr std::size_t kNeeded = 1 + 15 * sizeof(std::int64_t);
  if (size < kNeeded) return 0;
  std::array<Vec3, 5> p;
  for (std::size_t i = 0; i < 15; ++i) {
    p[i / 3][static_cast<int>(i % 3)] = grid_number(data + 1 + i * sizeof(std::int64_t), (data[0] & 1U) != 0);
  }
  const int side = orient3d(p[0], p[1], p[2], p[3]);
  expect(side == oracle::orient3d(p[0], p[1], p[2], p[3]));
  expect(side == exact::orientation(p[0], p[1], p[2], p[3]));
  expect(side == -orient3d(p[1], p[0], p[2], p[3]));
  if (side > 0) expect(insphere(p[0], p[1], p[2], p[3], p[4]) == oracle::insphere(p[0], p[1], p[2], p[3], p[4]));
  const bool collinear_points = collinear(p[0], p[1], p[2]);
  expect(collinear_points == (exact::shadow_axis(p[0], p[1], p[2]) < 0));
  if (!collinear_points) {
    const bool meets = segment_triangle(p[3], p[4], p[0], p[1], p[2]) != SegmentTriangle::disjoint;
    expect(meets == exact::segment_meets_triangle(p[3], p[4], p[0], p[1], p[2]));
  }
  return 0;
}
