// Larger changes: a node moved or taken out, all triangles replaced, new loops under old interior nodes.
#include <algorithm>

#include "planar/corners.h"
#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet {
namespace {

struct DirectedEdge {
  NodeId a, b;
  FaceEdge edge;
  std::int32_t use = -1;
  bool boundary = false;
  bool operator<(const DirectedEdge& o) const { return std::pair(a, b) < std::pair(o.a, o.b); }
  bool operator==(const DirectedEdge& o) const { return a == o.a && b == o.b; }
};

const DirectedEdge* find_directed(const std::vector<DirectedEdge>& sorted, NodeId a, NodeId b) {
  const DirectedEdge key{a, b, {}};
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), key);
  return at != sorted.end() && *at == key ? &*at : nullptr;
}

}  // namespace

bool FaceMesh::move_node(NodeId n, Vec2 q) {
  if (n.value() >= nodes_.size()) return false;
  star(n, scratch_);
  for (const TriangleId t : scratch_) {
    const FaceTriangle& f = triangles_[t];
    const int i = f.node[0] == n ? 0 : f.node[1] == n ? 1 : 2;
    if (f.use[next(i)] != -1 || f.use[previous(i)] != -1) return false;
    if (orient2d(q, point(f.node[next(i)]), point(f.node[previous(i)])) <= 0) return false;
  }
  if (scratch_.empty()) return false;
  nodes_[n].q = q;
  return true;
}

bool FaceMesh::remove_node(NodeId n) {
  std::vector<TriangleId> changed;
  return remove_node(n, FlipWanted(), changed);
}

// The link of the node is a star-shaped polygon; it has an ear that turns left and holds no other link node (Meisters,
// "Polygons have ears", 1975). The least ear in the order of the link is cut off until a triangle is left.
bool FaceMesh::remove_node(NodeId n, const FlipWanted& wanted, std::vector<TriangleId>& changed) {
  changed.clear();
  if (n.value() >= nodes_.size() || !node_triangle_[n].valid()) return false;
  std::vector<TriangleId> cavity;
  star(n, cavity);
  std::vector<NodeId> link_nodes;
  for (const TriangleId t : cavity) {
    const FaceTriangle& f = triangles_[t];
    const int i = f.node[0] == n ? 0 : f.node[1] == n ? 1 : 2;
    if (f.use[next(i)] != -1 || f.use[previous(i)] != -1) return false;
    link_nodes.push_back(f.node[next(i)]);
  }
  std::vector<std::array<NodeId, 3>> fill;
  const auto is_ear = [&](std::size_t k) {
    const std::size_t m = link_nodes.size();
    const NodeId a = link_nodes[(k + m - 1) % m], b = link_nodes[k], c = link_nodes[(k + 1) % m];
    if (orient2d(point(a), point(b), point(c)) <= 0) return false;
    return std::none_of(link_nodes.begin(), link_nodes.end(), [&](NodeId p) {
      return p != a && p != b && p != c && orient2d(point(a), point(b), point(p)) >= 0 &&
             orient2d(point(b), point(c), point(p)) >= 0 && orient2d(point(c), point(a), point(p)) >= 0;
    });
  };
  while (link_nodes.size() > 3) {
    const std::size_t m = link_nodes.size();
    std::size_t k = 0;
    while (k < m && !is_ear(k)) ++k;
    CURVETET_CHECK(k < m);
    fill.push_back({link_nodes[(k + m - 1) % m], link_nodes[k], link_nodes[(k + 1) % m]});
    link_nodes.erase(link_nodes.begin() + static_cast<std::ptrdiff_t>(k));
  }
  fill.push_back({link_nodes[0], link_nodes[1], link_nodes[2]});
  node_triangle_[n] = TriangleId();
  replace_cavity(cavity, fill, changed);
  if (wanted) restore_around(changed, wanted);
  return true;
}

