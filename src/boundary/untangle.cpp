// Two curves that leave a vertex in nearly the same direction cross each other in the chart close to it, within the
// tolerance of their parameter curves, and more segments only show it better. The node that is the least on the wrong
// side is moved to the other. Moving whole curves was rejected: their other ends are right.

#include "boundary/untangle.h"

#include <array>
#include <cmath>
#include <optional>

#include "geometry/frame.h"
#include "predicates/predicates.h"

namespace curvetet {

namespace {

constexpr double kMargin = 0.1;        ///< of the depth, beyond the segment
constexpr double kLeast = 64 * kGrid;  ///< and at least this
constexpr double kSlack = 2;           ///< of the tolerances

struct Segment {
  ChainInput* chain = nullptr;
  std::size_t index = 0;  ///< of its first node
  Vec2 a() const { return chain->q[index]; }
  Vec2 b() const { return chain->q[index + 1]; }
};

Segment find(FaceInput& input, std::int32_t use, std::size_t index) {
  for (LoopInput& loop : input.loops) {
    for (ChainInput& chain : loop.chains) {
      if (chain.use == use && index + 1 < chain.q.size()) return {&chain, index};
    }
  }
  return {};
}

/// A node and where it would go.
struct Move {
  Vec2* q = nullptr;
  Vec2 to;
  double depth = 0;
};

/// On which side of a segment the chain of a node runs: that of the nearest node after it, away from the segment.
int right_side(const Segment& moving, bool second, const Segment& fixed) {
  const std::vector<Vec2>& q = moving.chain->q;
  const std::size_t node = moving.index + (second ? 1 : 0);
  // First towards the other end of the moving segment, then beyond the node itself.
  for (std::size_t k = 1; k < q.size(); ++k) {
    for (const bool back : {second, !second}) {
      if (back ? k > node : node + k >= q.size()) continue;
      const int side = orient2d(fixed.a(), fixed.b(), q[back ? node - k : node + k]);
      if (side != 0) return side;
    }
  }
  return 0;
}

std::optional<Move> move_of(const Segment& moving, bool second, const Segment& fixed) {
  const std::size_t node = moving.index + (second ? 1 : 0);
  if (node == 0 || node + 1 == moving.chain->q.size()) return std::nullopt;  // a CAD vertex
  Vec2& q = moving.chain->q[node];
  const Vec2 along = fixed.b() - fixed.a();
  const double length = norm(along);
  if (!(length > 0)) return std::nullopt;
  const int side = right_side(moving, second, fixed);
  const double height = cross(along, q - fixed.a()) / length;
  if (side == 0 || side * height > 0) return std::nullopt;
  const double depth = std::abs(height) * (1 + kMargin) + kLeast;
  const Vec2 to = q + (side * depth / length) * Vec2{-along.y, along.x};
  return Move{&q, {snap(to.x), snap(to.y)}, depth};
}

}  // namespace

bool untangle(const std::vector<LoopFault>& faults, const Surface& surface, const Chart& chart,
              const std::function<double(std::int32_t use)>& tolerance, FaceInput& input) {
  bool moved = false;
  for (const LoopFault& fault : faults) {
    if (fault.use_a < 0 || fault.use_b < 0) continue;
    const Segment s = find(input, fault.use_a, fault.segment_a), t = find(input, fault.use_b, fault.segment_b);
    if (s.chain == nullptr || t.chain == nullptr) continue;
    std::optional<Move> best;
    for (const auto& [moving, fixed] : {std::pair(s, t), std::pair(t, s)}) {
      for (const bool second : {false, true}) {
        const std::optional<Move> move = move_of(moving, second, fixed);
        if (move && (!best || move->depth < best->depth)) best = move;
      }
    }
    if (!best) continue;
    const SurfaceFirst at = surface.first(chart.to_uv(*best->q));
    const Vec2 d = best->to - *best->q;
    const double distance_moved = norm((d.x / chart.scale_u) * at.du + (d.y / chart.scale_v) * at.dv);
    if (distance_moved > kSlack * (tolerance(fault.use_a) + tolerance(fault.use_b))) continue;
    *best->q = best->to;
    moved = true;
  }
  return moved;
}

}  // namespace curvetet
