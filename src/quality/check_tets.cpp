// Arrays, nodes, tets and facets. Facets are filed under their smallest vertex by counting and sorted within each such
// list: no hashing, and the lists can be sorted in parallel with the same outcome.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/disjoint_sets.h"
#include "base/gather.h"
#include "mesh/tet_complex.h"
#include "quality/checks.h"
#include "quality/exact.h"

namespace curvetet::checks {
namespace {

template <std::size_t n>
bool in_range(const std::array<std::uint32_t, n>& indices, std::size_t size) {
  return std::all_of(indices.begin(), indices.end(), [&](std::uint32_t i) { return i < size; });
}

template <std::size_t n>
void check_elements(const char* what, const std::vector<std::array<std::uint32_t, n>>& elements,
                    const std::vector<std::uint32_t>& labels, std::size_t points, std::size_t entities,
                    Findings& findings) {
  if (labels.size() != elements.size()) {
    findings.add("bad_arrays", Severity::error,
                 [&] { return fmt::format("{} {} but {} labels", elements.size(), what, labels.size()); });
    return;
  }
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!in_range(elements[i], points)) {
      findings.add("bad_index", Severity::error, [&] { return fmt::format("{} {}: no such node", what, i); });
    }
    if (labels[i] >= entities) {
      findings.add("bad_label", Severity::error,
                   [&] { return fmt::format("{} {}: no entity {}", what, i, labels[i]); });
    }
  }
}

/// Sorts three numbers; true when that took an odd number of exchanges.
bool sort_odd(std::array<std::uint32_t, 3>& v) {
  bool odd = false;
  for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
    auto &a = v[static_cast<std::size_t>(i)], &b = v[static_cast<std::size_t>(j)];
    if (a <= b) continue;
    std::swap(a, b);
    odd = !odd;
  }
  return odd;
}

std::array<std::uint32_t, 3> facet_of(const std::array<std::uint32_t, 4>& tet, std::size_t local) {
  return {tet[static_cast<std::size_t>(kFacet[local][0])], tet[static_cast<std::size_t>(kFacet[local][1])],
          tet[static_cast<std::size_t>(kFacet[local][2])]};
}

bool repeats_vertex(const std::array<std::uint32_t, 4>& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

void sign_tets(const Mesh& mesh, Topology& topology, Context& context, Findings& findings) {
  topology.tet_sign.resize(mesh.tets.size());
  in_blocks(context, mesh.tets.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& t = mesh.tets[i];
      topology.tet_sign[i] = static_cast<std::int8_t>(exact::orientation(
          vec(mesh.points[t[0]]), vec(mesh.points[t[1]]), vec(mesh.points[t[2]]), vec(mesh.points[t[3]])));
    }
  });
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const auto example = [&] { return fmt::format("tet {} at {}", i, place(vec(mesh.points[mesh.tets[i][0]]))); };
    if (repeats_vertex(mesh.tets[i])) {
      findings.add("repeated_vertex", Severity::error, example);
    } else if (topology.tet_sign[i] <= 0) {
      findings.add(topology.tet_sign[i] == 0 ? "flat_tet" : "negative_tet", Severity::error, example);
    }
  }
}

void file_facets(const Mesh& mesh, Topology& topology, Context& context) {
  topology.facet_begin.assign(mesh.points.size() + 1, 0);
  for (const auto& tet : mesh.tets) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto facet = facet_of(tet, i);
      ++topology.facet_begin[std::min({facet[0], facet[1], facet[2]}) + 1];
    }
  }
  std::partial_sum(topology.facet_begin.begin(), topology.facet_begin.end(), topology.facet_begin.begin());
  std::vector<std::uint32_t> next(topology.facet_begin.begin(), topology.facet_begin.end() - 1);
  topology.facet_uses.resize(mesh.tets.size() * 4);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::uint32_t, 3> facet = facet_of(mesh.tets[t], i);
      const bool odd = sort_odd(facet);
      topology.facet_uses[next[facet[0]]++] = {facet[1], facet[2], static_cast<std::uint32_t>(t), !odd};
    }
  }
  in_blocks(context, mesh.points.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(topology.facet_uses.begin() + topology.facet_begin[v],
                topology.facet_uses.begin() + topology.facet_begin[v + 1], [](const FacetUse& a, const FacetUse& b) {
                  return a.key() != b.key() ? a.key() < b.key() : a.tet < b.tet;
                });
    }
  });
}

/// Whether a positive tet with this order of corners, or a negative one, really lies above.
bool lies_above(const Topology& topology, const FacetUse& use) {
  return use.above == (topology.tet_sign[use.tet] >= 0);
}

