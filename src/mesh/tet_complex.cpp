// Flat arrays and a stack of free slots. A dead slot is one whose first vertex is invalid: no separate flag to keep
// right.
//
// Lock bits live in the flags, so that growing a cavity reads one word per tet; only the CAD face of a lock is looked
// up in a table, keyed by the facet's sorted vertices. The key survives commits that replace the tets on either side,
// which a key by tet and local index would not.
#include "mesh/tet_complex.h"

#include <algorithm>

#include "base/error.h"
#include "base/gather.h"

namespace curvetet {

std::size_t TetComplex::FacetHash::operator()(const FacetKey& k) const noexcept {
  std::uint64_t h = k[0];
  for (const std::uint32_t v : {k[1], k[2]}) {
    h = (h ^ (h >> 29)) * 0x9E3779B97F4A7C15ULL + v;
  }
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93ULL;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

TetComplex::FacetKey TetComplex::key(TetFacet f) const {
  const std::array<VertexId, 3> v = facet_vertices(f);
  FacetKey k{v[0].value(), v[1].value(), v[2].value()};
  std::sort(k.begin(), k.end());
  return k;
}

TetId TetComplex::add(const Vertices& v) {
  if (!free_.empty()) {
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    tets_[slot] = {v, {}, 0, 0};
    return TetId(slot);
  }
  tets_.push_back({v, {}, 0, 0});
  return TetId(tets_.size() - 1);
}

void TetComplex::remove(TetId t) {
  CURVETET_CHECK(is_alive(t));
  tets_[t.value()].vertices[0] = VertexId();
  free_.push_back(t.value());
}

FaceId TetComplex::locked_face(TetFacet f) const {
  if (!is_locked(f)) return FaceId();
  const auto it = locks_.find(key(f));
  return it == locks_.end() ? FaceId() : it->second;
}

void TetComplex::lock(TetFacet f, FaceId face) {
  set_lock_bit(f, true);
  set_lock_bit(mirror(f), true);
  locks_.insert_or_assign(key(f), face);
}

void TetComplex::unlock(TetFacet f) {
  set_lock_bit(f, false);
  set_lock_bit(mirror(f), false);
  locks_.erase(key(f));
}

void TetComplex::set_lock_bit(TetFacet f, bool locked) {
  const std::uint32_t bit = 1U << f.local;
  std::uint32_t& flags = tets_[f.tet.value()].flags;
  flags = locked ? (flags | bit) : (flags & ~bit);
}

void TetComplex::set_mark(TetId t, int which, bool on) {
  const std::uint32_t bit = 1U << (4 + which);
  std::uint32_t& flags = tets_[t.value()].flags;
  flags = on ? (flags | bit) : (flags & ~bit);
}

void TetComplex::start_flood() {
  if (flood_ > 0xFFFFFFF0U) {
    for (Tet& tet : tets_) tet.stamp = 0;
    flood_ = 0;
  }
  flood_ += 4;
}

void TetComplex::reorder(const std::vector<TetId>& order, const Context& context) {
  CURVETET_CHECK(order.size() == alive());
  std::vector<TetId> number(tets_.size());
  GrowingArray<Tet> sorted;
  sorted.resize(order.size());
  in_blocks(context, order.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) number[order[k].value()] = TetId(k);
  });
  in_blocks(context, order.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      sorted[k] = tets_[order[k].value()];
      for (TetId& n : sorted[k].neighbours) n = number[n.value()];
    }
  });
  tets_ = std::move(sorted);
  free_.clear();
}

void TetComplex::reserve(std::size_t tets) { tets_.reserve(tets); }

std::size_t TetComplex::bytes() const {
  // A node of the lock table: key, value, cached hash and link.
  const std::size_t lock_node = sizeof(FacetKey) + sizeof(FaceId) + 2 * sizeof(void*);
  return tets_.capacity() * sizeof(Tet) + free_.capacity() * sizeof(std::uint32_t) + locks_.size() * lock_node +
         locks_.bucket_count() * sizeof(void*);
}

}  // namespace curvetet
