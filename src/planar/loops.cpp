// Pairs of segments are found through a uniform grid and decided by orientation signs only. A sweep would have better
// bounds but must order events exactly; a grid cell full of segments costs quadratic box tests, which ten thousand
// segments bear.
#include "planar/loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "planar/segment_grid.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

constexpr std::size_t kMaxPartners = 16;

/// Inside the box that construction puts around the chart, and on the grid.
bool in_chart(Vec2 q) {
  const auto good = [](double x) { return std::fabs(x) < 1 && x * 0x1p42 == std::nearbyint(x * 0x1p42); };
  return good(q.x) && good(q.y);
}

/// Reads the chains of the input into one graph.
class Assembler {
 public:
  explicit Assembler(const FaceInput& input) : input_(input) {}

  LoopGraph run() {
    for (std::size_t l = 0; l < input_.loops.size(); ++l) {
      if (well_formed(input_.loops[l])) add_loop(input_.loops[l], l);
    }
    for (const FaceNode& n : input_.isolated) {
      if (!in_chart(n.q)) {
        fault(-1, 0, "isolated vertex beyond the chart");
      } else {
        graph_.isolated.push_back(node(n.vertex, n.q));
      }
    }
    std::sort(graph_.isolated.begin(), graph_.isolated.end());
    graph_.isolated.erase(std::unique(graph_.isolated.begin(), graph_.isolated.end()), graph_.isolated.end());
    drop_unused_nodes();
    return std::move(graph_);
  }

 private:
  void fault(std::int32_t use, std::size_t segment, const char* what) {
    graph_.faults.push_back({use, -1, segment, 0, what});
  }

  bool well_formed(const LoopInput& loop) {
    const std::size_t before = graph_.faults.size();
    for (std::size_t c = 0; c < loop.chains.size(); ++c) {
      const ChainInput& chain = loop.chains[c];
      if (chain.use < 0 || chain.vertices.size() < 2 || chain.vertices.size() != chain.q.size()) {
        fault(chain.use, 0, "malformed chain");
        continue;
      }
      for (std::size_t i = 0; i < chain.q.size(); ++i) {
        if (!in_chart(chain.q[i])) fault(chain.use, i, "beyond the chart");
      }
      if (c == 0 && loop.open) continue;
      const ChainInput& former = loop.chains[(c + loop.chains.size() - 1) % loop.chains.size()];
      if (former.vertices.size() < 2 || former.vertices.back() != chain.vertices.front()) {
        const std::size_t last = std::max<std::size_t>(former.vertices.size(), 2) - 2;
        graph_.faults.push_back({former.use, chain.use, last, 0, "open loop"});
      }
    }
    return graph_.faults.size() == before;
  }

  void add_loop(const LoopInput& loop, std::size_t l) {
    for (std::size_t c = 0; c < loop.chains.size(); ++c) {
      const ChainInput& chain = loop.chains[c];
      const bool joined = c > 0 || !loop.open;
      const Vec2 start =
          joined ? loop.chains[(c + loop.chains.size() - 1) % loop.chains.size()].q.back() : chain.q.front();
      NodeId a = node(chain.vertices.front(), start);
      for (std::size_t i = 0; i + 1 < chain.vertices.size(); ++i) {
        const NodeId b = node(chain.vertices[i + 1], chain.q[i + 1]);
        if (a != b && graph_.nodes[a].q == graph_.nodes[b].q) {
          fault(chain.use, i, "segment of no length");
        } else if (a != b && !ends_spur(a, b, l)) {
          graph_.segments.push_back({a, b, chain.use, i, l, chain.two_sided || loop.open});
        }
        a = b;
      }
    }
  }

  /// Takes back the last segment if this one returns along it and both lie at one vertex: a degenerate edge whose ends
  /// are one chart point bounds nothing.
  bool ends_spur(NodeId a, NodeId b, std::size_t l) {
    if (graph_.segments.empty() || graph_.nodes[a].vertex != graph_.nodes[b].vertex) return false;
    const LoopSegment& last = graph_.segments.back();
    if (last.loop != l || last.a != b || last.b != a || last.two_sided) return false;
    graph_.segments.pop_back();
    return true;
  }

  /// Nodes whose segments were all left out are no nodes.
  void drop_unused_nodes() {
    IndexedVector<NodeId, NodeId> number(graph_.nodes.size());
    std::vector<bool> used(graph_.nodes.size(), false);
    for (const LoopSegment& s : graph_.segments) used[s.a.value()] = used[s.b.value()] = true;
    for (const NodeId n : graph_.isolated) used[n.value()] = true;
    IndexedVector<NodeId, FaceNode> kept;
    for (std::uint32_t n = 0; n < used.size(); ++n) {
      if (used[n]) number[NodeId(n)] = kept.push_back(graph_.nodes[NodeId(n)]);
    }
    for (LoopSegment& s : graph_.segments) s = {number[s.a], number[s.b], s.use, s.index, s.loop, s.two_sided};
    for (NodeId& n : graph_.isolated) n = number[n];
    graph_.nodes = std::move(kept);
  }

