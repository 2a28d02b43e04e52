// Building: biased randomised insertion order (Amenta, Choi, Rote 2003) in rounds, each sorted along a Hilbert curve.
//
// The points are first copied into insertion order, so that neighbours in space are neighbours in memory; the complex
// is built over these local numbers and renamed at the end. Ties are still broken by the caller's ids: the result as a
// set of tets depends on the points and ids alone, not on the order.
//
// There are no locks yet, so that the cavity is known once it is grown. Its boundary is noted with all that the star
// needs, and the star takes the cavity's own slots. The time goes into waiting for memory and into spheres: tets are
// fetched ahead, spheres evaluated in fours (insphere_four.h), and what is as likely as not done without branches.
//
// Rejected: one Hilbert order without rounds (quadratic on some inputs, e.g. points on two skew lines); large pages
// (they take longer to clear than they save).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

#include "base/hilbert.h"
#include "predicates/predicates.h"
#include "spatial/conflicts.h"
#include "spatial/insphere_four.h"
#include "spatial/kernel.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

namespace {

constexpr double kGrid = 0x1p-42;  ///< every coordinate is a multiple (predicates.h)
constexpr int kHilbertBits = 16;   ///< per coordinate
constexpr std::size_t kSmallestRound = 64;
constexpr int kRoundBits = 3;  ///< all rounds before one hold 2^-kRoundBits of the points up to it

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// The vertices in order of insertion: by round, along the curve, by id.
std::vector<VertexId> insertion_order(std::span<const VertexId> vertices, const VertexStore& store,
                                      std::uint64_t seed) {
  Box3 box;
  for (const VertexId v : vertices) box.extend(store.position(v));
  const double extent = std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
  const double cells = extent > 0 ? ((1U << kHilbertBits) - 1) / extent : 0;
  int rounds = 0;
  while (vertices.size() >> (kRoundBits * rounds) > kSmallestRound) ++rounds;
  std::vector<std::pair<std::uint64_t, VertexId>> keys;
  keys.reserve(vertices.size());
  for (const VertexId v : vertices) {
    const Vec3 p = cells * (store.position(v) - box.low);
    const int early = std::min(rounds, std::countr_zero(mix(seed ^ v.value())) / kRoundBits);
    const std::uint64_t place = hilbert_index(
        {static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y), static_cast<std::uint32_t>(p.z)},
        kHilbertBits);
    keys.emplace_back(static_cast<std::uint64_t>(rounds - early) << (3 * kHilbertBits) | place, v);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VertexId> order;
  order.reserve(keys.size());
  for (const auto& [key, vertex] : keys) order.push_back(vertex);
  return order;
}

Error error_at(std::string message, std::vector<std::string> entities, Vec3 where) {
  return {ErrorCode::zero_size, std::move(message), std::move(entities), where};
}

using kernel::Site;

Error same_place(const Site& a, const Site& b) {
  const std::string first = fmt::format("vertex {}", std::min(a.id, b.id).value());
  const std::string second = fmt::format("vertex {}", std::max(a.id, b.id).value());
  return error_at(fmt::format("{} and {} are at the same place", first, second), {first, second}, a.position);
}

struct Sites {
  const Site* sites = nullptr;
  const Vec3& position(VertexId v) const { return sites[v.value()].position; }
  VertexId tie_id(VertexId v) const { return sites[v.value()].id; }
};

/// Inserts points one by one into a complex over local numbers 0..n-1 in the order of insertion.
class Builder {
 public:
  Builder(TetComplex& complex, const std::vector<VertexId>& order, const VertexStore& store, std::uint64_t seed)
      : complex_(complex), stream_(seed) {
    sites_.reserve(order.size());
    std::int64_t bits = 0;
    for (const VertexId v : order) {
      const Vec3& p = store.position(v);
      sites_.push_back({p, v});
      for (const double x : {p.x, p.y, p.z}) bits |= static_cast<std::int64_t>(x / kGrid);
    }
    exact_ = kernel::exact_below(kGrid * static_cast<double>(bits & -bits));
    complex_.reserve(7 * order.size() + 64);
  }

  Status run(const Context& context) {
    if (Status status = start(); !status.ok()) return status;
    for (std::size_t k = 4; k < sites_.size(); ++k) {
      if (k % 1024 == 0 && context.should_stop()) return context.stop_error("tetrahedralization");
      if (const VertexId twin = insert(VertexId(k)); twin.valid()) return same_place(sites_[k], sites_[twin.value()]);
    }
    return Done{};
  }

  /// After run, and once: from local numbers to the caller's ids; notes a tet of each vertex.
  void rename(IndexedVector<VertexId, TetId>& tet_of) {
    TetComplex::Tet* const all = complex_.tets();
    for (std::size_t slot = 0; slot < complex_.slots(); ++slot) {
      if (!complex_.is_alive(TetId(slot))) continue;
      for (VertexId& v : all[slot].vertices) {
        if (v == kInfinite) continue;
        Site& site = sites_[v.value()];
        site.number = static_cast<std::uint32_t>(slot);
        v = site.id;
      }
    }
    for (const Site& site : sites_) tet_of[site.id] = TetId(site.number);
  }

