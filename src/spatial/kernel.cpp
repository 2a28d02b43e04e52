// The star is glued without a table of edges: around an edge of the cavity's boundary one turns through the old tets,
// which are still linked, until the boundary is met again. There the old tet's link has already been replaced by the
// new tet.
#include "spatial/kernel.h"

#include <cmath>

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
TetId turn(const TetComplex& complex, const Marks& marks, TetId t, VertexId a, VertexId b, VertexId away) {
  for (;;) {
    VertexId kept;  // the third vertex of the facet by which t is left
    for (const VertexId v : complex.vertices(t)) {
      if (v != a && v != b && v != away) kept = v;
    }
    t = complex.neighbour(t, complex.local(t, away));
    if (marks.get(t.value()) < Marks::kInside) return t;
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
  const int filtered = filters::insphere(a, b, c, d, p);
  if (filtered == 1 || filtered == -1) return filtered > 0;
  const int exact = insphere(a, b, c, d, p);
  if (exact != 0) return exact > 0;
  return insphere_tie({a, b, c, d, p},
                      {sites.tie_id(v[0]), sites.tie_id(v[1]), sites.tie_id(v[2]), sites.tie_id(v[3]), tie_id}) > 0;
}

TetId walk(const TetComplex& complex, const Sites& sites, const Vec3& p, TetId start, Stream& stream) {
  if (!start.valid()) return scan(complex, sites, p);
  const int infinite = infinite_local(complex, start);
  TetId t = infinite >= 0 ? complex.neighbour(start, infinite) : start;
  TetId previous;
  auto steps = static_cast<std::int64_t>(500 + 20 * std::cbrt(static_cast<double>(complex.slots())));
  while (steps-- > 0) {
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

void replace_by_star(TetComplex& complex, Marks& marks, VertexId v, std::span<const TetId> tets,
                     std::span<const TetFacet> boundary, std::vector<TetId>& star) {
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
  marks.cover(complex.slots());
  for (std::size_t k = 0; k < boundary.size(); ++k) {
    const TetFacet f = boundary[k];
    const TetId t = star[k];
    for (int i = 0; i < 3; ++i) {
      if (complex.neighbour(t, i).valid()) continue;
      const VertexId a = complex.vertex(t, (i + 1) % 3);
      const VertexId b = complex.vertex(t, (i + 2) % 3);
      const VertexId c = complex.vertex(t, i);
      const TetId other = turn(complex, marks, f.tet, a, b, c);
      int j = 0;
      while (complex.vertex(other, j) == a || complex.vertex(other, j) == b) ++j;
      complex.glue({t, i}, {other, j});
    }
  }
  for (const TetId t : tets) complex.remove(t);
}

}  // namespace curvetet::kernel
