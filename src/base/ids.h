// Strong identifiers: 32-bit indices that cannot be mixed up, and vectors indexed by them.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace curvetet {

/// Index of one kind of thing. Explicit construction, no arithmetic; a default constructed id is invalid.
template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t value) : value_(value) {}
  constexpr explicit Id(std::size_t value) : value_(static_cast<std::uint32_t>(value)) {}
  constexpr explicit Id(int value) : value_(static_cast<std::uint32_t>(value)) {}
  static constexpr Id invalid() { return Id(); }
  constexpr std::uint32_t value() const { return value_; }
  constexpr bool valid() const { return value_ != std::numeric_limits<std::uint32_t>::max(); }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;

 private:
  std::uint32_t value_ = std::numeric_limits<std::uint32_t>::max();
};

using VertexId = Id<struct VertexTag>;        ///< vertex of the mesh, in the VertexStore
using TetId = Id<struct TetTag>;              ///< tetrahedron in a TetComplex
using NodeId = Id<struct NodeTag>;            ///< node of one face mesh
using TriangleId = Id<struct TriangleTag>;    ///< triangle of one face mesh
using FaceId = Id<struct FaceTag>;            ///< CAD face, index into Model (0-based; users see Face::cad_id)
using EdgeId = Id<struct EdgeTag>;            ///< CAD edge, index into Model
using CadVertexId = Id<struct CadVertexTag>;  ///< CAD vertex, index into Model
using SolidId = Id<struct SolidTag>;          ///< CAD solid, index into Model

/// std::vector that accepts only its own kind of id as index.
template <class Key, class T>
class IndexedVector {
 public:
  using reference = typename std::vector<T>::reference;
  using const_reference = typename std::vector<T>::const_reference;
  IndexedVector() = default;
  explicit IndexedVector(std::size_t n, const T& value = T()) : data_(n, value) {}
  reference operator[](Key key) { return data_[key.value()]; }
  const_reference operator[](Key key) const { return data_[key.value()]; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }
  void resize(std::size_t n) { data_.resize(n); }
  void resize(std::size_t n, const T& value) { data_.resize(n, value); }
  void assign(std::size_t n, const T& value) { data_.assign(n, value); }
  void reserve(std::size_t n) { data_.reserve(n); }
  void clear() { data_.clear(); }
  Key push_back(T value) {
    data_.push_back(std::move(value));
    return Key(data_.size() - 1);
  }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }
  std::vector<T>& raw() { return data_; }
  const std::vector<T>& raw() const { return data_; }

 private:
  std::vector<T> data_;
};

}  // namespace curvetet

template <class Tag>
struct std::hash<curvetet::Id<Tag>> {
  std::size_t operator()(const curvetet::Id<Tag>& id) const noexcept { return std::hash<std::uint32_t>()(id.value()); }
};