 private:
  /// Brings four points that are not coplanar to the front and makes the first tet.
  Status start() {
    const std::size_t n = sites_.size();
    const auto at = [&](std::size_t k) -> const Vec3& { return sites_[k].position; };
    if (n < 4) return error_at("fewer than four vertices", {}, n > 0 ? at(0) : Vec3{});
    if (at(1) == at(0)) return same_place(sites_[0], sites_[1]);
    std::size_t third = 2;
    while (third < n && collinear(at(0), at(1), at(third))) ++third;
    if (third == n) return error_at("all vertices are collinear", {}, at(0));
    bring_to_front(third, 2);
    std::size_t fourth = 3;
    while (fourth < n && orient3d(at(0), at(1), at(2), at(fourth)) == 0) ++fourth;
    if (fourth == n) return error_at("all vertices are coplanar", {}, at(0));
    bring_to_front(fourth, 3);
    const bool positive = orient3d(at(0), at(1), at(2), at(3)) > 0;
    last_ = kernel::add_first_tet(complex_, VertexId(positive ? 0 : 1), VertexId(positive ? 1 : 0), VertexId(2),
                                  VertexId(3));
    return Done{};
  }

  void bring_to_front(std::size_t from, std::size_t to) {
    const auto begin = sites_.begin();
    std::rotate(begin + static_cast<std::ptrdiff_t>(to), begin + static_cast<std::ptrdiff_t>(from),
                begin + static_cast<std::ptrdiff_t>(from) + 1);
  }

  /// Invalid, or the vertex already there.
  VertexId insert(VertexId v) {
    const Vec3 p = sites_[v.value()].position;
    const Sites sites{sites_.data()};
    const TetId first = kernel::walk(complex_, sites, p, start_for(p), stream_);
    for (const VertexId w : complex_.vertices(first)) {
      if (w != kInfinite && sites.position(w) == p) return w;
    }
    grow(first, p, sites.tie_id(v));
    fill(v);
    last_ = tets_[wall_count_ - 1];
    return VertexId();
  }

  /// The finite tet of the last star whose vertices are nearest to p. On surfaces, where tets are long and thin, this
  /// saves most of the walk; elsewhere it costs no more than it saves.
  TetId start_for(const Vec3& p) {
    if (far_.size() < named_) far_.resize(2 * named_);
    for (std::size_t k = 0; k < named_; ++k) {
      far_[k] = names_[k] == kInfinite ? std::numeric_limits<double>::infinity()
                                       : norm2(sites_[names_[k].value()].position - p);
    }
    TetId best = last_;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < wall_count_; ++k) {
      const auto [a, b, c] = wall_numbers_[k];
      const double sum = far_[a] + far_[b] + far_[c];
      best = sum < least ? tets_[k] : best;
      least = std::min(least, sum);
    }
    return best;
  }

  /// Fills tets_ and walls_. Spheres wait until there are four of them, or no other tet of the cavity is left to look
  /// around.
  void grow(TetId first, const Vec3& p, VertexId tie_id) {
    complex_.start_flood();
    complex_.tets()[first.value()].stamp = complex_.flood() + kernel::kInside;
    tets_[0] = first;
    tet_count_ = 1;
    asked_count_ = 0;
    for (std::size_t looked = 0, answered = 0;;) {
      make_room();
      while (asked_count_ < answered + 4 && looked < tet_count_) ask_around(tets_[looked++]);
      if (answered == asked_count_) break;
      const std::size_t n = std::min<std::size_t>(4, asked_count_ - answered);
      std::fill_n(asked_.data() + asked_count_, 4 - n, asked_[answered]);  // no lane is without a tet
      take_in(std::span(asked_).subspan(answered).first<4>(), n, p, tie_id);
      answered += n;
      // Those that joined, mostly one or two: to count them would cost a mispredicted branch.
      fetch_around(tets_[tet_count_ - 1]);
      fetch_around(tets_[std::max<std::size_t>(tet_count_, 2) - 2]);
    }
    note_walls();
  }

  void fetch_around(TetId t) const {
    for (const TetId id : complex_.neighbours(t)) complex_.prefetch(id);
  }

  /// Notes the neighbours that were not asked yet.
  void ask_around(TetId t) {
    TetComplex::Tet* const all = complex_.tets();
    const std::uint32_t outside = complex_.flood() + kernel::kOutside;
    for (const TetId id : all[t.value()].neighbours) {
      TetComplex::Tet& next = all[id.value()];
      asked_[asked_count_] = id;
      asked_count_ += static_cast<std::size_t>(next.stamp < outside);
      next.stamp = std::max(next.stamp, outside);
    }
  }

