// Fans around one vertex by definition: every two facets are compared, and the loops of a face are walked.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "boundary/vertex_fans.h"
#include "conjoint/surface_meshes.h"

namespace curvetet::oracle {

/// Parts with some ends each: two parts hang together at an end that just these two have, or one closes with itself.
inline Fans count_fans(const std::vector<std::array<VertexId, 2>>& ends) {
  std::vector<std::size_t> part(ends.size());
  for (std::size_t i = 0; i < part.size(); ++i) part[i] = i;
  std::vector<char> has_end(ends.size(), 0);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (const VertexId w : ends[i]) {
      std::vector<std::size_t> with;
      for (std::size_t j = 0; j < ends.size(); ++j)
        for (const VertexId u : ends[j])
          if (u == w) with.push_back(j);
      if (with.size() != 2) {
        has_end[i] = 1;
        continue;
      }
      const std::size_t from = part[with[0]], to = part[with[1]];
      std::replace(part.begin(), part.end(), from, to);
    }
  }
  Fans fans;
  for (std::size_t p = 0; p < part.size(); ++p) {
    bool any = false, open = false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      any = any || part[i] == p;
      open = open || (part[i] == p && has_end[i]);
    }
    if (any) ++(open ? fans.open : fans.closed);
  }
  return fans;
}

inline Fans naive_found_fans(const std::vector<FacetKey>& facets, VertexId v) {
  std::vector<std::array<VertexId, 2>> links;
  for (const FacetKey& f : facets)
    for (std::size_t k = 0; k < 3; ++k)
      if (f[k] == v.value()) links.push_back({VertexId(f[(k + 1) % 3]), VertexId(f[(k + 2) % 3])});
  return count_fans(links);
}

/// From the CAD's loops alone, for faces whose loops do not touch: each time that a loop passes through the vertex is a
/// corner of the face.
inline Fans naive_expected_fans(const Model& model, const BoundaryMesh& boundary, FaceId face, VertexId v) {
  std::vector<std::array<VertexId, 2>> passes;
  for (const Loop& loop : model.faces[face].loops) {
    std::vector<VertexId> ring;
    for (const EdgeUse& use : loop.uses) {
      std::vector<VertexId> chain = boundary.curves[use.edge].vertices;  // none at a pole
      if (use.reversed) std::reverse(chain.begin(), chain.end());
      if (!chain.empty()) ring.insert(ring.end(), chain.begin(), chain.end() - 1);
    }
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (ring[i] == v) passes.push_back({ring[(i + ring.size() - 1) % ring.size()], ring[(i + 1) % ring.size()]});
  }
  return passes.empty() ? Fans{1, 0} : count_fans(passes);
}

}  // namespace curvetet::oracle
