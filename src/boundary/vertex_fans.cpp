// Corners of triangles in disjoint sets. In the chart corners are joined across edges with two triangles; what lies on
// the domain's boundary is joined over vertices: the two ends of an edge along a pole, and the two sides of a segment
// used twice. In space all edges are joined over vertices. Rejected: to walk around each vertex, which needs links
// between facets that a set of facets does not have.
#include "boundary/vertex_fans.h"

#include <algorithm>
#include <array>
#include <map>

#include "base/disjoint_sets.h"
#include "conjoint/conjoint.h"

namespace curvetet {

namespace {

class Corners {
 public:
  explicit Corners(std::size_t triangles) : vertex_(3 * triangles), flags_(3 * triangles, 0), sets_(3 * triangles) {}

  static std::uint32_t number(std::size_t triangle, std::size_t k) {
    return static_cast<std::uint32_t>(3 * triangle + k);
  }

  /// A triangle with three different vertices; others join their neighbours, but are no part of a fan.
  void add(std::size_t triangle, const std::array<VertexId, 3>& v) {
    for (std::size_t k = 0; k < 3; ++k) {
      vertex_[number(triangle, k)] = v[k];
      flags_[number(triangle, k)] |= kReal;
    }
  }

  void join(std::uint32_t a, std::uint32_t b) { sets_.join(a, b); }

  void mark_on_boundary(std::uint32_t corner) { flags_[corner] |= kOnBoundary; }

  /// An edge of one triangle, by its corners at the two vertices.
  void add_side(VertexId a, std::uint32_t at_a, VertexId b, std::uint32_t at_b) {
    sides_.push_back({edge_key(a, b), a < b ? at_a : at_b, a < b ? at_b : at_a});
  }

  /// Joins the sides that are two over the same vertices; at all others fans end.
  void join_sides() {
    std::stable_sort(sides_.begin(), sides_.end(), [](const Side& s, const Side& t) { return s.key < t.key; });
    for (std::size_t i = 0, end = 0; i < sides_.size(); i = end) {
      while (end < sides_.size() && sides_[end].key == sides_[i].key) ++end;
      if (end - i == 2) {
        join(sides_[i].low, sides_[i + 1].low);
        join(sides_[i].high, sides_[i + 1].high);
        continue;
      }
      for (std::size_t k = i; k < end; ++k) {
        flags_[sides_[k].low] |= kEnd;
        flags_[sides_[k].high] |= kEnd;
      }
    }
  }

  struct Fan {
    VertexId vertex;
    bool open = false, on_boundary = false;
  };

  std::vector<Fan> fans() {
    std::vector<unsigned> of_set(flags_.size(), 0);
    std::vector<VertexId> vertex(flags_.size());
    for (std::uint32_t c = 0; c < flags_.size(); ++c) {
      of_set[sets_.root(c)] |= flags_[c];
      if ((flags_[c] & kReal) != 0) vertex[sets_.root(c)] = vertex_[c];
    }
    std::vector<Fan> fans;
    for (std::uint32_t c = 0; c < flags_.size(); ++c)
      if ((of_set[c] & kReal) != 0)
        fans.push_back({vertex[c], (of_set[c] & kEnd) != 0, (of_set[c] & kOnBoundary) != 0});
    return fans;
  }

 private:
  static constexpr unsigned kReal = 1, kEnd = 2, kOnBoundary = 4;
  struct Side {
    std::uint64_t key;
    std::uint32_t low, high;
  };

  std::vector<VertexId> vertex_;
  std::vector<unsigned> flags_;
  DisjointSets sets_;
  std::vector<Side> sides_;
};

std::uint32_t corner_at(const FaceMesh& mesh, TriangleId t, NodeId n) {
  const auto& nodes = mesh.triangle(t).node;
  return Corners::number(t.value(), static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), n) - nodes.begin()));
}

void join_edge(const FaceMesh& mesh, TriangleId t, std::size_t i, Corners& corners) {
  const FaceTriangle& f = mesh.triangle(t);
  const NodeId a = f.node[(i + 1) % 3], b = f.node[(i + 2) % 3];
  const std::uint32_t at_a = corner_at(mesh, t, a), at_b = corner_at(mesh, t, b);
  if (const TriangleId across = f.neighbour[i]; across.valid()) {
    corners.join(at_a, corner_at(mesh, across, a));
    corners.join(at_b, corner_at(mesh, across, b));
    return;
  }
  corners.mark_on_boundary(at_a);
  corners.mark_on_boundary(at_b);
  const VertexId va = mesh.node(a).vertex, vb = mesh.node(b).vertex;
  if (va == vb)
    corners.join(at_a, at_b);
  else
    corners.add_side(va, at_a, vb, at_b);
}

/// Fans of the chart that begin and end on its boundary, and one for each vertex that has none of them.
std::map<VertexId, Fans> expected_fans(const FaceMesh& mesh) {
  Corners corners(mesh.triangle_slots());
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const TriangleId id(t);
    if (!mesh.triangle(id).alive()) continue;
    const std::array<VertexId, 3> v = mesh.vertices(id);
    if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) corners.add(t, v);
    for (std::size_t i = 0; i < 3; ++i) join_edge(mesh, id, i, corners);
  }
  corners.join_sides();
  std::map<VertexId, Fans> fans;
  for (const Corners::Fan& fan : corners.fans()) {
    Fans& at = fans[fan.vertex];
    if (fan.on_boundary) ++(fan.open ? at.open : at.closed);
  }
  for (auto& [vertex, at] : fans)
    if (at == Fans{}) at.closed = 1;
  return fans;
}

std::map<VertexId, Fans> found_fans(const std::vector<FacetKey>& facets) {
  Corners corners(facets.size());
  for (std::size_t t = 0; t < facets.size(); ++t) {
    const std::array<VertexId, 3> v{VertexId(facets[t][0]), VertexId(facets[t][1]), VertexId(facets[t][2])};
    corners.add(t, v);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      corners.add_side(v[k], Corners::number(t, k), v[next], Corners::number(t, next));
    }
  }
  corners.join_sides();
  std::map<VertexId, Fans> fans;
  for (const Corners::Fan& fan : corners.fans()) ++(fan.open ? fans[fan.vertex].open : fans[fan.vertex].closed);
  return fans;
}

}  // namespace

std::string describe(const FanFault& fault) {
  const auto words = [](const Fans& fans) {
    return std::to_string(fans.closed) + " closed and " + std::to_string(fans.open) + " open";
  };
  return "the triangles around a vertex of the face form fans, " + words(fault.found) + ", instead of " +
         words(fault.expected);
}

std::vector<FanFault> find_fan_faults(const FaceMesh& t_ps, const std::vector<FacetKey>& facets) {
  std::map<VertexId, std::pair<Fans, Fans>> both;  // found, expected
  for (const auto& [vertex, fans] : found_fans(facets)) both[vertex].first = fans;
  for (const auto& [vertex, fans] : expected_fans(t_ps)) both[vertex].second = fans;
  std::vector<FanFault> faults;
  for (const auto& [vertex, fans] : both)
    if (fans.first != fans.second) faults.push_back({vertex, fans.first, fans.second});
  return faults;
}

}  // namespace curvetet
