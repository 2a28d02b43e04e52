// Topology of a tetrahedralization: four vertices and four neighbours per tet, ghost tets, locks. No coordinates here.
//
// Convention, in one sentence: neighbour i is opposite vertex i. A tet with vertices (a,b,c,d) is positive when
// orient3d(a,b,c,d) > 0 as predicates/predicates.h defines it; facet i lists the other three vertices so that orient3d
// of (facet[0], facet[1], facet[2], vertex i) is positive too.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/context.h"
#include "base/growing_array.h"
#include "base/ids.h"

namespace curvetet {

/// The vertex at infinity; a tet that has it is a ghost, its finite facet is on the convex hull.
inline constexpr VertexId kInfinite{std::uint32_t{0xFFFFFFFE}};

/// kFacet[i]: the local vertices of the facet opposite local vertex i, such that (kFacet[i][0..2], i) is an even
/// permutation of (0,1,2,3): replacing vertex i keeps the sign of orient3d(facet[0], facet[1], facet[2], x) of the tet.
inline constexpr std::array<std::array<int, 3>, 4> kFacet{{{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

/// kEdge[e]: the local vertices of edge e; edge 5 - e is opposite edge e.
inline constexpr std::array<std::array<int, 2>, 6> kEdge{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

/// A facet seen from one of its two tets: the one opposite local vertex `local` of `tet`.
struct TetFacet {
  TetId tet;
  int local = 0;
  friend bool operator==(const TetFacet&, const TetFacet&) = default;
};

/// Flat arrays with recycled slots. Locks are kept on both sides of a facet.
class TetComplex {
 public:
  using Vertices = std::array<VertexId, 4>;

  /// All of a tet side by side, in at most two cache lines: whoever reads one part reads the others next.
  struct Tet {
    Vertices vertices;
    std::array<TetId, 4> neighbours;
    std::uint32_t flags = 0;
    std::uint32_t stamp = 0;  ///< flood and state
  };
  /// For loops that read or write all of a tet; until the next tet is added.
  Tet* tets() { return tets_.data(); }
  const Tet* tets() const { return tets_.data(); }
  /// What a tet's stamp is in state 0 of the present flood; states 1, 2 and 3 are added.
  std::uint32_t flood() const { return flood_; }

  std::size_t slots() const { return tets_.size(); }  ///< alive and free slots
  std::size_t alive() const { return tets_.size() - free_.size(); }
  bool is_alive(TetId t) const { return tets_[t.value()].vertices[0].valid(); }
  bool is_ghost(TetId t) const {
    const Vertices& v = tets_[t.value()].vertices;
    return (v[0] == kInfinite) | (v[1] == kInfinite) | (v[2] == kInfinite) | (v[3] == kInfinite);
  }
  const Vertices& vertices(TetId t) const { return tets_[t.value()].vertices; }
  const std::array<TetId, 4>& neighbours(TetId t) const { return tets_[t.value()].neighbours; }
  VertexId vertex(TetId t, int i) const { return tets_[t.value()].vertices[static_cast<std::size_t>(i)]; }
  TetId neighbour(TetId t, int i) const { return tets_[t.value()].neighbours[static_cast<std::size_t>(i)]; }
  /// Local index of v in t, or -1.
  int local(TetId t, VertexId v) const {
    const Vertices& w = tets_[t.value()].vertices;
    // Sums rather than branches: the answer is random, and branches on it would be mispredicted.
    const int i = (w[1] == v) + 2 * (w[2] == v) + 3 * (w[3] == v);
    return i != 0 || w[0] == v ? i : -1;
  }
  /// The same facet seen from the other tet.
  TetFacet mirror(TetFacet f) const {
    const TetId n = neighbour(f.tet, f.local);
    const std::array<TetId, 4>& back = tets_[n.value()].neighbours;
    return {n, (back[1] == f.tet) + 2 * (back[2] == f.tet) + 3 * (back[3] == f.tet)};
  }
  /// The facet's vertices in the order of kFacet.
  std::array<VertexId, 3> facet_vertices(TetFacet f) const {
    const std::array<int, 3>& k = kFacet[static_cast<std::size_t>(f.local)];
    return {vertex(f.tet, k[0]), vertex(f.tet, k[1]), vertex(f.tet, k[2])};
  }

  /// Asks for a tet's memory ahead of its use.
  void prefetch(TetId t) const {
    const char* tet = reinterpret_cast<const char*>(&tets_[t.value()]);
    __builtin_prefetch(tet);
    __builtin_prefetch(tet + sizeof(Tet) - 1);
  }

  TetId add(const Vertices& v);  ///< takes a free slot; neighbours invalid, flags clear
  void remove(TetId t);          ///< frees the slot; neighbours are not touched
  void set_neighbour(TetId t, int i, TetId n) { tets_[t.value()].neighbours[static_cast<std::size_t>(i)] = n; }
  void set_vertex(TetId t, int i, VertexId v) { tets_[t.value()].vertices[static_cast<std::size_t>(i)] = v; }
  /// Makes two facets each other's neighbour.
  void glue(TetFacet a, TetFacet b) {
    set_neighbour(a.tet, a.local, b.tet);
    set_neighbour(b.tet, b.local, a.tet);
  }

  // Locks: four bits of the flags, one a facet; the CAD face in a side table.
  bool is_locked(TetFacet f) const { return (tets_[f.tet.value()].flags >> f.local) & 1U; }
  FaceId locked_face(TetFacet f) const;  ///< invalid if not locked
  void lock(TetFacet f, FaceId face);    ///< both sides
  void unlock(TetFacet f);               ///< both sides
  std::size_t locked_count() const { return locks_.size(); }
  /// Carries the lock of an old facet to a new tet's facet with the same vertices (used by commits; one side).
  void set_lock_bit(TetFacet f, bool locked);

  // Region of a tet (SolidId value + 1; 0 unknown or outside) in the flags' high bits, and two scratch marks.
  std::uint32_t region(TetId t) const { return tets_[t.value()].flags >> 8; }
  void set_region(TetId t, std::uint32_t region) {
    tets_[t.value()].flags = (tets_[t.value()].flags & 0xFFU) | (region << 8);
  }
  bool mark(TetId t, int which) const { return (tets_[t.value()].flags >> (4 + which)) & 1U; }
  void set_mark(TetId t, int which, bool on);

  /// The states of all tets become 0. One flood at a time.
  void start_flood();

  void reserve(std::size_t tets);
  /// Renumbers the tets: order[k], all that are alive, becomes tet k.
  void reorder(const std::vector<TetId>& order, const Context& context);
  std::size_t bytes() const;

 private:
  using FacetKey = std::array<std::uint32_t, 3>;  // sorted vertex values
  struct FacetHash {
    std::size_t operator()(const FacetKey& k) const noexcept;
  };
  FacetKey key(TetFacet f) const;

  GrowingArray<Tet> tets_;
  std::uint32_t flood_ = 0;
  std::vector<std::uint32_t> free_;
  std::unordered_map<FacetKey, FaceId, FacetHash> locks_;  // looked up, never iterated
};

}  // namespace curvetet
