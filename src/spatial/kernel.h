// The inner operations that building and single insertion share: conflict, walk, star. Internal to spatial.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/tet_complex.h"
#include "mesh/vertex_store.h"
#include "predicates/filters.h"
#include "predicates/predicates.h"
#include "spatial/small_marks.h"

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

/// Sign of the tet's volume with p in place of its vertex k. `not_rounded` where insphere was not.
template <bool not_rounded, class AnySites>
int side_in_place(const AnySites& sites, const TetComplex::Vertices& v, std::size_t k, const Vec3& p) {
  std::array<const Vec3*, 4> at{&sites.position(v[0]), &sites.position(v[1]), &sites.position(v[2]),
                                &sites.position(v[3])};
  at[k] = &p;
  if (not_rounded) {
    const double det = filters::orient3d_value(*at[1] - *at[0], *at[2] - *at[0], *at[3] - *at[0]);
    return (det > 0) - (det < 0);
  }
  const int filtered = filters::orient3d(*at[0], *at[1], *at[2], *at[3]);
  return filtered != filters::kUnknown ? filtered : orient3d(*at[0], *at[1], *at[2], *at[3]);
}

/// True if the perturbed sphere of a finite tet, on which p is, holds it: insphere_perturbed for a tet that is known to
/// be positive. The point that is raised most decides: p is then outside, and of the others the one in whose place p
/// leaves the tet positive; the next one, where that tet is flat.
template <bool not_rounded, class AnySites>
bool in_conflict_by_id(const AnySites& sites, const TetComplex::Vertices& v, const Vec3& p, VertexId tie_id) {
  for (unsigned tried = 0;;) {
    VertexId highest = tie_id;
    std::size_t raised = 4;
    for (std::size_t k = 0; k < 4; ++k) {
      const bool higher = ((tried >> k & 1U) == 0) & (highest < sites.tie_id(v[k]));
      raised = higher ? k : raised;
      highest = higher ? sites.tie_id(v[k]) : highest;
    }
    if (raised == 4) return false;
    const int sign = side_in_place<not_rounded>(sites, v, raised, p);
    if (sign != 0) return sign > 0;
    tried |= 1U << raised;
  }
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
  return sign != 0 ? sign > 0 : in_conflict_by_id<false>(sites, v, p, tie_id);
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

/// Of the facets that p is strictly beyond, but for the one to `previous`: the one whose plane is farthest away, or -1.
/// Among needles this takes a third fewer steps than any of them, and it is no dearer.
template <class AnySites>
int farthest_passed(const TetComplex& complex, const AnySites& sites, TetId t, TetId previous, const Vec3& p) {
  int farthest = -1;
  double most = 0;
  for (int i = 0; i < 4; ++i) {
    if (complex.neighbour(t, i) == previous || side(complex, sites, t, i, p) >= 0) continue;
    const std::array<VertexId, 3> f = complex.facet_vertices({t, i});
    const Vec3& a = sites.position(f[0]);
    const Vec3 normal = cross(sites.position(f[1]) - a, sites.position(f[2]) - a);
    const double height = dot(normal, p - a);
    // At least the smallest number, also where the area was rounded to zero.
    const double squared = std::max(std::numeric_limits<double>::min(), height * height / norm2(normal));
    if (squared <= most) continue;
    most = squared;
    farthest = i;
  }
  return farthest;
}

/// Any of the facets that p is strictly beyond, but for the one to `previous`, or -1.
template <class AnySites>
int any_passed(const TetComplex& complex, const AnySites& sites, TetId t, TetId previous, const Vec3& p,
               Stream& stream) {
  const std::uint32_t turn_by = stream.next();
  for (std::uint32_t k = 0; k < 4; ++k) {
    const int i = static_cast<int>((turn_by + k) & 3U);
    if (complex.neighbour(t, i) != previous && side(complex, sites, t, i, p) < 0) return i;
  }
  return -1;
}

/// The tet that contains p: finite and closed, or a ghost whose hull facet has p strictly beyond. Visibility walk; it
/// may cycle where the tetrahedralization is not Delaunay, and so is random after some steps, and after a bound on them
/// every tet is tried. Invalid only if there is no tet, or the hull is not convex.
template <class AnySites>
TetId walk(const TetComplex& complex, const AnySites& sites, const Vec3& p, TetId start, Stream& stream) {
  if (!start.valid()) return scan(complex, sites, p);
  const int infinite = infinite_local(complex, start);
  TetId t = infinite >= 0 ? complex.neighbour(start, infinite) : start;
  TetId previous;
  constexpr std::size_t kStraight = 200;
  // So many steps cost about a fourth of the scan.
  const std::size_t most = 1000 + complex.slots() / 8;
  for (std::size_t steps = 0; steps < most; ++steps) {
    for (const TetId next : complex.neighbours(t)) complex.prefetch(next);
    const int i = steps < kStraight ? farthest_passed(complex, sites, t, previous, p)
                                    : any_passed(complex, sites, t, previous, p, stream);
    if (i < 0) return t;
    previous = t;
    t = complex.neighbour(t, i);
    if (complex.is_ghost(t)) return t;
  }
  return scan(complex, sites, p);
}

/// A finite tet with its four ghosts; orient3d(a,b,c,d) must be positive. Returns the finite tet.
TetId add_first_tet(TetComplex& complex, VertexId a, VertexId b, VertexId c, VertexId d);

/// Vertices of a wall, by number in the cavity's boundary.
using WallNumbers = std::array<std::uint32_t, 3>;

/// The directed edges of a cavity's boundary, each with the new tet behind the facet that walks it so: its neighbour is
/// behind the reversed edge. A square table, of numbers below kMostVertices.
class EdgeSquare {
 public:
  static constexpr std::uint32_t kMostVertices = 64;
  void enter(std::uint32_t from, std::uint32_t to, TetId t) { behind_[from][to] = t; }
  TetId behind(std::uint32_t from, std::uint32_t to) const { return behind_[from][to]; }

 private:
  std::array<std::array<TetId, kMostVertices>, kMostVertices> behind_{};
};

/// The same for any numbers.
class EdgeTable {
 public:
  void start() { table_.start(); }
  void enter(std::uint32_t from, std::uint32_t to, TetId t) { table_.insert(key(from, to), t); }
  TetId behind(std::uint32_t from, std::uint32_t to) const { return *table_.find(key(from, to)); }
  std::size_t bytes() const { return table_.bytes(); }

 private:
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t{from} << 32U | to; }
  SmallTable<std::uint64_t, TetId> table_;
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
  /// links of the outer tets to them. `numbers` are those of each wall's vertices, below `numbered`.
  void fill(TetComplex& complex, VertexId v, std::span<const Wall> walls, std::span<const TetId> slots,
            std::span<const WallNumbers> numbers, std::uint32_t numbered);
  std::size_t bytes() const { return vertex_numbers_.bytes() + table_.bytes(); }

 private:
  /// The new tet, but for its neighbours in the star.
  static void put_behind(const Wall& wall, TetId slot, VertexId v, TetComplex::Tet* all);
  template <class Edges>
  static void glue(std::span<const WallNumbers> numbers, std::span<const TetId> slots, TetComplex::Tet* all,
                   Edges& edges);

  // Of replace.
  std::vector<Wall> walls_;
  std::vector<WallNumbers> wall_numbers_;
  SmallNumbers vertex_numbers_;

  EdgeSquare square_;
  EdgeTable table_;
};

inline void StarBuilder::fill(TetComplex& complex, VertexId v, std::span<const Wall> walls,
                              std::span<const TetId> slots, std::span<const WallNumbers> numbers,
                              std::uint32_t numbered) {
  TetComplex::Tet* const all = complex.tets();
  for (std::size_t k = 0; k < walls.size(); ++k) put_behind(walls[k], slots[k], v, all);
  if (numbered <= EdgeSquare::kMostVertices) return glue(numbers, slots.first(walls.size()), all, square_);
  table_.start();
  glue(numbers, slots.first(walls.size()), all, table_);
}

template <class Edges>
void StarBuilder::glue(std::span<const WallNumbers> numbers, std::span<const TetId> slots, TetComplex::Tet* all,
                       Edges& edges) {
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const auto [a, b, c] = numbers[k];
    edges.enter(a, b, slots[k]);
    edges.enter(b, c, slots[k]);
    edges.enter(c, a, slots[k]);
  }
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const auto [a, b, c] = numbers[k];
    const std::array<TetId, 3> neighbours{edges.behind(c, b), edges.behind(a, c), edges.behind(b, a)};
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
