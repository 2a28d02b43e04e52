// The boundary as labelled triangles, and as closed surfaces around each solid.
//
// Each boundary facet counts for the region above and for the region below it, outside included. That the edges of a
// region's boundary have an even number of facets follows from conformity; it is counted anew here from the facets
// alone.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/disjoint_sets.h"
#include "quality/checks.h"

namespace curvetet::checks {
namespace {

std::array<std::uint32_t, 3> ascending(std::array<std::uint32_t, 3> v) {
  std::sort(v.begin(), v.end());
  return v;
}

/// True when the triangle's own normal is that of its ascending vertices.
bool even_order(const std::array<std::uint32_t, 3>& v) {
  const int inversions = (v[0] > v[1] ? 1 : 0) + (v[0] > v[2] ? 1 : 0) + (v[1] > v[2] ? 1 : 0);
  return inversions % 2 == 0;
}

BoundaryFacet* find_facet(Topology& topology, const std::array<std::uint32_t, 3>& key) {
  const auto found =
      std::lower_bound(topology.boundary.begin(), topology.boundary.end(), key,
                       [](const BoundaryFacet& f, const std::array<std::uint32_t, 3>& k) { return f.vertices < k; });
  return found != topology.boundary.end() && found->vertices == key ? &*found : nullptr;
}

/// Regions in front of the triangle (where its normal points) and behind it.
struct Sides {
  std::uint32_t front = kOutside, back = kOutside;
  friend bool operator==(const Sides&, const Sides&) = default;
};

class TriangleCheck {
 public:
  TriangleCheck(const Mesh& mesh, Topology& topology, Findings& findings)
      : mesh_(mesh), topology_(topology), findings_(findings), sides_(mesh.faces.size()), seen_(mesh.faces.size(), 0) {}

  void check(std::uint32_t i) {
    const auto key = ascending(mesh_.triangles[i]);
    const auto uses = uses_of(topology_, key);
    if (key[0] == key[1] || key[1] == key[2] || uses.empty()) {
      report("triangle_not_a_facet", Severity::error, i);
      return;
    }
    Sides sides{mesh_.tet_solid[uses[0].tet], mesh_.tet_solid[uses[0].tet]};
    if (BoundaryFacet* facet = find_facet(topology_, key)) {
      if (facet->triangle != kOutside) report("duplicate_triangle", Severity::error, i);
      facet->triangle = i;
      const bool even = even_order(mesh_.triangles[i]);
      sides = even ? Sides{facet->above, facet->below} : Sides{facet->below, facet->above};
    } else {
      report("triangle_inside_a_region", Severity::warning, i);
    }
    check_sides(i, sides);
  }

 private:
  void report(const char* check, Severity severity, std::uint32_t i) {
    findings_.add(check, severity, [&] {
      const std::uint32_t node = mesh_.triangles[i][0];
      return fmt::format("triangle {} of face {} at {}", i, mesh_.faces[mesh_.triangle_face[i]].cad_id,
                         place(vec(mesh_.points[node])));
    });
  }

  void check_sides(std::uint32_t i, Sides sides) {
    const std::uint32_t face = mesh_.triangle_face[i];
    if (seen_[face] == 0) {
      seen_[face] = 1;
      sides_[face] = sides;
    } else if (!(sides_[face] == sides)) {
      report("face_sides_vary", Severity::warning, i);
    }
  }

