// Building: biased randomised insertion order (Amenta, Choi, Rote 2003) in rounds, each sorted along a Hilbert curve.
//
// The points are first copied into insertion order, so that neighbours in space are neighbours in memory; the complex
// is built over these local numbers and renamed at the end. Ties are still broken by the caller's ids: the result as a
// set of tets depends on the points and ids alone, not on the order.
//
// Rejected: one Hilbert order without rounds (quadratic on some inputs, e.g. points on two skew lines), caching minors
// (more memory traffic than it saves), and a table of edges for gluing (see kernel.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "predicates/predicates.h"
#include "spatial/kernel.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

namespace {

constexpr int kHilbertBits = 16;  ///< per coordinate
constexpr std::size_t kSmallestRound = 64;
constexpr int kRoundBits = 2;  ///< all rounds before one hold 2^-kRoundBits of the points up to it

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Index along the Hilbert curve of a cell (Skilling, Programming the Hilbert curve, 2004).
std::uint64_t hilbert_index(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1U << (kHilbertBits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& coordinate : x) {
      if (coordinate & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ coordinate) & p;
        x[0] ^= t;
        coordinate ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = 1U << (kHilbertBits - 1); q > 1; q >>= 1) {
    if (x[2] & q) t ^= q - 1;
  }
  std::uint64_t index = 0;
  for (int bit = kHilbertBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t coordinate : x) index = index << 1 | ((coordinate ^ t) >> bit & 1U);
  }
  return index;
}

/// The vertices in order of insertion.
std::vector<VertexId> insertion_order(std::span<const VertexId> vertices, const VertexStore& store,
                                      std::uint64_t seed) {
  struct Key {
    std::uint64_t hilbert;
    int round;
    VertexId vertex;
    auto operator<=>(const Key& other) const {
      if (round != other.round) return round <=> other.round;
      if (hilbert != other.hilbert) return hilbert <=> other.hilbert;
      return vertex <=> other.vertex;
    }
  };
  Box3 box;
  for (const VertexId v : vertices) box.extend(store.position(v));
  const double extent = std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
  const double cells = extent > 0 ? ((1U << kHilbertBits) - 1) / extent : 0;
  int rounds = 0;
  while (vertices.size() >> (kRoundBits * rounds) > kSmallestRound) ++rounds;
  std::vector<Key> keys;
  keys.reserve(vertices.size());
  for (const VertexId v : vertices) {
    const Vec3 p = cells * (store.position(v) - box.low);
    const int early = std::min(rounds, std::countr_zero(mix(seed ^ v.value())) / kRoundBits);
    keys.push_back({hilbert_index({static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                   static_cast<std::uint32_t>(p.z)}),
                    rounds - early, v});
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) { return a < b; });
  std::vector<VertexId> order;
  order.reserve(keys.size());
  for (const Key& key : keys) order.push_back(key.vertex);
  return order;
}

Error error_at(std::string message, std::vector<std::string> entities, Vec3 where) {
  return {ErrorCode::zero_size, std::move(message), std::move(entities), where};
}

Error same_place(VertexId a, VertexId b, Vec3 where) {
  const std::string first = fmt::format("vertex {}", std::min(a, b).value());
  const std::string second = fmt::format("vertex {}", std::max(a, b).value());
  return error_at(fmt::format("{} and {} are at the same place", first, second), {first, second}, where);
}

/// Inserts points one by one into a complex over local numbers 0..n-1 in the order of insertion.
class Builder {
 public:
  Builder(TetComplex& complex, std::vector<VertexId> order, const VertexStore& store, std::uint64_t seed)
      : complex_(complex), order_(std::move(order)), stream_(seed) {
    positions_.reserve(order_.size());
    for (const VertexId v : order_) positions_.push_back(store.position(v));
    complex_.reserve(7 * order_.size() + 64);
    star_builder_.cover_vertices(order_.size());
  }

  Status run(const Context& context) {
    if (Status status = start(); !status.ok()) return status;
    sites_ = {positions_.data(), order_.data()};
    for (std::size_t k = 4; k < order_.size(); ++k) {
      if (k % 1024 == 0 && context.should_stop()) return context.stop_error("tetrahedralization");
      if (const VertexId twin = insert(VertexId(k)); twin.valid()) {
        return same_place(order_[k], order_[twin.value()], positions_[k]);
      }
    }
    rename();
    return Done{};
  }

