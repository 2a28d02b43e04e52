// Delaunay tetrahedralization of grid points, with locked facets and kept segments. Insertion is by cavity:
// find, judge, commit.
//
// Before: every vertex lies on the grid (geometry/frame.h); no two at one place.
// After each commit: neighbour links are reciprocal, every finite tet is positive (exactly), ghosts cover the hull, and
// without locks and kept segments the tetrahedralization is Delaunay of the symbolically perturbed points.
// Queries and find_cavity use scratch arrays of the object: not to be called on one object from several threads, but
// for those that say so.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "mesh/tet_complex.h"
#include "mesh/vertex_store.h"
#include "spatial/insphere_four.h"
#include "spatial/kernel.h"
#include "spatial/small_marks.h"

namespace curvetet {

/// An edge seen from one tet: local vertices i and j.
struct TetEdge {
  TetId tet;
  int i = 0, j = 1;
};

/// Why a vertex cannot be inserted.
enum class Refusal : std::uint8_t {
  none,
  duplicate,        ///< a vertex is already at this place
  on_locked_facet,  ///< the point lies on a locked facet
  on_kept_segment,  ///< the point lies on a kept segment
  locked_cavity,    ///< no star-shaped cavity is left after shrinking
  outside,          ///< outside the hull while the caller forbade it
  too_close,        ///< closer than asked to an existing vertex
  encroaches,       ///< the cavity would touch what the caller protects
};
const char* name(Refusal refusal);

/// The tets that an insertion would delete and the facets of their boundary (each seen from the tet that goes).
struct Cavity {
  VertexId vertex;
  std::vector<TetId> tets;
  std::vector<TetFacet> boundary;
  std::vector<kernel::WallNumbers> numbers;  ///< of the vertices of each boundary facet, as the search numbers them
  std::uint32_t numbered = 0;                ///< vertices with a number
  Refusal refusal = Refusal::none;
  bool ok() const { return refusal == Refusal::none; }
};

/// What one search needs for itself.
struct CavityScratch {
  kernel::SmallMarks marks;
  kernel::SmallNumbers numbers;  ///< of the vertices of the boundary
  std::vector<TetId> queue;
  std::size_t bytes() const { return marks.bytes() + numbers.bytes() + queue.capacity() * sizeof(TetId); }
};

/// One of many insertions at a time: found, then reserved, then committed, then settled.
struct Insertion {
  Cavity cavity;
  std::vector<kernel::Wall> walls;  ///< in the order of the cavity's boundary
  std::vector<TetId> slots;         ///< the star's tets, behind the walls in order; once settled no more than these
};

class Tetrahedralization {
 public:
  /// The store must outlive this object; vertices are inserted by id.
  Tetrahedralization(const VertexStore& vertices, std::uint64_t seed);

  /// Delaunay tetrahedralization of all given vertices, in BRIO rounds along a Hilbert curve; replaces what is there.
  /// An error if fewer than four, or all coplanar, or two at one place (names both).
  Status build(std::span<const VertexId> vertices, const Context& context);

  // --- insertion: find, judge, commit ---
  /// The tet (finite, or a ghost if outside the hull) that contains p, by a walk from the hint (or from the last
  /// place).
  TetId locate(Vec3 p, TetId hint = TetId()) const;
  /// The cavity of the vertex, which is in the store but not yet in this tetrahedralization; changes nothing. Not grown
  /// across locked facets, shrunk until star-shaped (exactly) with every kept segment on its boundary or outside.
  Cavity find_cavity(VertexId vertex, TetId hint = TetId()) const;
  /// Replaces the cavity by the star of the vertex; returns one new tet.
  TetId commit(const Cavity& cavity);
  /// find and commit.
  Refusal insert(VertexId vertex, TetId hint = TetId());
  /// The tets made by the last commit.
  const std::vector<TetId>& last_star() const { return star_; }

