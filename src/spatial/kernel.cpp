// A star is glued along the edges of the cavity's boundary. Small boundaries, nearly all, number their vertices and
// enter each new tet in a square table under its directed edges; the neighbour is under the reversed edge. Large ones
// need no table: around an edge of the boundary one turns through the old tets, which are still linked, until the
// boundary is met again, where the old tet's link has already been replaced by the new tet.
#include "spatial/kernel.h"

#include "base/error.h"

namespace curvetet::kernel {

namespace {

/// Turns around the edge (a,b) from old tet t, leaving it through the facet opposite `away`, to the new tet beyond.
TetId turn(const TetComplex& complex, TetId t, VertexId a, VertexId b, VertexId away) {
  for (;;) {
    const int exit = complex.local(t, away);
    const VertexId kept = complex.vertex(t, 6 - complex.local(t, a) - complex.local(t, b) - exit);
    t = complex.neighbour(t, exit);
    if (complex.flood_state(t) < kInside) return t;
    away = kept;
  }
}

}  // namespace

TetId add_first_tet(TetComplex& complex, VertexId a, VertexId b, VertexId c, VertexId d) {
  const TetId t = complex.add({a, b, c, d});
  std::array<TetId, 4> ghost;
  for (int i = 0; i < 4; ++i) {
    const std::array<VertexId, 3> f = complex.facet_vertices({t, i});
    ghost[static_cast<std::size_t>(i)] = complex.add({f[1], f[0], f[2], kInfinite});
    complex.glue({t, i}, {ghost[static_cast<std::size_t>(i)], 3});
  }
  // Ghosts i and j share the edge without vertices i and j: in ghost i it is opposite vertex j.
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const TetId gi = ghost[static_cast<std::size_t>(i)];
      const TetId gj = ghost[static_cast<std::size_t>(j)];
      complex.glue({gi, complex.local(gi, complex.vertex(t, j))}, {gj, complex.local(gj, complex.vertex(t, i))});
    }
  }
  return t;
}

void StarBuilder::replace(TetComplex& complex, VertexId v, std::span<const TetId> tets,
                          std::span<const TetFacet> boundary, std::vector<TetId>& star) {
  add_tets(complex, v, boundary, star);
  if (EdgeTable::fits(boundary.size())) {
    glue_by_table(complex, star);
  } else {
    glue_by_turning(complex, boundary, star);
  }
  for (const TetId t : tets) complex.remove(t);
}

void StarBuilder::add_tets(TetComplex& complex, VertexId v, std::span<const TetFacet> boundary,
                           std::vector<TetId>& star) {
  star.clear();
  for (const TetFacet& f : boundary) {
    const TetFacet outer = complex.mirror(f);
    const std::array<VertexId, 3> w = complex.facet_vertices(f);
    const TetId t = complex.add({w[0], w[1], w[2], v});
    complex.glue({t, 3}, outer);
    if (complex.is_locked(f)) complex.set_lock_bit({t, 3}, true);
    complex.set_region(t, complex.region(f.tet));
    complex.set_neighbour(f.tet, f.local, t);
    star.push_back(t);
  }
}

void StarBuilder::glue_by_table(TetComplex& complex, std::span<const TetId> star) {
  std::array<EdgeTable::Numbers, 2 * EdgeTable::kMostVertices> numbers;
  table_.clear();
  for (std::size_t k = 0; k < star.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId v = complex.vertex(star[k], static_cast<int>(i));
      numbers[k][i] = table_.number_of(v, numbers_[v.value() + 2U]);
    }
    table_.enter(numbers[k], star[k]);
  }
  for (std::size_t k = 0; k < star.size(); ++k) {
    const std::array<TetId, 3> neighbours = table_.neighbours(numbers[k]);
    for (int i = 0; i < 3; ++i) complex.set_neighbour(star[k], i, neighbours[static_cast<std::size_t>(i)]);
  }
}

void StarBuilder::glue_by_turning(TetComplex& complex, std::span<const TetFacet> boundary,
                                  std::span<const TetId> star) const {
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    const TetId t = star[k];
    for (int i = 0; i < 3; ++i) {
      if (complex.neighbour(t, i).valid()) continue;
      const VertexId a = complex.vertex(t, (i + 1) % 3);
      const VertexId b = complex.vertex(t, (i + 2) % 3);
      const TetId other = turn(complex, boundary[k].tet, a, b, complex.vertex(t, i));
      complex.glue({t, i}, {other, 3 - complex.local(other, a) - complex.local(other, b)});
    }
  }
}

}  // namespace curvetet::kernel
