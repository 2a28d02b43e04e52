// The inner operations that building and single insertion share: conflict, walk, star. Internal to spatial.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tet_complex.h"
#include "mesh/vertex_store.h"
#include "predicates/filters.h"
#include "predicates/predicates.h"

namespace curvetet::kernel {

/// Coordinates by the complex's vertex ids, and the ids by which ties are broken. Building has sites of its own, so
/// that what follows is for any.
struct Sites {
  const VertexStore::Site* sites = nullptr;
  const Vec3& position(VertexId v) const { return sites[v.value()].position; }
  VertexId tie_id(VertexId v) const { return v; }
};

/// A stream of random bits, reproducible from its seed.
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL | 1U) {}
  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::uint32_t>(state_ >> 32);
  }

 private:
  std::uint64_t state_;
};

/// States of tets while a cavity is found.
inline constexpr std::uint32_t kOutside = 1;  ///< seen, not in the cavity
inline constexpr std::uint32_t kInside = 2;   ///< this and larger: in the cavity
inline constexpr std::uint32_t kBase = 3;     ///< in the cavity, and must stay there

/// A set of vertices that is emptied at once.
class VertexSet {
 public:
  /// Empties the set and makes room for ids below n.
  void start(std::size_t n) {
    if (stamps_.size() < n) stamps_.resize(n, 0);
    if (++stamp_ == 0) {
      std::fill(stamps_.begin(), stamps_.end(), 0U);
      stamp_ = 1;
    }
  }
  void insert(VertexId v) { stamps_[v.value()] = stamp_; }
  bool contains(VertexId v) const { return stamps_[v.value()] == stamp_; }
  std::size_t bytes() const { return stamps_.capacity() * sizeof(std::uint32_t); }

 private:
  std::vector<std::uint32_t> stamps_;
  std::uint32_t stamp_ = 0;
};

/// Sign of orient3d of the tet with local vertex i replaced by p; for a ghost, i must be its infinite vertex.
template <class AnySites>
int side(const TetComplex& complex, const AnySites& sites, TetId t, int i, const Vec3& p) {
  const TetComplex::Vertices& v = complex.vertices(t);
  const std::array<int, 3>& f = kFacet[static_cast<std::size_t>(i)];
  const Vec3& a = sites.position(v[static_cast<std::size_t>(f[0])]);
  const Vec3& b = sites.position(v[static_cast<std::size_t>(f[1])]);
  const Vec3& c = sites.position(v[static_cast<std::size_t>(f[2])]);
  const int filtered = filters::orient3d(a, b, c, p);
  return filtered != filters::kUnknown ? filtered : orient3d(a, b, c, p);
}

/// Local index of the infinite vertex, or -1.
inline int infinite_local(const TetComplex& complex, TetId t) { return complex.local(t, kInfinite); }

/// True if the perturbed sphere of a finite tet, on which p is, holds it.
template <class AnySites>
bool in_conflict_by_id(const AnySites& sites, const TetComplex::Vertices& v, const Vec3& p, VertexId tie_id) {
  return insphere_tie({sites.position(v[0]), sites.position(v[1]), sites.position(v[2]), sites.position(v[3]), p},
                      {sites.tie_id(v[0]), sites.tie_id(v[1]), sites.tie_id(v[2]), sites.tie_id(v[3]), tie_id}) > 0;
}

/// True if the perturbed sphere of the tet holds p. A ghost is in conflict if p lies strictly beyond its hull facet, or
/// in the facet's plane and inside the finite neighbour's sphere, which cuts the plane in the facet's circle.
template <class AnySites>
bool in_conflict(const TetComplex& complex, const AnySites& sites, TetId t, const Vec3& p, VertexId tie_id) {
  if (complex.is_ghost(t)) {
    const int infinite = infinite_local(complex, t);
    const int beyond = side(complex, sites, t, infinite, p);
    return beyond != 0 ? beyond > 0 : in_conflict(complex, sites, complex.neighbour(t, infinite), p, tie_id);
  }
  const TetComplex::Vertices& v = complex.vertices(t);
  const filters::Insphere value(sites.position(v[0]), sites.position(v[1]), sites.position(v[2]), sites.position(v[3]),
                                p);
  int sign = value.filtered();
  if (sign == filters::kUnknown) sign = value.unfiltered();
  return sign != 0 ? sign > 0 : in_conflict_by_id(sites, v, p, tie_id);
}

