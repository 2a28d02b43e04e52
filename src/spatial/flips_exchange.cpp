// An exchange is done without knowing which flip it is: the facets of the polyhedron's boundary are noted with what
// lies outside of them, the old tets go, the new ones come, and every facet of a new tet is glued to the open facet
// with the same three vertices. A flip is thus a list of vertices, and locks and regions are carried in one place.
// Hand-written gluing for each flip would save some comparisons of small integers but has to repeat the bookkeeping of
// locks.
#include "spatial/flips_exchange.h"

#include <algorithm>
#include <cmath>

namespace curvetet::flips {

namespace {

using Key = std::array<std::uint32_t, 3>;

Key key_of(VertexId a, VertexId b, VertexId c) {
  Key k{a.value(), b.value(), c.value()};
  if (k[0] > k[1]) std::swap(k[0], k[1]);
  if (k[1] > k[2]) std::swap(k[1], k[2]);
  if (k[0] > k[1]) std::swap(k[0], k[1]);
  return k;
}

Key key_of(const TetComplex::Vertices& v, int i) {
  const auto& f = kFacet[static_cast<std::size_t>(i)];
  return key_of(v[static_cast<std::size_t>(f[0])], v[static_cast<std::size_t>(f[1])],
                v[static_cast<std::size_t>(f[2])]);
}

/// A facet that waits for the tet on its inner side.
struct Open {
  Key key;
  TetFacet outside;
  bool locked = false;
};

bool has(std::span<const TetId> tets, TetId t) { return std::find(tets.begin(), tets.end(), t) != tets.end(); }

using FewOpen = Inline<Open, 4 * kMaxTets>;
struct ManyOpen : std::vector<Open> {
  void take(std::size_t i) {
    (*this)[i] = back();
    pop_back();
  }
};

template <class OpenFacets>
void collect_boundary(const TetComplex& complex, std::span<const TetId> old_tets, OpenFacets& open) {
  for (TetId t : old_tets) {
    for (int i = 0; i < 4; ++i) {
      if (has(old_tets, complex.neighbour(t, i))) continue;
      const TetFacet f{t, i};
      open.push_back({key_of(complex.vertices(t), i), complex.mirror(f), complex.is_locked(f)});
    }
  }
}

/// Of locked facets between two of the tets.
std::vector<Key> inner_locks(const TetComplex& complex, std::span<const TetId> tets) {
  std::vector<Key> keys;
  for (TetId t : tets)
    for (int i = 0; i < 4; ++i)
      if (complex.is_locked({t, i}) && has(tets, complex.neighbour(t, i)))
        keys.push_back(key_of(complex.vertices(t), i));
  return keys;
}

template <class OpenFacets>
void glue_or_open(TetComplex& complex, TetFacet f, OpenFacets& open, std::span<const Key> inner_locks) {
  const Key key = key_of(complex.vertices(f.tet), f.local);
  for (std::size_t k = 0; k < open.size(); ++k) {
    if (open[k].key != key) continue;
    complex.glue(f, open[k].outside);
    if (open[k].locked) complex.set_lock_bit(f, true);
    open.take(k);
    return;
  }
  const bool locked = std::find(inner_locks.begin(), inner_locks.end(), key) != inner_locks.end();
  if (locked) complex.set_lock_bit(f, true);
  open.push_back({key, f, locked});
}

template <class OpenFacets>
void exchange_tets(Tetrahedralization& mesh, std::span<const TetId> old_tets,
                   std::span<const TetComplex::Vertices> new_tets, std::span<const Key> inner_locks) {
  TetComplex& complex = mesh.complex();
  OpenFacets open;
  collect_boundary(complex, old_tets, open);
  const std::uint32_t region = complex.region(old_tets[0]);
  for (TetId t : old_tets) complex.remove(t);
  for (const TetComplex::Vertices& v : new_tets) {
    const TetId t = complex.add(v);
    complex.set_region(t, region);
    for (int i = 0; i < 4; ++i) glue_or_open(complex, {t, i}, open, inner_locks);
    mesh.touch(t);
  }
  CURVETET_CHECK(open.empty());
}

std::optional<TetId> find_tet(const Tetrahedralization& mesh, const TetComplex::Vertices& v) {
  const auto facet = mesh.find_facet(v[0], v[1], v[2]);
  if (!facet) return std::nullopt;
  if (mesh.complex().local(facet->tet, v[3]) >= 0) return facet->tet;
  const TetId other = mesh.complex().neighbour(facet->tet, facet->local);
  if (mesh.complex().local(other, v[3]) >= 0) return other;
  return std::nullopt;
}

}  // namespace

bool is_free(const TetComplex& complex, const Exchange& exchange) {
  const std::uint32_t region = complex.region(exchange.old_tets[0]);
  for (TetId t : exchange.old_tets) {
    if (complex.is_ghost(t) || complex.region(t) != region) return false;
    for (int i = 0; i < 4; ++i) {
      if (complex.is_locked({t, i}) && has(exchange.old_tets, complex.neighbour(t, i))) return false;
    }
  }
  return true;
}

double volume_over_length(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double longest = std::max({norm2(u), norm2(v), norm2(w), norm2(c - b), norm2(d - b), norm2(d - c)});
  return dot(cross(u, v), w) / (longest * std::sqrt(longest));
}

void commit(Tetrahedralization& mesh, const Exchange& exchange) {
  exchange_tets<FewOpen>(mesh, exchange.old_tets, exchange.new_tets, {});
}

void commit_many(Tetrahedralization& mesh, std::span<const TetId> old_tets,
                 std::span<const TetComplex::Vertices> new_tets) {
  exchange_tets<ManyOpen>(mesh, old_tets, new_tets, inner_locks(mesh.complex(), old_tets));
}

std::optional<Ring> ring_of(const TetComplex& complex, TetEdge edge, std::size_t limit) {
  Ring ring;
  ring.p = complex.vertex(edge.tet, edge.i);
  ring.q = complex.vertex(edge.tet, edge.j);
  std::size_t e = 0;
  while (kEdge[e][0] != std::min(edge.i, edge.j) || kEdge[e][1] != std::max(edge.i, edge.j)) ++e;
  int x = kEdge[5 - e][0], y = kEdge[5 - e][1];
  // (i, j, x, y) must be an even permutation for the tet (p, q, ring[0], ring[1]) to be positive.
  const auto& facet = kFacet[static_cast<std::size_t>(y)];
  const auto at = std::find(facet.begin(), facet.end(), edge.i) - facet.begin();
  if (facet[static_cast<std::size_t>((at + 1) % 3)] != edge.j) std::swap(x, y);
  TetId t = edge.tet;
  VertexId from = complex.vertex(t, x), to = complex.vertex(t, y);
  do {
    if (ring.tets.size() == std::min(limit, kMaxRing) || complex.is_ghost(t)) return std::nullopt;
    ring.tets.push_back(t);
    ring.vertices.push_back(from);
    const TetId next = complex.neighbour(t, complex.local(t, from));
    const TetFacet entered = complex.mirror({t, complex.local(t, from)});
    from = to;
    to = complex.vertex(next, entered.local);
    t = next;
  } while (t != edge.tet);
  return ring;
}

void Log::commit(Tetrahedralization& mesh, const Exchange& exchange) {
  Record record;
  for (TetId t : exchange.old_tets) record.old_tets.push_back(mesh.complex().vertices(t));
  record.new_tets.assign(exchange.new_tets.begin(), exchange.new_tets.end());
  flips::commit(mesh, exchange);
  records_.push_back(std::move(record));
}

void Log::undo_to(Tetrahedralization& mesh, std::size_t size) {
  while (records_.size() > size) {
    Exchange back;
    for (const TetComplex::Vertices& v : records_.back().new_tets) {
      const auto t = find_tet(mesh, v);
      CURVETET_CHECK(t.has_value());
      back.old_tets.push_back(*t);
    }
    for (const TetComplex::Vertices& v : records_.back().old_tets) back.new_tets.push_back(v);
    flips::commit(mesh, back);
    records_.pop_back();
  }
}

}  // namespace curvetet::flips
