// Construction: the loops as a plane graph without faults; Delaunay triangulation of its nodes in the square [-1,1]^2,
// in the order of a Hilbert curve; recovery of every segment; winding numbers by flooding, which name the domain and
// every loop that is not where it belongs; what is outside is dropped. A square of real corners needs no ghost
// triangles and no infinite vertex, and since the loops bound the domain its size does not show in the result.
#include <algorithm>
#include <limits>

#include "planar/face_mesh.h"
#include "planar/loops.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

/// Place along the Hilbert curve through a square of 2^16 cells a side.
std::uint32_t hilbert(Vec2 q) {
  auto x = static_cast<std::uint32_t>((q.x + 1) * 32767.0), y = static_cast<std::uint32_t>((q.y + 1) * 32767.0);
  std::uint32_t place = 0;
  for (std::uint32_t s = 1U << 15; s > 0; s >>= 1) {
    const std::uint32_t right = (x & s) != 0, up = (y & s) != 0;
    place = 4 * place + ((3 * right) ^ up);
    if (up == 0) {
      if (right == 1) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return place;
}

// While the mesh is being built an edge's `use` names its segment: from the segment's left, kNone - 1 - it from its
// right.
constexpr std::int32_t kNone = -1;
constexpr std::int32_t right_of(std::size_t segment) { return kNone - 1 - static_cast<std::int32_t>(segment); }
constexpr std::size_t segment_of(std::int32_t use) {
  return static_cast<std::size_t>(use >= 0 ? use : kNone - 1 - use);
}

}  // namespace

class FaceMeshBuilder {
 public:
  FaceMeshBuilder(const Chart& chart, const FaceInput& input) : graph_(assemble(input)) { mesh_.chart = chart; }

  std::vector<LoopFault> run() {
    std::vector<LoopFault> faults = std::move(graph_.faults);
    if (graph_.segments.empty() && faults.empty()) faults.push_back({-1, -1, 0, 0, "no domain"});
    const std::vector<LoopFault> crossings = find_crossings(graph_);
    faults.insert(faults.end(), crossings.begin(), crossings.end());
    if (!faults.empty()) return faults;
    triangulate_nodes();
    recover_segments();
    flood();
    faults = misplaced();
    if (!faults.empty()) return faults;
    keep_domain();
    return {};
  }
  FaceMesh take() { return std::move(mesh_); }

 private:
  bool incircle_wanted(NodeId a, NodeId b, NodeId c, NodeId d) const {
    return incircle(mesh_.point(a), mesh_.point(b), mesh_.point(c), mesh_.point(d)) > 0;
  }

  void triangulate_nodes() {
    const std::size_t n = graph_.nodes.size();
    mesh_.triangles_.reserve(2 * n + 8);
    for (const FaceNode& node : graph_.nodes) mesh_.add_node(node.vertex, node.q);
    const NodeId sw = mesh_.add_node({}, {-1, -1}), se = mesh_.add_node({}, {1, -1});
    const NodeId ne = mesh_.add_node({}, {1, 1}), nw = mesh_.add_node({}, {-1, 1});
    TriangleId hint = mesh_.add_triangle(sw, se, ne);
    mesh_.link({hint, 1}, {mesh_.add_triangle(sw, ne, nw), 2});

    std::vector<std::pair<std::uint32_t, NodeId>> order;
    for (std::uint32_t k = 0; k < n; ++k) order.emplace_back(hilbert(graph_.nodes[NodeId(k)].q), NodeId(k));
    std::sort(order.begin(), order.end());
    const FaceMesh::FlipWanted delaunay = [this](auto... nodes) { return incircle_wanted(nodes...); };
    std::vector<TriangleId> fan;
    for (const auto& [place, node] : order) {
      const std::optional<TriangleId> at = mesh_.locate(mesh_.point(node), hint);
      CURVETET_CHECK(at.has_value());
      fan.clear();
      mesh_.place(node, *at, fan);
      mesh_.flip_star(node, fan, delaunay);
      hint = fan.front();
    }
  }

  void recover_segments() {
    std::vector<TriangleId> made;
    for (std::size_t s = 0; s < graph_.segments.size(); ++s) {
      const auto [a, b] = std::pair(graph_.segments[s].a, graph_.segments[s].b);
      mesh_.recover_edge(a, b, made);
      const std::optional<FaceEdge> left = mesh_.find_edge(a, b);
      CURVETET_CHECK(left && mesh_.ends(*left)[0] == a);
      const FaceEdge right = mesh_.mirror(*left);
      mesh_.triangles_[left->triangle].use[left->local] = static_cast<std::int32_t>(s);
      std::int32_t& mark = mesh_.triangles_[right.triangle].use[right.local];
      if (mark < 0) mark = right_of(s);  // else the other side of a slit
    }
    // Every triangle, not only the recovered ones: marks made on the way do not matter to an edge that is not
    // constrained.
    if (!made.empty()) mesh_.restore([this](auto... nodes) { return incircle_wanted(nodes...); }, made);
  }

  /// 1 on the left of a one-sided segment, else 0.
  int step(std::int32_t use) const { return use >= 0 && !graph_.segments[static_cast<std::size_t>(use)].two_sided; }

  void flood() {
    winding_.assign(mesh_.triangles_.size(), kUnknown);
    std::vector<TriangleId> queue{mesh_.node_triangle_[NodeId(graph_.nodes.size())]};  // at a corner of the square
    winding_[queue.front()] = 0;
    while (!queue.empty()) {
      const TriangleId t = queue.back();
      queue.pop_back();
      for (int i = 0; i < 3; ++i) {
        const FaceEdge other = mesh_.across({t, i});
        if (!other.triangle.valid() || winding_[other.triangle] != kUnknown) continue;
        const int inward = step(mesh_.triangles_[other.triangle].use[other.local]);
        winding_[other.triangle] = winding_[t] + inward - step(mesh_.triangles_[t].use[i]);
        queue.push_back(other.triangle);
      }
    }
  }

  /// Left of a segment the winding number must be 1; right of it 0, or 1 where a slit or two-sided chain runs.
  std::vector<LoopFault> misplaced() const {
    std::vector<bool> faulty(graph_.segments.size(), false);
    for (std::uint32_t k = 0; k < mesh_.triangles_.size(); ++k) {
      const TriangleId t(k);
      for (const std::int32_t use : mesh_.triangles_[t].use) {
        if (use == kNone) continue;
        const std::size_t s = segment_of(use);
        const bool domain = use >= 0 || graph_.segments[s].two_sided;
        if (winding_[t] != (domain ? 1 : 0)) faulty[s] = true;
      }
    }
    std::vector<LoopFault> faults;
    if (std::find(faulty.begin(), faulty.end(), true) != faulty.end()) faults = describe_nesting(graph_, faulty);
    for (const NodeId n : graph_.isolated) {
      std::vector<TriangleId> around;
      mesh_.star(n, around);
      const bool inside = std::any_of(around.begin(), around.end(), [this](TriangleId t) { return winding_[t] == 1; });
      if (!inside) faults.push_back({-1, -1, 0, 0, "isolated vertex outside of the domain"});
    }
    return faults;
  }

  /// Renumbers the triangles of the domain in their order; the square's corners, the last four nodes, go.
  void keep_domain() {
    IndexedVector<TriangleId, TriangleId> number(mesh_.triangles_.size());
    std::uint32_t count = 0;
    for (std::uint32_t k = 0; k < number.size(); ++k) {
      if (winding_[TriangleId(k)] == 1) number[TriangleId(k)] = TriangleId(count++);
    }
    FaceMesh kept;
    kept.chart = mesh_.chart;
    kept.nodes_ = std::move(graph_.nodes);
    kept.node_triangle_.assign(kept.nodes_.size(), TriangleId());
    for (std::uint32_t n = 0; n < kept.nodes_.size(); ++n) kept.index_.add(kept.nodes_[NodeId(n)].vertex, NodeId(n));
    kept.triangles_.reserve(count);
    for (std::uint32_t k = 0; k < number.size(); ++k) {
      if (number[TriangleId(k)].valid()) keep_triangle(mesh_.triangles_[TriangleId(k)], number, kept);
    }
    kept.find_pinched();
    kept.index_boundary();
    mesh_ = std::move(kept);
  }

  void keep_triangle(FaceTriangle f, const IndexedVector<TriangleId, TriangleId>& number, FaceMesh& kept) const {
    for (int i = 0; i < 3; ++i) {
      if (f.neighbour[i].valid()) f.neighbour[i] = number[f.neighbour[i]];
      if (f.use[i] == kNone) continue;
      f.use[i] = graph_.segments[segment_of(f.use[i])].use;
      ++kept.constrained_;
    }
    const TriangleId t = kept.triangles_.push_back(f);
    for (const NodeId n : f.node) kept.node_triangle_[n] = t;
  }

  static constexpr int kUnknown = std::numeric_limits<int>::min();
  LoopGraph graph_;
  FaceMesh mesh_;
  IndexedVector<TriangleId, int> winding_;
};

std::vector<LoopFault> FaceMesh::build(const FaceInput& input) {
  FaceMeshBuilder builder(chart, input);
  std::vector<LoopFault> faults = builder.run();
  if (faults.empty()) *this = builder.take();
  return faults;
}

}  // namespace curvetet
