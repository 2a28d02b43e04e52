// Delaunay tetrahedralization by definition: every four points whose perturbed sphere holds no other. O(n^5).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "mesh/vertex_store.h"
#include "predicates/predicates.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::oracle {

/// Sorted vertex ids of each tet.
using TetSet = std::set<std::array<std::uint32_t, 4>>;

inline TetSet naive_delaunay(const VertexStore& store) {
  TetSet tets;
  const auto p = [&](std::uint32_t v) { return store.position(VertexId(v)); };
  const auto n = static_cast<std::uint32_t>(store.size());
  for (std::uint32_t a = 0; a < n; ++a) {
    for (std::uint32_t b = a + 1; b < n; ++b) {
      for (std::uint32_t c = b + 1; c < n; ++c) {
        for (std::uint32_t d = c + 1; d < n; ++d) {
          const int side = orient3d(p(a), p(b), p(c), p(d));
          bool empty = side != 0;
          for (std::uint32_t e = 0; e < n && empty; ++e) {
            if (e == a || e == b || e == c || e == d) continue;
            empty = side * insphere_perturbed({p(a), p(b), p(c), p(d), p(e)},
                                              {VertexId(a), VertexId(b), VertexId(c), VertexId(d), VertexId(e)}) <
                    0;
          }
          if (empty) tets.insert({a, b, c, d});
        }
      }
    }
  }
  return tets;
}

/// The finite tets of a tetrahedralization in the same form.
inline TetSet finite_tets(const Tetrahedralization& mesh) {
  TetSet tets;
  const TetComplex& complex = mesh.complex();
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    std::array<std::uint32_t, 4> key{};
    for (int i = 0; i < 4; ++i) key[static_cast<std::size_t>(i)] = complex.vertex(t, i).value();
    std::sort(key.begin(), key.end());
    tets.insert(key);
  }
  return tets;
}

}  // namespace curvetet::oracle
