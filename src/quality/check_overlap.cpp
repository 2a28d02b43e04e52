// Space: the boundary facets meet only where they share vertices, and no vertex lies in a foreign tet. All exact. The
// latter is searched only where check_covering.cpp has no proof.
//
// Two triangles, neither collinear, and their common vertices:
//   none: they meet exactly if an edge of one meets the other triangle;
//   one:  a common part beyond the shared vertex is convex and contains it, so it reaches the far edge of one of them:
//         they meet exactly if the edge opposite to the vertex, of either, meets the other triangle;
//   two:  they meet beyond the edge exactly if they are coplanar and lie on the same side of it.
#include <fmt/format.h>

#include <algorithm>

#include "base/box_tree.h"
#include "base/gather.h"
#include "mesh/tet_complex.h"
#include "quality/checks.h"
#include "quality/exact.h"
#include "quality/point_tree.h"

namespace curvetet::checks {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Moves the vertices that both have to the front of each, in the same order; returns their number.
int align_shared(Triangle& a, Triangle& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto found = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
    if (found == b.end()) continue;
    std::iter_swap(b.begin() + static_cast<std::ptrdiff_t>(shared), found);
    std::swap(a[shared], a[i]);
    ++shared;
  }
  return static_cast<int>(shared);
}

std::array<Vec3, 3> corners(const Mesh& mesh, const Triangle& t) {
  return {vec(mesh.points[t[0]]), vec(mesh.points[t[1]]), vec(mesh.points[t[2]])};
}

bool edge_meets(const std::array<Vec3, 3>& a, std::size_t i, std::size_t j, const std::array<Vec3, 3>& b) {
  return exact::segment_meets_triangle(a[i], a[j], b[0], b[1], b[2]);
}

bool overlap_beyond_edge(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  if (exact::orientation(a[0], a[1], a[2], b[2]) != 0) return false;
  const int axis = exact::shadow_axis(a[0], a[1], a[2]);
  return exact::turn(a[0], a[1], a[2], axis) == exact::turn(b[0], b[1], b[2], axis);
}

bool triangles_meet(const Mesh& mesh, Triangle s, Triangle t) {
  const int shared = align_shared(s, t);
  const std::array<Vec3, 3> a = corners(mesh, s), b = corners(mesh, t);
  switch (shared) {
    case 0:
      for (const auto& [i, j] : {std::pair{0U, 1U}, std::pair{1U, 2U}, std::pair{2U, 0U}}) {
        if (edge_meets(a, i, j, b) || edge_meets(b, i, j, a)) return true;
      }
      return false;
    case 1:
      return edge_meets(a, 1, 2, b) || edge_meets(b, 1, 2, a);
    case 2:
      return overlap_beyond_edge(a, b);
    default:
      return true;
  }
}

Box3 box_of(const Mesh& mesh, std::span<const std::uint32_t> vertices) {
  Box3 box;
  for (const std::uint32_t v : vertices) box.extend(vec(mesh.points[v]));
  return box;
}

PointTree::Box box_around(const Mesh& mesh, const std::array<std::uint32_t, 4>& tet) {
  PointTree::Box box{mesh.points[tet[0]], mesh.points[tet[0]]};
  for (std::size_t i = 1; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], mesh.points[tet[i]][k]);
      box.high[k] = std::max(box.high[k], mesh.points[tet[i]][k]);
    }
  }
  return box;
}

bool inside_or_on(const Mesh& mesh, std::size_t t, std::int8_t sign, Vec3 p) {
  const auto& tet = mesh.tets[t];
  const std::array<Vec3, 4> q{vec(mesh.points[tet[0]]), vec(mesh.points[tet[1]]), vec(mesh.points[tet[2]]),
                              vec(mesh.points[tet[3]])};
  return std::all_of(kFacet.begin(), kFacet.end(), [&](const std::array<int, 3>& f) {
    return sign * exact::orientation(q[static_cast<std::size_t>(f[0])], q[static_cast<std::size_t>(f[1])],
                                     q[static_cast<std::size_t>(f[2])], p) >=
           0;
  });
}

}  // namespace

