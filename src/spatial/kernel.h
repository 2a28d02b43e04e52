// The inner operations that building and single insertion share: conflict, walk, star. Internal to spatial.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/tet_complex.h"
#include "predicates/filters.h"
#include "predicates/predicates.h"

namespace curvetet::kernel {

/// Coordinates by the complex's vertex ids, and the ids by which ties are broken (none: the vertex ids themselves).
struct Sites {
  const Vec3* positions = nullptr;
  const VertexId* tie_ids = nullptr;
  const Vec3& position(VertexId v) const { return positions[v.value()]; }
  VertexId tie_id(VertexId v) const { return tie_ids ? tie_ids[v.value()] : v; }
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

/// States of tets while a cavity is found (TetComplex::flood_state).
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
inline int side(const TetComplex& complex, const Sites& sites, TetId t, int i, const Vec3& p) {
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

/// True if the perturbed sphere of the tet holds p. A ghost is in conflict if p lies strictly beyond its hull facet, or
/// in the facet's plane and inside the finite neighbour's sphere, which cuts the plane in the facet's circle.
bool in_conflict(const TetComplex& complex, const Sites& sites, TetId t, const Vec3& p, VertexId tie_id);

/// The tet that contains p: finite and closed, or a ghost whose hull facet has p strictly beyond. Randomised visibility
/// walk; after a bound on its steps (it may cycle where the tetrahedralization is not Delaunay) every tet is tried.
/// Invalid only if there is no tet, or the hull is not convex.
TetId walk(const TetComplex& complex, const Sites& sites, const Vec3& p, TetId start, Stream& stream);

/// A finite tet with its four ghosts; orient3d(a,b,c,d) must be positive. Returns the finite tet.
TetId add_first_tet(TetComplex& complex, VertexId a, VertexId b, VertexId c, VertexId d);

/// Replaces balls of tets by stars. The scratch arrays live as long as the object.
class StarBuilder {
 public:
  /// Replaces the tets, which form a ball, by the star of v over the ball's boundary. The flood states must be kInside
  /// or kBase for `tets` and for no other. Carries locks and regions. New tets have v as local vertex 3, in the order
  /// of `boundary`.
  void replace(TetComplex& complex, VertexId v, std::span<const TetId> tets, std::span<const TetFacet> boundary,
               std::vector<TetId>& star);
  /// Makes room for vertices with ids below n; to be called before.
  void cover_vertices(std::size_t n) {
    if (numbers_.size() < n + 2) numbers_.resize(n + 2, 0);
  }
  std::size_t bytes() const { return numbers_.capacity() * sizeof(std::uint32_t); }

 private:
  static constexpr std::uint32_t kMostVertices = 64;  ///< of a boundary that is glued by table

  void add_tets(TetComplex& complex, VertexId v, std::span<const TetFacet> boundary, std::vector<TetId>& star);
  void glue_by_table(TetComplex& complex, std::span<const TetId> star);
  void glue_by_turning(TetComplex& complex, std::span<const TetFacet> boundary, std::span<const TetId> star) const;
  std::uint32_t number_of(VertexId v) {
    std::uint32_t& number = numbers_[v.value() + 2U];  // the infinite vertex wraps to 0
    if (number >= named_ || names_[number] != v) {
      number = named_++;
      names_[number] = v;
    }
    return number;
  }

  /// numbers_[v + 2] is v's number if names_ agrees; nothing has to be cleared.
  std::vector<std::uint32_t> numbers_;
  std::array<VertexId, kMostVertices> names_{};
  std::uint32_t named_ = 0;
  /// The new tet that has the edge from one numbered vertex to another.
  std::array<std::array<TetId, kMostVertices>, kMostVertices> beyond_{};
};

}  // namespace curvetet::kernel
