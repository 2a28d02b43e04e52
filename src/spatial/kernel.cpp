// A star is glued along the edges of the cavity's boundary. Small boundaries, nearly all, number their vertices and
// enter each new tet in a square table under its directed edges; the neighbour is under the reversed edge. Large ones
// need no table: around an edge of the boundary one turns through the old tets, which are still linked, until the
// boundary is met again, where the old tet's link has already been replaced by the new tet.
#include "spatial/kernel.h"

#include "base/error.h"

namespace curvetet::kernel {

namespace {

/// The tet tried by brute force: contains p, or is a ghost with p strictly beyond.
bool holds(const TetComplex& complex, const Sites& sites, TetId t, const Vec3& p) {
  const int infinite = infinite_local(complex, t);
  if (infinite >= 0) return side(complex, sites, t, infinite, p) > 0;
  for (int i = 0; i < 4; ++i) {
    if (side(complex, sites, t, i, p) < 0) return false;
  }
  return true;
}

TetId scan(const TetComplex& complex, const Sites& sites, const Vec3& p) {
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (complex.is_alive(t) && holds(complex, sites, t, p)) return t;
  }
  return TetId();
}

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

bool in_conflict(const TetComplex& complex, const Sites& sites, TetId t, const Vec3& p, VertexId tie_id) {
  const int infinite = infinite_local(complex, t);
  if (infinite >= 0) {
    const int beyond = side(complex, sites, t, infinite, p);
    return beyond != 0 ? beyond > 0 : in_conflict(complex, sites, complex.neighbour(t, infinite), p, tie_id);
  }
  const TetComplex::Vertices& v = complex.vertices(t);
  const Vec3& a = sites.position(v[0]);
  const Vec3& b = sites.position(v[1]);
  const Vec3& c = sites.position(v[2]);
  const Vec3& d = sites.position(v[3]);
  const filters::Insphere value(a, b, c, d, p);
  int sign = value.filtered();
  if (sign == filters::kUnknown) sign = value.unfiltered();
  if (sign != 0) return sign > 0;
  return insphere_tie({a, b, c, d, p},
                      {sites.tie_id(v[0]), sites.tie_id(v[1]), sites.tie_id(v[2]), sites.tie_id(v[3]), tie_id}) > 0;
}

TetId walk(const TetComplex& complex, const Sites& sites, const Vec3& p, TetId start, Stream& stream) {
  if (!start.valid()) return scan(complex, sites, p);
  const int infinite = infinite_local(complex, start);
  TetId t = infinite >= 0 ? complex.neighbour(start, infinite) : start;
  TetId previous;
  // So many steps cost about a fourth of the scan.
  for (std::size_t steps = 1000 + complex.slots() / 8; steps > 0; --steps) {
    const std::uint32_t turn_by = stream.next();
    bool moved = false;
    for (std::uint32_t k = 0; k < 4 && !moved; ++k) {
      const int i = static_cast<int>((turn_by + k) & 3U);
      const TetId next = complex.neighbour(t, i);
      if (next == previous || side(complex, sites, t, i, p) >= 0) continue;
      previous = t;
      t = next;
      moved = true;
    }
    if (!moved || complex.is_ghost(t)) return t;
  }
  return scan(complex, sites, p);
}

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
  // A sphere of F triangles has F / 2 + 2 vertices.
  if (boundary.size() / 2 + 2 <= kMostVertices) {
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
  std::array<std::array<std::uint32_t, 3>, 2 * kMostVertices> numbers;
  named_ = 0;
  for (std::size_t k = 0; k < star.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i) numbers[k][i] = number_of(complex.vertex(star[k], static_cast<int>(i)));
    const auto [a, b, c] = numbers[k];
    beyond_[a][b] = beyond_[b][c] = beyond_[c][a] = star[k];
  }
  for (std::size_t k = 0; k < star.size(); ++k) {
    const auto [a, b, c] = numbers[k];
    complex.set_neighbour(star[k], 2, beyond_[b][a]);
    complex.set_neighbour(star[k], 0, beyond_[c][b]);
    complex.set_neighbour(star[k], 1, beyond_[a][c]);
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