 private:
  /// Brings four points that are not coplanar to the front and makes the first tet.
  Status start() {
    const std::size_t n = order_.size();
    if (n < 4) return error_at("fewer than four vertices", {}, n > 0 ? positions_[0] : Vec3{});
    const auto& p = positions_;
    std::size_t second = 1;
    while (second < n && p[second] == p[0]) ++second;
    if (second != 1) return same_place(order_[0], order_[1], p[0]);
    std::size_t third = 2;
    while (third < n && collinear(p[0], p[1], p[third])) ++third;
    if (third == n) return error_at("all vertices are collinear", {}, p[0]);
    bring_to_front(third, 2);
    std::size_t fourth = 3;
    while (fourth < n && orient3d(p[0], p[1], p[2], p[fourth]) == 0) ++fourth;
    if (fourth == n) return error_at("all vertices are coplanar", {}, p[0]);
    bring_to_front(fourth, 3);
    const bool positive = orient3d(p[0], p[1], p[2], p[3]) > 0;
    last_ = kernel::add_first_tet(complex_, VertexId(positive ? 0 : 1), VertexId(positive ? 1 : 0), VertexId(2),
                                  VertexId(3));
    return Done{};
  }

  void bring_to_front(std::size_t from, std::size_t to) {
    const auto rotate = [&](auto& array) {
      const auto begin = array.begin();
      std::rotate(begin + static_cast<std::ptrdiff_t>(to), begin + static_cast<std::ptrdiff_t>(from),
                  begin + static_cast<std::ptrdiff_t>(from) + 1);
    };
    rotate(order_);
    rotate(positions_);
  }

  /// Invalid, or the vertex already there.
  VertexId insert(VertexId v) {
    const Vec3 p = positions_[v.value()];
    const TetId first = kernel::walk(complex_, sites_, p, start_for(p), stream_);
    for (const VertexId w : complex_.vertices(first)) {
      if (w != kInfinite && positions_[w.value()] == p) return w;
    }
    grow(first, p, order_[v.value()]);
    star_builder_.replace(complex_, v, tets_, boundary_, star_);
    last_ = star_.back();
    return VertexId();
  }

  /// The finite tet of the last star whose vertices are nearest to p. On surfaces, where tets are long and thin, this
  /// saves most of the walk; elsewhere it costs no more than it saves.
  TetId start_for(const Vec3& p) const {
    TetId best = last_;
    double least = std::numeric_limits<double>::infinity();
    for (const TetId t : star_) {
      double sum = 0;
      for (int i = 0; i < 3; ++i) {
        const VertexId v = complex_.vertex(t, i);
        sum += v == kInfinite ? least : norm2(positions_[v.value()] - p);
      }
      if (sum >= least) continue;
      least = sum;
      best = t;
    }
    return best;
  }

  void grow(TetId first, const Vec3& p, VertexId tie_id) {
    complex_.start_flood();
    tets_.assign(1, first);
    boundary_.clear();
    complex_.set_flood_state(first, kernel::kInside);
    for (std::size_t k = 0; k < tets_.size(); ++k) {
      const TetId t = tets_[k];
      for (int i = 0; i < 4; ++i) {
        const TetId next = complex_.neighbour(t, i);
        const std::uint32_t state = complex_.flood_state(next);
        if (state == kernel::kInside) continue;
        if (state == 0 && kernel::in_conflict(complex_, sites_, next, p, tie_id)) {
          complex_.set_flood_state(next, kernel::kInside);
          tets_.push_back(next);
          continue;
        }
        complex_.set_flood_state(next, kernel::kOutside);
        boundary_.push_back({t, i});
      }
    }
  }

  void rename() {
    for (std::size_t slot = 0; slot < complex_.slots(); ++slot) {
      const TetId t(slot);
      if (!complex_.is_alive(t)) continue;
      for (int i = 0; i < 4; ++i) {
        const VertexId v = complex_.vertex(t, i);
        if (v != kInfinite) complex_.set_vertex(t, i, order_[v.value()]);
      }
    }
  }

  TetComplex& complex_;
  std::vector<VertexId> order_;
  std::vector<Vec3> positions_;
  kernel::Stream stream_;
  kernel::Sites sites_;
  TetId last_;
  kernel::StarBuilder star_builder_;
  std::vector<TetId> tets_, star_;
  std::vector<TetFacet> boundary_;
};

}  // namespace

Status Tetrahedralization::build(std::span<const VertexId> vertices, const Context& context) {
  complex_ = TetComplex();
  kept_.clear();
  kept_degree_.clear();
  vertex_tet_.clear();
  star_.clear();
  last_ = TetId();
  Builder builder(complex_, insertion_order(vertices, *vertices_, seed_), *vertices_, seed_);
  if (Status status = builder.run(context); !status.ok()) {
    complex_ = TetComplex();
    return status;
  }
  cover_vertices();
  for (std::size_t slot = 0; slot < complex_.slots(); ++slot) {
    if (complex_.is_alive(TetId(slot))) touch(TetId(slot));
  }
  return Done{};
}

}  // namespace curvetet
