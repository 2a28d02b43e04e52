// Two curves that leave a vertex in nearly the same direction cross each other in the chart close to it, within the
// tolerance of their parameter curves, and more segments only show it better. Both are straightened from the vertex to
// beyond the crossing: two straight lines from one point do not cross. Elsewhere the node that is the least on the
// wrong side is moved to the other. Moving whole curves was rejected: their other ends are right.

#include "boundary/untangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

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

/// How far a point moves on the surface.
double moved_by(const Surface& surface, const Chart& chart, Vec2 from, Vec2 to) {
  const SurfaceFirst at = surface.first(chart.to_uv(from));
  const Vec2 d = to - from;
  return norm((d.x / chart.scale_u) * at.du + (d.y / chart.scale_v) * at.dv);
}

/// A chain from one of its ends to the far node of a segment.
struct Run {
  ChainInput* chain = nullptr;
  bool from_back = false;
  std::size_t count = 0;  ///< of segments

  Vec2& q(std::size_t i) const { return chain->q[from_back ? chain->q.size() - 1 - i : i]; }
  VertexId vertex() const { return from_back ? chain->vertices.back() : chain->vertices.front(); }
};

Run run_to(const Segment& s, bool from_back) {
  return {s.chain, from_back, from_back ? s.chain->q.size() - 1 - s.index : s.index + 1};
}

/// The shortest runs to the crossing from a vertex that both chains end at, if there is one.
std::optional<std::array<Run, 2>> runs_from_common_end(const Segment& s, const Segment& t) {
  std::optional<std::array<Run, 2>> best;
  if (s.chain == t.chain) return best;
  const auto reach = [](const std::array<Run, 2>& runs) {
    return distance(runs[0].q(0), runs[0].q(runs[0].count)) + distance(runs[1].q(0), runs[1].q(runs[1].count));
  };
  for (const bool back_s : {false, true}) {
    for (const bool back_t : {false, true}) {
      const std::array<Run, 2> runs{run_to(s, back_s), run_to(t, back_t)};
      if (runs[0].vertex() != runs[1].vertex()) continue;
      if (!best || reach(runs) < reach(*best)) best = runs;
    }
  }
  return best;
}

/// Where the nodes of a run go, without its last: on the straight line from `start` to it, in proportion to their
/// distances.
std::vector<Vec2> straightened(const Run& run, Vec2 start) {
  std::vector<double> length{0};
  for (std::size_t i = 1; i <= run.count; ++i) length.push_back(length.back() + distance(run.q(i - 1), run.q(i)));
  std::vector<Vec2> line{start};
  for (std::size_t i = 1; i < run.count; ++i) {
    const Vec2 q = start + (length[i] / length.back()) * (run.q(run.count) - start);
    line.push_back({snap(q.x), snap(q.y)});
  }
  return line;
}

/// The chain that stays at one vertex between two chart points, if there is one: an edge that is no longer than its
/// tolerance.
ChainInput* point_between(FaceInput& input, VertexId vertex, Vec2 a, Vec2 b) {
  for (LoopInput& loop : input.loops) {
    for (ChainInput& chain : loop.chains) {
      const bool stays =
          std::all_of(chain.vertices.begin(), chain.vertices.end(), [&](VertexId v) { return v == vertex; });
      if (!stays) continue;
      if ((chain.q.front() == a && chain.q.back() == b) || (chain.q.front() == b && chain.q.back() == a)) return &chain;
    }
  }
  return nullptr;
}

/// Straightens both chains of a crossing from their common vertex up to it; false if there is none, if that would move
/// a node by more than `allowed`, or none at all.
bool straighten(const Segment& s, const Segment& t, const Surface& surface, const Chart& chart, double allowed,
                FaceInput& input) {
  const auto runs = runs_from_common_end(s, t);
  if (!runs) return false;
  const Vec2 start = (*runs)[0].q(0), other = (*runs)[1].q(0);
  ChainInput* between = nullptr;
  if (start != other && (between = point_between(input, (*runs)[0].vertex(), start, other)) == nullptr) return false;
  std::array<std::vector<Vec2>, 2> lines;
  bool moves = false;
  for (std::size_t r = 0; r < 2; ++r) {
    const Run& run = (*runs)[r];
    lines[r] = straightened(run, start);
    for (std::size_t i = 0; i < lines[r].size(); ++i) {
      // Near a pole a node moves far in the chart and nowhere in space; the far end of the run tells.
      const double by =
          std::max(moved_by(surface, chart, run.q(i), lines[r][i]),
                   moved_by(surface, chart, run.q(run.count), run.q(run.count) + (lines[r][i] - run.q(i))));
      if (!(by <= allowed)) return false;
      moves = moves || run.q(i) != lines[r][i];
    }
  }
  if (between != nullptr) std::fill(between->q.begin(), between->q.end(), start);
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t i = 0; i < lines[r].size(); ++i) (*runs)[r].q(i) = lines[r][i];
  return moves;
}

}  // namespace

bool untangle(const std::vector<LoopFault>& faults, const Surface& surface, const Chart& chart,
              const std::function<double(std::int32_t use)>& tolerance, FaceInput& input) {
  bool moved = false;
  for (const LoopFault& fault : faults) {
    if (fault.use_a < 0 || fault.use_b < 0) continue;
    const Segment s = find(input, fault.use_a, fault.segment_a), t = find(input, fault.use_b, fault.segment_b);
    if (s.chain == nullptr || t.chain == nullptr) continue;
    const double allowed = kSlack * (tolerance(fault.use_a) + tolerance(fault.use_b));
    if (straighten(s, t, surface, chart, allowed, input)) {
      moved = true;
      continue;
    }
    std::optional<Move> best;
    for (const auto& [moving, fixed] : {std::pair(s, t), std::pair(t, s)}) {
      for (const bool second : {false, true}) {
        const std::optional<Move> move = move_of(moving, second, fixed);
        if (move && (!best || move->depth < best->depth)) best = move;
      }
    }
    if (!best) continue;
    if (!(moved_by(surface, chart, *best->q, best->to) <= allowed)) continue;
    *best->q = best->to;
    moved = true;
  }
  return moved;
}

}  // namespace curvetet