  // --- many insertions at a time: find_cavity_at and commit on several threads, reserve and settle on one ---
  /// The cavity of a vertex that is still to be added to the store, at p in the closed finite tet `holding`. Changes
  /// nothing. Each thread has a scratch of its own.
  void find_cavity_at(Vec3 p, TetId holding, CavityScratch& scratch, Cavity& cavity) const;
  /// Notes what commit will need of the tets beside the cavity. Changes nothing.
  void note_walls(Insertion& insertion) const;
  /// Takes slots for the star of the vertex, which is in the store now.
  void reserve(Insertion& insertion, VertexId vertex);
  /// Replaces the cavity by the star, if no tet of it or beside it has gone since it was found. Each thread has a
  /// builder of its own.
  void commit(Insertion& insertion, kernel::StarBuilder& builder);
  /// Frees what is not needed: then more insertions may be found.
  void settle(Insertion& insertion);
  /// After the last of them, or sort_in_space: notes a tet of each vertex, without which nothing is found by vertices.
  void link_vertices();

  /// Renumbers all tets, and the vertices from `first` on, which no constraint has, along a Hilbert curve: neighbours
  /// in space become neighbours in memory. The store must be that of the constructor.
  void sort_in_space(VertexStore& vertices, VertexId first, const Context& context);

  // --- queries ---
  const TetComplex& complex() const { return complex_; }
  TetComplex& complex() { return complex_; }
  const VertexStore& vertices() const { return *vertices_; }
  Vec3 position(VertexId v) const { return vertices_->position(v); }
  bool contains(VertexId v) const { return v.value() < vertex_tet_.size() && vertex_tet_[v].valid(); }
  TetId tet_of(VertexId v) const { return vertex_tet_[v]; }
  /// All tets (ghosts too) around a vertex, into `out` (cleared first).
  void star(VertexId v, std::vector<TetId>& out) const { star(v, scratch_.marks, out); }
  /// The same for several threads at a time, each with marks of its own.
  void star(VertexId v, kernel::SmallMarks& marks, std::vector<TetId>& out) const;
  std::optional<TetEdge> find_edge(VertexId a, VertexId b) const;
  /// The facet with these vertices, seen from one of its tets, if it exists.
  std::optional<TetFacet> find_facet(VertexId a, VertexId b, VertexId c) const;
  /// The tets around an edge in order, ghosts included, starting at edge.tet and leaving it through the facet opposite
  /// k, where (i,j,k,l) is an even permutation of its local vertices: right-handed around the edge from i to j.
  void ring(TetEdge edge, std::vector<TetId>& out) const;

  // --- constraints ---
  void lock(TetFacet facet, FaceId face) { complex_.lock(facet, face); }
  /// Edges that no insertion and no flip may remove.
  void keep_segment(VertexId a, VertexId b);
  void release_segment(VertexId a, VertexId b);
  bool is_kept(VertexId a, VertexId b) const;
  bool is_end_of_kept(VertexId v) const { return v.value() < kept_degree_.size() && kept_degree_[v] > 0; }
  /// All of them, smaller id first, sorted.
  std::vector<std::array<VertexId, 2>> kept_segments() const;

  /// Of all arrays, scratch included.
  std::size_t bytes() const;

  /// To be called by code that changes the complex by flips: keeps vertex_tet_ right for the vertices of t.
  void touch(TetId t);

 private:
  friend class CavitySearch;
  kernel::Sites sites() const { return {vertices_->sites()}; }
  /// The star in the order of a flood; stops at the first tet that `until` holds for, which becomes the first of `out`.
  template <class Until>
  void flood_star(VertexId v, kernel::SmallMarks& marks, std::vector<TetId>& out, const Until& until) const;
  void sort_tets(const IndexedVector<VertexId, VertexId>& number, const IndexedVector<VertexId, std::uint32_t>& rank,
                 const Context& context);
  void cover_vertices();  ///< grows the tables by vertex to the store's size

  const VertexStore* vertices_;
  std::uint64_t seed_;
  TetComplex complex_;
  IndexedVector<VertexId, TetId> vertex_tet_;
  std::unordered_set<std::uint64_t> kept_;              // iterated only to be sorted
  IndexedVector<VertexId, std::uint32_t> kept_degree_;  // how many kept segments end there; up to the last
  kernel::StarBuilder star_builder_;
  std::vector<TetId> star_;
  mutable std::vector<TetId> around_;  // scratch of find_edge and find_facet
  mutable TetId last_;                 // where the last location ended
  mutable CavityScratch scratch_;      // of find_cavity
  kernel::InsphereFour insphere_four_ = kernel::insphere_four();
};

}  // namespace curvetet