  NodeId node(VertexId vertex, Vec2 q) {
    const auto [at, is_new] = known_.try_emplace(std::tuple(vertex, q.x, q.y), NodeId(graph_.nodes.size()));
    if (is_new) graph_.nodes.push_back({vertex, q});
    return at->second;
  }

  const FaceInput& input_;
  LoopGraph graph_;
  std::map<std::tuple<VertexId, double, double>, NodeId> known_;
};

int sign(double x) { return (x > 0) - (x < 0); }

/// p lies in the box of a and b (on the closed segment, if the three are collinear).
bool in_box(Vec2 a, Vec2 b, Vec2 p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

/// How two segments without a common node meet; null if they do not.
const char* meeting(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) {
    return nullptr;
  }
  const int abc = orient2d(a, b, c), abd = orient2d(a, b, d);
  if (abc * abd > 0) return nullptr;
  const int cda = orient2d(c, d, a), cdb = orient2d(c, d, b);
  if (cda * cdb > 0) return nullptr;
  if (abc * abd < 0 && cda * cdb < 0) return "crossing";
  const bool touch = (abc == 0 && in_box(a, b, c)) || (abd == 0 && in_box(a, b, d)) || (cda == 0 && in_box(c, d, a)) ||
                     (cdb == 0 && in_box(c, d, b));
  return touch ? "touching" : nullptr;
}

/// Two segments from a common node to p and r run over each other.
bool overlap_at(Vec2 common, Vec2 p, Vec2 r) {
  const Vec2 x = p - common, y = r - common;
  return sign(x.x) == sign(y.x) && sign(x.y) == sign(y.y) && orient2d(common, p, r) == 0;
}

const char* conflict(const LoopGraph& graph, const LoopSegment& s, const LoopSegment& t) {
  const auto q = [&graph](NodeId n) { return graph.nodes[n].q; };
  if (s.a == t.a && s.b == t.b) return "overlapping";
  if (s.a == t.b && s.b == t.a) return s.two_sided || t.two_sided ? "overlapping" : nullptr;
  const auto at = [&](NodeId common, NodeId p, NodeId r) {
    return overlap_at(q(common), q(p), q(r)) ? "overlapping" : nullptr;
  };
  if (s.a == t.a) return at(s.a, s.b, t.b);
  if (s.a == t.b) return at(s.a, s.b, t.a);
  if (s.b == t.a) return at(s.b, s.a, t.b);
  if (s.b == t.b) return at(s.b, s.a, t.a);
  return meeting(q(s.a), q(s.b), q(t.a), q(t.b));
}

struct SegmentPair {
  std::uint32_t s, t;
  const char* what;
  friend bool operator<(const SegmentPair& x, const SegmentPair& y) { return std::tie(x.s, x.t) < std::tie(y.s, y.t); }
  friend bool operator==(const SegmentPair& x, const SegmentPair& y) { return x.s == y.s && x.t == y.t; }
};

SegmentGrid grid_of(const LoopGraph& graph) {
  Vec2 low{1, 1}, high{-1, -1};
  for (const FaceNode& n : graph.nodes) {
    low = {std::min(low.x, n.q.x), std::min(low.y, n.q.y)};
    high = {std::max(high.x, n.q.x), std::max(high.y, n.q.y)};
  }
  SegmentGrid grid;
  grid.reset(low, high, graph.segments.size());
  for (std::uint32_t i = 0; i < graph.segments.size(); ++i) {
    const LoopSegment& s = graph.segments[i];
    grid.add({i, i}, graph.nodes[s.a].q, graph.nodes[s.b].q);
  }
  return grid;
}

