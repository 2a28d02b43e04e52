// The one primitive behind every flip: exchange a set of tets for another set that fills the same polyhedron.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "spatial/tetrahedralization.h"

namespace curvetet::flips {

/// A vector of bounded size that lives on the stack.
template <class T, std::size_t N>
class Inline {
 public:
  void push_back(const T& value) {
    CURVETET_CHECK(size_ < N);
    data_[size_++] = value;
  }
  /// Removes element i; the last takes its place.
  void take(std::size_t i) { data_[i] = data_[--size_]; }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == N; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  const T* data() const { return data_.data(); }
  const T* begin() const { return data_.data(); }
  const T* end() const { return data_.data() + size_; }

 private:
  std::array<T, N> data_;
  std::size_t size_ = 0;
};

/// Longest ring of an edge that can be removed at once.
inline constexpr std::size_t kMaxRing = 16;
inline constexpr std::size_t kMaxTets = 2 * kMaxRing;

/// The tets that go and the vertices of those that come; both fill the same polyhedron.
struct Exchange {
  Inline<TetId, kMaxTets> old_tets;
  Inline<TetComplex::Vertices, kMaxTets> new_tets;
};

/// True if the old tets are finite, of one region, and no facet between two of them is locked.
bool is_free(const TetComplex& complex, const Exchange& exchange);

/// Volume over the cube of the longest edge, times six.
double volume_over_length(Vec3 a, Vec3 b, Vec3 c, Vec3 d);

/// Exchanges the tets. Locks on the polyhedron's boundary and the region stay. Before: is_free.
void commit(Tetrahedralization& mesh, const Exchange& exchange);
/// As commit, for any number of tets. Locked facets between two old tets must be facets of the new ones, and stay
/// locked.
void commit_many(Tetrahedralization& mesh, std::span<const TetId> old_tets,
                 std::span<const TetComplex::Vertices> new_tets);

/// The polyhedron around an edge: tet i has the vertices (p, q, ring[i], ring[i+1]) and is positive.
struct Ring {
  VertexId p, q;
  Inline<VertexId, kMaxRing> vertices;
  Inline<TetId, kMaxRing> tets;
};

/// The ring of an edge, or nothing if it is longer than `limit` or touches a ghost.
std::optional<Ring> ring_of(const TetComplex& complex, TetEdge edge, std::size_t limit);

/// Remembers exchanges so that they can be taken back.
class Log {
 public:
  void commit(Tetrahedralization& mesh, const Exchange& exchange);
  std::size_t size() const { return records_.size(); }
  /// Takes back all but the first `size` exchanges, the last one first.
  void undo_to(Tetrahedralization& mesh, std::size_t size);

 private:
  struct Record {
    std::vector<TetComplex::Vertices> old_tets, new_tets;
  };
  std::vector<Record> records_;
};

}  // namespace curvetet::flips