  const Mesh& mesh_;
  Topology& topology_;
  Findings& findings_;
  std::vector<Sides> sides_;
  std::vector<std::uint8_t> seen_;
};

/// One edge of one boundary facet as the boundary of one region.
struct EdgeOfRegion {
  std::uint32_t region, a, b;
  std::uint32_t corner_a, corner_b;  ///< of the facet's copy for this region
  auto key() const { return std::tie(region, a, b); }
};

/// Facets of all regions' boundaries, a facet between two regions once for each: `corner / 3` numbers them.
std::vector<EdgeOfRegion> edges_of_regions(const Topology& topology) {
  std::vector<EdgeOfRegion> edges;
  edges.reserve(topology.boundary.size() * 6);
  std::uint32_t corner = 0;
  for (const BoundaryFacet& facet : topology.boundary) {
    const auto& v = facet.vertices;
    for (const std::uint32_t region : {facet.above, facet.below}) {
      edges.push_back({region, v[0], v[1], corner, corner + 1});
      edges.push_back({region, v[0], v[2], corner, corner + 2});
      edges.push_back({region, v[1], v[2], corner + 1, corner + 2});
      corner += 3;
    }
  }
  std::sort(edges.begin(), edges.end(), [](const EdgeOfRegion& x, const EdgeOfRegion& y) {
    return std::tuple_cat(x.key(), std::tie(x.corner_a)) < std::tuple_cat(y.key(), std::tie(y.corner_a));
  });
  return edges;
}

void check_edges(const Mesh& mesh, Topology& topology, Findings& findings) {
  const std::vector<EdgeOfRegion> edges = edges_of_regions(topology);
  DisjointSets sheets(topology.boundary.size());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i;
    while (j < edges.size() && edges[j].key() == edges[i].key()) ++j;
    const EdgeOfRegion& e = edges[i];
    if ((j - i) % 2 != 0) {
      findings.add("open_boundary", Severity::error, [&] {
        return fmt::format("edge {} {} at {}", e.a, e.b, place(0.5 * (vec(mesh.points[e.a]) + vec(mesh.points[e.b]))));
      });
    }
    if (e.region != kOutside) {
      --topology.euler[e.region];
      if (j - i > 2) topology.crowded_edges.push_back({e.a, e.b, e.region, j - i});
    } else if (j - i == 2) {
      constexpr std::uint32_t kCornersPerFacet = 6;  // of both regions
      sheets.join(edges[i].corner_a / kCornersPerFacet, edges[i + 1].corner_a / kCornersPerFacet);
    }
    i = j;
  }
  topology.outer_sheet.resize(topology.boundary.size());
  for (std::uint32_t f = 0; f < topology.outer_sheet.size(); ++f) topology.outer_sheet[f] = sheets.root(f);
}

void count_vertices_and_facets(const Mesh& mesh, Topology& topology) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> vertices;
  for (const BoundaryFacet& facet : topology.boundary) {
    for (const std::uint32_t region : {facet.above, facet.below}) {
      if (region == kOutside) continue;
      ++topology.euler[region];
      for (const std::uint32_t v : facet.vertices) vertices.emplace_back(region, v);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const auto& [region, v] : vertices) ++topology.euler[region];
  for (std::uint32_t s = 0; s < mesh.solids.size(); ++s) {
    if (topology.region_components[s] == 0) topology.euler[s] = 0;
  }
}

}  // namespace

std::string describe(const Mesh& mesh, const CrowdedEdge& edge) {
  return fmt::format("edge {} {} has {} boundary facets of solid {}, at {}", edge.a, edge.b, edge.facets,
                     mesh.solids[edge.solid].cad_id,
                     place(0.5 * (vec(mesh.points[edge.a]) + vec(mesh.points[edge.b]))));
}

void check_triangles(const Mesh& mesh, Topology& topology, Findings& findings) {
  TriangleCheck check(mesh, topology, findings);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) check.check(i);
  for (const BoundaryFacet& facet : topology.boundary) {
    if (facet.triangle != kOutside) continue;
    findings.add("unlabelled_boundary_facet", Severity::error, [&] {
      const auto& v = facet.vertices;
      return fmt::format("nodes {} {} {} at {}", v[0], v[1], v[2], place(vec(mesh.points[v[0]])));
    });
  }
}

void check_closedness(const Mesh& mesh, const Model* model, Topology& topology, Findings& findings) {
  topology.euler.assign(mesh.solids.size(), 0);
  check_edges(mesh, topology, findings);
  count_vertices_and_facets(mesh, topology);
  for (std::uint32_t s = 0; s < mesh.solids.size(); ++s) {
    if (topology.region_components[s] > 0) continue;
    findings.add("empty_solid", Severity::error, [&] { return fmt::format("solid {}", mesh.solids[s].cad_id); });
  }
  if (model != nullptr) return;
  for (const CrowdedEdge& edge : topology.crowded_edges) {
    findings.add("crowded_edge", Severity::warning, [&] { return describe(mesh, edge); });
  }
}

}  // namespace curvetet::checks