std::vector<SegmentPair> conflicting_pairs(const LoopGraph& graph, const SegmentGrid& grid) {
  std::vector<SegmentPair> pairs;
  std::vector<std::size_t> partners(graph.segments.size(), 0);
  for (const std::vector<SegmentGrid::Entry>& cell : grid.cells()) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto [s, t] = std::minmax(cell[i].a, cell[j].a);
        if (s == t || partners[s] >= kMaxPartners) continue;
        if (const char* what = conflict(graph, graph.segments[s], graph.segments[t])) {
          pairs.push_back({s, t, what});
          ++partners[s];
        }
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Isolated vertices on a segment, and any two nodes at one point of which one is isolated.
void find_misplaced_nodes(const LoopGraph& graph, const SegmentGrid& grid, std::vector<LoopFault>& faults) {
  for (const NodeId n : graph.isolated) {
    const Vec2 q = graph.nodes[n].q;
    std::vector<std::uint32_t> on;
    grid.near(q, q, [&](SegmentGrid::Entry e) {
      const LoopSegment& s = graph.segments[e.a];
      const Vec2 a = graph.nodes[s.a].q, b = graph.nodes[s.b].q;
      if (s.a != n && s.b != n && in_box(a, b, q) && orient2d(a, b, q) == 0) on.push_back(e.a);
    });
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    for (const std::uint32_t s : on) {
      faults.push_back({graph.segments[s].use, -1, graph.segments[s].index, 0, "isolated vertex on a segment"});
    }
  }
  std::vector<std::pair<double, double>> points;
  for (const NodeId n : graph.isolated) points.emplace_back(graph.nodes[n].q.x, graph.nodes[n].q.y);
  std::sort(points.begin(), points.end());
  if (std::adjacent_find(points.begin(), points.end()) != points.end()) {
    faults.push_back({-1, -1, 0, 0, "two isolated vertices at one point"});
  }
}

double squared_distance(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double t = std::clamp(dot(p - a, d) / norm2(d), 0.0, 1.0);
  return norm2(p - (a + t * d));
}

/// Squared distance of two segments that do not cross.
double squared_distance(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return std::min(
      {squared_distance(a, c, d), squared_distance(b, c, d), squared_distance(c, a, b), squared_distance(d, a, b)});
}

struct Near {
  std::uint32_t segment;
  double distance;
};

/// The segment of another loop nearest to one, if nearer than the bound: looked for in boxes that grow until they hold
/// either one that is near enough or the whole chart.
std::optional<Near> nearest_of_other_loop(const LoopGraph& graph, const SegmentGrid& grid, std::size_t i,
                                          double bound) {
  const auto q = [&graph](NodeId n) { return graph.nodes[n].q; };
  const LoopSegment& s = graph.segments[i];
  const Vec2 a = q(s.a), b = q(s.b);
  std::optional<Near> found;
  for (double reach = std::min(bound, 1.0 / 64);; reach = std::min(bound, 2 * reach)) {
    const Vec2 low{std::min(a.x, b.x) - reach, std::min(a.y, b.y) - reach};
    const Vec2 high{std::max(a.x, b.x) + reach, std::max(a.y, b.y) + reach};
    grid.near(low, high, [&](SegmentGrid::Entry e) {
      const LoopSegment& t = graph.segments[e.a];
      if (t.loop == s.loop) return;
      const double d = std::sqrt(squared_distance(a, b, q(t.a), q(t.b)));
      if (d < bound && (!found || std::pair(d, e.a) < std::pair(found->distance, found->segment))) found = Near{e.a, d};
    });
    if ((found && found->distance <= reach) || reach >= std::min(bound, 4.0)) return found;
  }
}

}  // namespace

LoopGraph assemble(const FaceInput& input) { return Assembler(input).run(); }

std::vector<LoopFault> find_crossings(const LoopGraph& graph) {
  std::vector<LoopFault> faults;
  const SegmentGrid grid = grid_of(graph);
  for (const SegmentPair& p : conflicting_pairs(graph, grid)) {
    const LoopSegment &s = graph.segments[p.s], &t = graph.segments[p.t];
    faults.push_back({s.use, t.use, s.index, t.index, p.what});
  }
  find_misplaced_nodes(graph, grid, faults);
  return faults;
}

std::vector<LoopFault> describe_nesting(const LoopGraph& graph, const std::vector<bool>& faulty) {
  const auto q = [&graph](NodeId n) { return graph.nodes[n].q; };
  std::size_t loops = 0;
  for (const LoopSegment& s : graph.segments) loops = std::max(loops, s.loop + 1);
  std::vector<double> area(loops, 0);
  for (const LoopSegment& s : graph.segments) {
    if (!s.two_sided) area[s.loop] += cross(q(s.a), q(s.b));
  }
  const bool inverted = std::none_of(area.begin(), area.end(), [](double a) { return a > 0; });

  std::vector<LoopFault> faults;
  std::vector<double> best(loops, std::numeric_limits<double>::infinity());
  std::vector<LoopFault> nearest(loops);
  const SegmentGrid grid = grid_of(graph);
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const LoopSegment& s = graph.segments[i];
    if (!faulty[i]) continue;
    if (inverted) {
      faults.push_back({s.use, -1, s.index, 0, "inverted"});
      continue;
    }
    if (nearest[s.loop].what.empty()) nearest[s.loop] = {s.use, -1, s.index, 0, "not nested"};
    if (const auto found = nearest_of_other_loop(graph, grid, i, best[s.loop])) {
      const LoopSegment& t = graph.segments[found->segment];
      best[s.loop] = found->distance;
      nearest[s.loop] = {s.use, t.use, s.index, t.index, "not nested"};
    }
  }
  for (LoopFault& f : nearest) {
    if (!f.what.empty()) faults.push_back(std::move(f));
  }
  return faults;
}

}  // namespace curvetet