  /// Those of the n tets that join the cavity.
  void take_in(std::span<const TetId, 4> asked, std::size_t n, const Vec3& p, VertexId tie_id) {
    const unsigned conflicts = kernel::conflicts_among(complex_, Sites{sites_.data()}, insphere_four_, asked,
                                                       (1U << n) - 1, p, tie_id, exact_);
    TetComplex::Tet* const all = complex_.tets();
    for (std::size_t i = 0; i < 4; ++i) {
      const unsigned joins = conflicts >> i & 1U;
      tets_[tet_count_] = asked[i];
      tet_count_ += joins;
      all[asked[i].value()].stamp += joins * (kernel::kInside - kernel::kOutside);
    }
  }

  /// Once the cavity is known. Where its boundary is, is noted before what is there: both loops are without branches.
  void note_walls() {
    const TetComplex::Tet* const all = complex_.tets();
    const std::uint32_t inside = complex_.flood() + kernel::kInside;
    if (facets_.size() < 4 * tet_count_) facets_.resize(8 * tet_count_);
    wall_count_ = 0;
    for (std::size_t k = 0; k < tet_count_; ++k) {
      for (std::uint32_t i = 0; i < 4; ++i) {
        facets_[wall_count_] = {tets_[k], i};
        wall_count_ += static_cast<std::size_t>(all[all[tets_[k].value()].neighbours[i].value()].stamp != inside);
      }
    }
    if (walls_.size() < wall_count_) walls_.resize(2 * wall_count_);
    for (std::size_t k = 0; k < wall_count_; ++k) {
      const auto [t, i] = facets_[k];
      const TetComplex::Tet& tet = all[t.value()];
      kernel::Wall& wall = walls_[k];
      wall.outer = tet.neighbours[i];
      const std::array<TetId, 4>& back = all[wall.outer.value()].neighbours;
      wall.local = (back[1] == t) + 2 * (back[2] == t) + 3 * (back[3] == t);
      for (std::size_t j = 0; j < 3; ++j) wall.vertices[j] = tet.vertices[static_cast<std::size_t>(kFacet[i][j])];
    }
  }

  /// For four tets more in the cavity, and what is around them.
  void make_room() {
    if (tets_.size() < tet_count_ + 4) tets_.resize(2 * tets_.size());
    if (asked_.size() < asked_count_ + 16) asked_.resize(2 * asked_.size());
  }

  /// Replaces the cavity by the star of v, in the cavity's own slots as far as they reach.
  void fill(VertexId v) {
    for (; tet_count_ < wall_count_; ++tet_count_) {
      if (tet_count_ == tets_.size()) tets_.resize(2 * tets_.size());
      tets_[tet_count_] = complex_.add({});
    }
    number_walls();
    star_builder_.fill(complex_, v, std::span(walls_).first(wall_count_), tets_, wall_numbers_, named_);
    for (std::size_t k = wall_count_; k < tet_count_; ++k) complex_.remove(tets_[k]);
  }

  /// What a site holds is its vertex's number if the names agree, so that nothing has to be cleared.
  void number_walls() {
    if (names_.size() < 3 * wall_count_) names_.resize(std::bit_ceil(3 * wall_count_));
    if (wall_numbers_.size() < wall_count_) wall_numbers_.resize(2 * wall_count_);
    const std::size_t mask = names_.size() - 1;
    std::uint32_t named = 0;
    for (std::size_t k = 0; k < wall_count_; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        const VertexId w = walls_[k].vertices[j];
        std::uint32_t& held = w == kInfinite ? infinite_ : sites_[w.value()].number;
        const std::uint32_t fresh = (held >= named) | (names_[held & mask] != w);
        held = (held & (fresh - 1)) | (named & -fresh);
        names_[held] = w;
        named += fresh;
        wall_numbers_[k][j] = held;
      }
    }
    named_ = named;
  }

  TetComplex& complex_;
  std::vector<Site> sites_;
  kernel::Stream stream_;
  const kernel::InsphereFour insphere_four_ = kernel::insphere_four();
  double exact_ = 0;  ///< see kernel::exact_below
  TetId last_;
  kernel::StarBuilder star_builder_;
  // The cavity, then the star in its place: tet k of the star is behind wall k. Only the counted entries are in use.
  std::vector<TetId> tets_ = std::vector<TetId>(64);
  std::vector<kernel::Wall> walls_ = std::vector<kernel::Wall>(64);
  std::vector<TetId> asked_ = std::vector<TetId>(64);  ///< each once, in the order in which they were met
  std::vector<std::pair<TetId, std::uint32_t>> facets_;
  std::size_t tet_count_ = 0, wall_count_ = 0, asked_count_ = 0;
  // The vertices of the boundary by number, of which there are named_, and the numbers of each wall's.
  std::vector<VertexId> names_;  ///< a power of two
  std::vector<kernel::WallNumbers> wall_numbers_;
  std::uint32_t named_ = 0;
  std::vector<double> far_;  ///< squared distance of each vertex of the last boundary to the next point

  std::uint32_t infinite_ = 0;  ///< the number of the infinite vertex
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
  builder.rename(vertex_tet_);
  return Done{};
}

}  // namespace curvetet