// Triangles that turn left and have the boundary of the old ones cover the same domain once, whatever they are.
bool FaceMesh::replace(const std::vector<std::array<NodeId, 3>>& triangles) {
  std::vector<DirectedEdge> old_edges, edges;
  std::size_t boundary = 0;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const FaceTriangle& f = triangles_[TriangleId(t)];
    for (int i = 0; f.alive() && i < 3; ++i) {
      if (f.use[i] == -1) continue;
      const auto [a, b] = ends({TriangleId(t), i});
      old_edges.push_back({a, b, {TriangleId(t), i}, f.use[i], !f.neighbour[i].valid()});
      boundary += !f.neighbour[i].valid();
    }
  }
  std::sort(old_edges.begin(), old_edges.end());
  IndexedVector<TriangleId, FaceTriangle> made;
  IndexedVector<NodeId, TriangleId> at(nodes_.size(), TriangleId());
  for (const std::array<NodeId, 3>& nodes : triangles) {
    for (const NodeId n : nodes) {
      if (n.value() >= nodes_.size()) return false;
    }
    if (orient2d(point(nodes[0]), point(nodes[1]), point(nodes[2])) <= 0) return false;
    const TriangleId t = made.push_back({});
    made[t].node = nodes;
    for (int i = 0; i < 3; ++i) {
      at[nodes[i]] = t;
      edges.push_back({nodes[next(i)], nodes[previous(i)], {t, i}});
    }
  }
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  std::size_t found = 0, single = 0;
  for (const DirectedEdge& e : edges) {
    const DirectedEdge* old = find_directed(old_edges, e.a, e.b);
    const DirectedEdge* twin = find_directed(edges, e.b, e.a);
    if ((twin == nullptr) != (old != nullptr && old->boundary)) return false;
    FaceTriangle& f = made[e.edge.triangle];
    if (old) f.use[e.edge.local] = old->use;
    if (twin) f.neighbour[e.edge.local] = twin->edge.triangle;
    found += old != nullptr;
    single += twin == nullptr;
  }
  if (found != old_edges.size() || single != boundary) return false;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (at[NodeId(n)].valid() != node_triangle_[NodeId(n)].valid()) return false;
  }
  triangles_ = std::move(made);
  node_triangle_ = std::move(at);
  free_.clear();
  return true;
}

void FaceMesh::rename(const std::function<VertexId(VertexId)>& new_id) {
  index_.clear();
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    nodes_[NodeId(n)].vertex = new_id(nodes_[NodeId(n)].vertex);
    index_.add(nodes_[NodeId(n)].vertex, NodeId(n));
  }
  for (VertexId& pole : poles_) pole = new_id(pole);
}

std::vector<LoopFault> FaceMesh::rebuild(const FaceInput& input, std::vector<VertexId>& dropped) {
  dropped.clear();
  std::vector<bool> constrained(nodes_.size(), false);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (int i = 0; triangles_[TriangleId(t)].alive() && i < 3; ++i) {
      if (!is_constrained({TriangleId(t), i})) continue;
      for (const NodeId n : ends({TriangleId(t), i})) constrained[n.value()] = true;
    }
  }
  FaceMesh fresh;
  fresh.chart = chart;
  std::vector<LoopFault> faults = fresh.build(input);
  if (!faults.empty()) return faults;
  const FlipWanted delaunay = [&fresh](NodeId a, NodeId b, NodeId c, NodeId d) {
    return incircle(fresh.point(a), fresh.point(b), fresh.point(c), fresh.point(d)) > 0;
  };
  TriangleId hint;
  std::vector<TriangleId> changed;
  for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
    const FaceNode& node = nodes_[NodeId(k)];
    if (constrained[k] || !node_triangle_[NodeId(k)].valid() || !fresh.nodes_of(node.vertex).empty()) continue;
    const std::optional<TriangleId> t = fresh.locate(node.q, hint);
    if (!t || fresh.judge_insert(node.q, *t) != PlanarRefusal::none) {
      dropped.push_back(node.vertex);
      continue;
    }
    fresh.insert(node.vertex, node.q, *t, delaunay, changed);
    hint = changed.front();
  }
  *this = std::move(fresh);
  return {};
}

}  // namespace curvetet