/// One facet and all its tets: at most two, on opposite sides; if it parts two regions, it goes to the boundary.
void check_facet(const Mesh& mesh, Topology& topology, std::uint32_t smallest, std::span<const FacetUse> uses,
                 Findings& findings) {
  const std::array<std::uint32_t, 3> vertices{smallest, uses[0].middle, uses[0].largest};
  const auto example = [&] {
    return fmt::format("nodes {} {} {} at {}", vertices[0], vertices[1], vertices[2],
                       place(vec(mesh.points[smallest])));
  };
  if (uses.size() > 2) {
    findings.add("facet_of_many_tets", Severity::error, example);
  } else if (uses.size() == 2 && lies_above(topology, uses[0]) == lies_above(topology, uses[1])) {
    findings.add("tets_on_same_side", Severity::error, example);
  }
  if (uses.size() == 2 && mesh.tet_solid[uses[0].tet] == mesh.tet_solid[uses[1].tet]) return;
  BoundaryFacet facet;
  facet.vertices = vertices;
  facet.tet = uses[0].tet;
  for (const FacetUse& use : uses) (lies_above(topology, use) ? facet.above : facet.below) = mesh.tet_solid[use.tet];
  topology.boundary.push_back(facet);
}

void scan_facets(const Mesh& mesh, Topology& topology, Findings& findings) {
  DisjointSets pieces(mesh.tets.size()), region_pieces(mesh.tets.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const std::uint32_t end = topology.facet_begin[v + 1];
    for (std::uint32_t i = topology.facet_begin[v]; i < end;) {
      std::uint32_t j = i + 1;
      const FacetUse& first = topology.facet_uses[i];
      while (j < end && topology.facet_uses[j].key() == first.key()) {
        const std::uint32_t other = topology.facet_uses[j].tet;
        pieces.join(first.tet, other);
        if (mesh.tet_solid[first.tet] == mesh.tet_solid[other]) region_pieces.join(first.tet, other);
        ++j;
      }
      check_facet(mesh, topology, static_cast<std::uint32_t>(v), std::span(topology.facet_uses).subspan(i, j - i),
                  findings);
      i = j;
    }
  }
  topology.region_components.assign(mesh.solids.size(), 0);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    topology.tet_components += pieces.is_root(t) ? 1 : 0;
    topology.region_components[mesh.tet_solid[t]] += region_pieces.is_root(t) ? 1 : 0;
  }
}

}  // namespace

std::span<const FacetUse> uses_of(const Topology& topology, const std::array<std::uint32_t, 3>& ascending) {
  const auto begin = topology.facet_uses.begin() + topology.facet_begin[ascending[0]];
  const auto end = topology.facet_uses.begin() + topology.facet_begin[ascending[0] + 1];
  const std::uint64_t key = FacetUse{ascending[1], ascending[2]}.key();
  const auto first = std::lower_bound(begin, end, key, [](const FacetUse& u, std::uint64_t k) { return u.key() < k; });
  return {first, std::find_if(first, end, [key](const FacetUse& use) { return use.key() != key; })};
}

bool check_arrays(const Mesh& mesh, Findings& findings) {
  constexpr std::size_t kMost = kOutside;
  if (mesh.tets.empty()) {
    findings.add("no_tets", Severity::error, [] { return std::string("the mesh has no tetrahedra"); });
  }
  if (mesh.points.size() >= kMost || mesh.tets.size() * 4 >= kMost) {
    findings.add("too_large", Severity::error, [&] { return fmt::format("{} tets", mesh.tets.size()); });
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    if (!finite(vec(mesh.points[i]))) {
      findings.add("not_finite", Severity::error, [&] { return fmt::format("node {}", i); });
    }
  }
  check_elements("tets", mesh.tets, mesh.tet_solid, mesh.points.size(), mesh.solids.size(), findings);
  check_elements("triangles", mesh.triangles, mesh.triangle_face, mesh.points.size(), mesh.faces.size(), findings);
  check_elements("segments", mesh.segments, mesh.segment_edge, mesh.points.size(), mesh.edges.size(), findings);
  for (std::size_t i = 0; i < mesh.corner_nodes.size(); ++i) {
    const std::uint32_t node = mesh.corner_nodes[i];
    if (node != kOutside && node >= mesh.points.size()) {
      findings.add("bad_index", Severity::error, [&] { return fmt::format("corner {}: no node {}", i, node); });
    }
  }
  return !findings.any("no_tets") && !findings.any("too_large") && !findings.any("not_finite") &&
         !findings.any("bad_arrays") && !findings.any("bad_index") && !findings.any("bad_label");
}

void check_nodes(const Mesh& mesh, const Topology& topology, Findings& findings) {
  std::vector<std::uint32_t> order;
  order.reserve(mesh.points.size());
  for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
    if (topology.used[i] != 0) {
      order.push_back(i);
    } else {
      findings.add("unused_node", Severity::warning, [&] { return fmt::format("node {}", i); });
    }
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return mesh.points[a] != mesh.points[b] ? mesh.points[a] < mesh.points[b] : a < b;
  });
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    if (mesh.points[order[i]] != mesh.points[order[i + 1]]) continue;
    findings.add("duplicate_node", Severity::error, [&] {
      return fmt::format("nodes {} and {} at {}", order[i], order[i + 1], place(vec(mesh.points[order[i]])));
    });
  }
}

Topology check_tets(const Mesh& mesh, Context& context, Findings& findings) {
  Topology topology;
  topology.used.assign(mesh.points.size(), 0);
  for (const auto& tet : mesh.tets) {
    for (const std::uint32_t v : tet) topology.used[v] = 1;
  }
  sign_tets(mesh, topology, context, findings);
  file_facets(mesh, topology, context);
  scan_facets(mesh, topology, findings);
  return topology;
}

}  // namespace curvetet::checks