/// The tet that contains p, tried by brute force: finite and closed, or a ghost with p strictly beyond.
template <class AnySites>
TetId scan(const TetComplex& complex, const AnySites& sites, const Vec3& p) {
  const auto holds = [&](TetId t) {
    const int infinite = infinite_local(complex, t);
    if (infinite >= 0) return side(complex, sites, t, infinite, p) > 0;
    for (int i = 0; i < 4; ++i) {
      if (side(complex, sites, t, i, p) < 0) return false;
    }
    return true;
  };
  for (std::size_t slot = 0; slot < complex.slots(); ++slot) {
    const TetId t(slot);
    if (complex.is_alive(t) && holds(t)) return t;
  }
  return TetId();
}

/// The tet that contains p: finite and closed, or a ghost whose hull facet has p strictly beyond. Randomised visibility
/// walk; after a bound on its steps (it may cycle where the tetrahedralization is not Delaunay) every tet is tried.
/// Invalid only if there is no tet, or the hull is not convex.
template <class AnySites>
TetId walk(const TetComplex& complex, const AnySites& sites, const Vec3& p, TetId start, Stream& stream) {
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

/// A finite tet with its four ghosts; orient3d(a,b,c,d) must be positive. Returns the finite tet.
TetId add_first_tet(TetComplex& complex, VertexId a, VertexId b, VertexId c, VertexId d);

/// The directed edges of a cavity's boundary, each with the new tet behind the facet that walks it so: its neighbour is
/// behind the reversed edge. Vertices are numbered as they come, for a square table.
class EdgeTable {
 public:
  static constexpr std::uint32_t kMostVertices = 64;
  using Numbers = std::array<std::uint32_t, 3>;

  /// A sphere of F triangles has F / 2 + 2 vertices.
  static bool fits(std::size_t facets) { return facets / 2 + 2 <= kMostVertices; }
  void clear() { named_ = 0; }
  /// `known` belongs to v; what it holds is v's number if the table agrees, so nothing has to be cleared there.
  std::uint32_t number_of(VertexId v, std::uint32_t& known) {
    if (known >= named_ || names_[known] != v) {
      known = named_++;
      names_[known] = v;
    }
    return known;
  }
  void enter(const Numbers& facet, TetId t) {
    const auto [a, b, c] = facet;
    beyond_[a][b] = beyond_[b][c] = beyond_[c][a] = t;
  }
  /// Of the tet whose local vertices 0, 1, 2 are the facet: the neighbours opposite these, in order.
  std::array<TetId, 3> neighbours(const Numbers& facet) const {
    const auto [a, b, c] = facet;
    return {beyond_[c][b], beyond_[a][c], beyond_[b][a]};
  }

 private:
  std::array<VertexId, kMostVertices> names_{};  ///< the vertex of each number
  std::uint32_t named_ = 0;
  std::array<std::array<TetId, kMostVertices>, kMostVertices> beyond_{};
};

/// A facet of a cavity's boundary, seen from outside, with its vertices as the tet inside lists them.
struct Wall {
  TetId outer;
  int local = 0;
  std::array<VertexId, 3> vertices;
  std::uint32_t flags = 0;  ///< of the new tet behind it: region, and the lock of its facet 3
};

/// The walls of a cavity with this boundary, each facet of which is seen from the tet that goes.
void collect_walls(const TetComplex& complex, std::span<const TetFacet> boundary, std::vector<Wall>& walls);

/// Replaces balls of tets by stars. The scratch arrays live as long as the object.
class StarBuilder {
 public:
  /// Replaces the tets, which form a ball, by the star of v over the ball's boundary. Carries locks and regions. New
  /// tets have v as local vertex 3, in the order of `boundary`.
  void replace(TetComplex& complex, VertexId v, std::span<const TetId> tets, std::span<const TetFacet> boundary,
               std::vector<TetId>& star);
  /// Makes the star of v: behind wall k the tet in slot k, whatever is there. Touches nothing but these slots and the
  /// links of the outer tets to them. number_of(w) is a number that belongs to vertex w (see EdgeTable::number_of).
  template <class NumberOf>
  void fill(TetComplex& complex, VertexId v, std::span<const Wall> walls, std::span<const TetId> slots,
            const NumberOf& number_of);
  /// The same with numbers of its own.
  void fill(TetComplex& complex, VertexId v, std::span<const Wall> walls, std::span<const TetId> slots) {
    fill(complex, v, walls, slots, [&](VertexId w) -> std::uint32_t& { return numbers_[w.value() + 2U]; });
  }
  /// Makes room for vertices with ids below n; to be called before, but where the caller has the numbers.
  void cover_vertices(std::size_t n) {
    if (numbers_.size() < n + 2) numbers_.resize(n + 2, 0);
  }
  std::size_t bytes() const { return numbers_.capacity() * sizeof(std::uint32_t); }

 private:
  /// The new tet, but for its neighbours in the star.
  static void put_behind(const Wall& wall, TetId slot, VertexId v, TetComplex::Tet* all);
  void glue_by_sorting(TetComplex& complex, std::span<const Wall> walls, std::span<const TetId> slots);

  /// An edge of a wall: its vertices, the smaller first, and the facet of the new tet there.
  struct Edge {
    std::array<VertexId, 2> ends;
    TetFacet facet;
  };

  std::vector<std::uint32_t> numbers_;  ///< of v at v + 2 (the infinite vertex wraps to 0), for the table
  std::vector<Wall> walls_;
  std::vector<Edge> edges_;
  EdgeTable table_;
  std::array<EdgeTable::Numbers, 2 * EdgeTable::kMostVertices> wall_numbers_{};  ///< of each wall's vertices
};

template <class NumberOf>
void StarBuilder::fill(TetComplex& complex, VertexId v, std::span<const Wall> walls, std::span<const TetId> slots,
                       const NumberOf& number_of) {
  TetComplex::Tet* const all = complex.tets();
  if (!EdgeTable::fits(walls.size())) {
    for (std::size_t k = 0; k < walls.size(); ++k) put_behind(walls[k], slots[k], v, all);
    glue_by_sorting(complex, walls, slots);
    return;
  }
  table_.clear();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    put_behind(walls[k], slots[k], v, all);
    for (std::size_t j = 0; j < 3; ++j)
      wall_numbers_[k][j] = table_.number_of(walls[k].vertices[j], number_of(walls[k].vertices[j]));
    table_.enter(wall_numbers_[k], slots[k]);
  }
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const std::array<TetId, 3> neighbours = table_.neighbours(wall_numbers_[k]);
    for (std::size_t j = 0; j < 3; ++j) all[slots[k].value()].neighbours[j] = neighbours[j];
  }
}

inline void StarBuilder::put_behind(const Wall& wall, TetId slot, VertexId v, TetComplex::Tet* all) {
  TetComplex::Tet& tet = all[slot.value()];
  tet.vertices = {wall.vertices[0], wall.vertices[1], wall.vertices[2], v};
  tet.neighbours[3] = wall.outer;
  tet.flags = wall.flags;
  tet.stamp = 0;
  all[wall.outer.value()].neighbours[static_cast<std::size_t>(wall.local)] = slot;
}

}  // namespace curvetet::kernel