BoxTree tree_of_boundary(const Mesh& mesh, const Topology& topology) {
  std::vector<Box3> boxes;
  boxes.reserve(topology.boundary.size());
  for (const BoundaryFacet& f : topology.boundary) boxes.push_back(box_of(mesh, f.vertices));
  return BoxTree(boxes);
}

void check_self_intersection(const Mesh& mesh, const Topology& topology, const BoxTree& tree, Context& context,
                             Findings& findings) {
  const auto& boundary = topology.boundary;
  std::vector<std::uint8_t> flat(boundary.size(), 0);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const std::array<Vec3, 3> p = corners(mesh, boundary[i].vertices);
    if (exact::shadow_axis(p[0], p[1], p[2]) >= 0) continue;
    flat[i] = 1;
    findings.add("collinear_facet", Severity::error, [&] {
      return fmt::format("nodes {} {} {} at {}", boundary[i].vertices[0], boundary[i].vertices[1],
                         boundary[i].vertices[2], place(p[0]));
    });
  }
  std::vector<std::vector<std::uint32_t>> met(boundary.size());
  in_blocks(context, boundary.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near;
    for (std::size_t i = begin; i < end && !context.should_stop(); ++i) {
      near.clear();
      tree.overlaps(box_of(mesh, boundary[i].vertices), near);
      std::sort(near.begin(), near.end());
      for (const std::uint32_t j : near) {
        if (j <= i || flat[i] != 0 || flat[j] != 0) continue;
        if (triangles_meet(mesh, boundary[i].vertices, boundary[j].vertices)) met[i].push_back(j);
      }
    }
  });
  const auto face = [&](const BoundaryFacet& f) {
    return f.triangle == kOutside ? 0U : mesh.faces[mesh.triangle_face[f.triangle]].cad_id;
  };
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    for (const std::uint32_t j : met[i]) {
      findings.add("boundary_intersection", Severity::error, [&] {
        const auto &v = boundary[i].vertices, &w = boundary[j].vertices;
        return fmt::format("nodes {} {} {} of face {} and nodes {} {} {} of face {} at {}", v[0], v[1], v[2],
                           face(boundary[i]), w[0], w[1], w[2], face(boundary[j]), place(vec(mesh.points[v[0]])));
      });
    }
  }
}

void check_overlap(const Mesh& mesh, const Topology& topology, const BoxTree& boundary, Context& context,
                   Findings& findings) {
  // A vertex in a foreign tet, or on one, is surrounded by tets of its own in a part of the other: two at a place.
  if (!findings.any_error() && is_covered_once(mesh, topology, boundary)) return;
  std::vector<PointTree::Item> used;
  used.reserve(mesh.points.size());
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
    if (topology.used[v] != 0) used.push_back({mesh.points[v], v});
  const PointTree tree(std::move(used));
  using Overlap = std::pair<std::size_t, std::uint32_t>;  // a tet and a vertex in it
  const auto found =
      gather<Overlap>(context, mesh.tets.size(), kLargeBlock, [&](std::size_t t, std::vector<Overlap>& inside) {
        if (topology.tet_sign[t] == 0 || context.should_stop()) return;
        const auto& tet = mesh.tets[t];
        tree.within(box_around(mesh, tet), [&](const PointTree::Item& item) {
          if (std::find(tet.begin(), tet.end(), item.id) != tet.end()) return;
          if (inside_or_on(mesh, t, topology.tet_sign[t], vec(item.point))) inside.emplace_back(t, item.id);
        });
      });
  for (const auto& [t, v] : found) {
    findings.add("vertex_in_foreign_tet", Severity::error, [&, t = t, v = v] {
      return fmt::format("node {} in tet {} at {}", v, t, place(vec(mesh.points[v])));
    });
  }
}

}  // namespace curvetet::checks
