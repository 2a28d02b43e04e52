// Improvement in rounds: reconnect, smooth, and again while it pays; then exchange locks of flat tets, then give a
// vertex to the tets that are still bad, and start over. All work is on tets below a goal, so a good mesh costs one
// look at each tet. Every change is judged by the worst tet of what it replaces (Freitag and Ollivier-Gooch 1997;
// Klingner and Shewchuk 2007), but for the last one, beside needles.
//
// Many tets or vertices are looked at side by side, by all threads, while nothing changes; then the mesh is changed in
// order, and what an earlier change has disturbed is looked at once more. So nothing depends on the number of threads.
//
// Rejected: a queue ordered by quality. Sweeps in slot order find nearly the same changes, need no bookkeeping, and
// touch memory in order. Sliver exudation by weights was not taken either: it works with what a weighted Delaunay
// tetrahedralization offers, reconnection with all there is. Merging a bad interior vertex into a neighbour found 13
// places in 275 thousand tets beside strips, where most bad tets were.
#include "volume/improve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "base/gather.h"
#include "base/parallel_sort.h"
#include "geometry/frame.h"
#include "predicates/predicates.h"
#include "quality/measures.h"
#include "spatial/flips.h"
#include "volume/relock.h"
#include "volume/shape.h"
#include "volume/vertex_insertion.h"

namespace curvetet {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// Reconnecting and smoothing is repeated at most this often in a round, on ever fewer tets.
constexpr int kSweeps = 10;
/// A new vertex must raise the least sine of the worst tet by this much (two degrees): a vertex for nothing is a cost.
constexpr double kInsertionGain = 0.035;
/// Degrees: what smoothing beside needles is after, and what it must leave to the tets over needles.
constexpr double kNeedleGoal = 5;
constexpr double kLeastOverNeedle = 1;
constexpr int kNeedleSweeps = 5;
/// To flood the star of a vertex takes as long as to pass by so many tets.
constexpr std::size_t kSlotsPerStar = 200;
/// Attempts to insert that may fail in a round, besides two for each that succeeded: where a body is thinner than its
/// facets are long, bad tets are the body's fault and every attempt fails.
constexpr std::size_t kFailedInsertions = 100;

/// Tets or vertices that are looked at before any of them is changed, and how many of these by one thread at a time.
constexpr std::size_t kBatch = 1024, kGrain = 16;

/// What one thread needs for itself.
struct Worker {
  kernel::SmallMarks marks;
  std::vector<TetId> star;
  StarFacets facets;
  StarOptimiser optimiser;
};

/// What would replace a bad tet.
struct Reconnection {
  flips::Exchange exchange;
  std::size_t ImproveResult::*counter = nullptr;
};

/// Where a vertex would go, and the vertices that it depends on.
struct Move {
  std::optional<Vec3> there;
  std::vector<VertexId> around;
};

class Improvement {
 public:
  Improvement(Tetrahedralization& mesh, VertexStore& vertices, const ImproveOptions& options, Context& context)
      : mesh_(mesh),
        complex_(mesh.complex()),
        vertices_(vertices),
        options_(options),
        context_(context),
        insertion_(mesh, vertices),
        goal_(std::sin(options.goal * kDegree)),
        workers_(worker_count(context)) {}

  Result<ImproveResult> run() {
    collect_below();
    result_.worst_before = worst_degrees();
    for (int round = 0; round < options_.rounds; ++round) {
      reconnect_and_smooth();
      const std::size_t changed = exchange_locks() + (options_.insert_vertices ? insert_vertices() : 0);
      if (stopped_) return context_.stop_error("improvement");
      if (changed == 0) break;
    }
    reconnect_and_smooth();
    smooth_beside_needles();
    if (stopped_) return context_.stop_error("improvement");
    result_.worst_after = worst_degrees();
    return result_;
  }

 private:
  bool is_inside(TetId t) const { return complex_.is_alive(t) && complex_.region(t) > 0 && !complex_.is_ghost(t); }

  double quality(TetId t) const {
    const auto& v = complex_.vertices(t);
    return least_sine(vertices_.position(v[0]), vertices_.position(v[1]), vertices_.position(v[2]),
                      vertices_.position(v[3]));
  }

  double worst_degrees() const {
    const bool all = below_.empty();
    const std::size_t n = all ? complex_.slots() : below_.size();
    std::vector<double> least((n + kLargeBlock - 1) / kLargeBlock, 1);
    in_blocks(context_, n, kLargeBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const TetId t = all ? TetId(k) : below_[k];
        if (is_inside(t)) least[begin / kLargeBlock] = std::min(least[begin / kLargeBlock], quality(t));
      }
    });
    const double worst = least.empty() ? 1 : *std::min_element(least.begin(), least.end());
    return std::asin(std::clamp(worst, 0.0, 1.0)) / kDegree;
  }

  bool should_stop() {
    stopped_ = stopped_ || context_.should_stop();
    return stopped_;
  }

  /// Works on all bad tets when first called, then on those near what was changed, here or elsewhere: the same attempts
  /// at others would fail again.
  void reconnect_and_smooth() {
    bad_.swap(pending_);
    for (int sweep = 0; sweep < kSweeps && !stopped_ && !bad_.empty(); ++sweep) {
      touched_.clear();
      reconnect();
      std::vector<TetId> still_bad = bad_;
      collect_bad_near_touched();
      bad_.insert(bad_.end(), still_bad.begin(), still_bad.end());
      smooth();
      collect_bad_near_touched();
      below_.insert(below_.end(), bad_.begin(), bad_.end());
    }
    pending_ = bad_;
    tidy(below_);
  }

  /// Of all tets, those below the goal. From here on only what is near a change has to be looked at.
  void collect_below() {
    below_ = all_inside([this](TetId t) { return quality(t) < goal_; });
    pending_ = below_;
  }

  /// The tets inside that are asked for, ascending.
  template <class Asked>
  std::vector<TetId> all_inside(const Asked& asked) const {
    return gather<TetId>(context_, complex_.slots(), kLargeBlock, [&](std::size_t k, std::vector<TetId>& out) {
      if (is_inside(TetId(k)) && asked(TetId(k))) out.push_back(TetId(k));
    });
  }

  /// Those of a list that are there and below the goal, ascending, each once.
  void tidy(std::vector<TetId>& tets) const {
    tets = gather<TetId>(context_, tets.size(), kLargeBlock, [&](std::size_t k, std::vector<TetId>& out) {
      if (is_inside(tets[k]) && quality(tets[k]) < goal_) out.push_back(tets[k]);
    });
    parallel_sort(context_, tets, std::less<>());
    tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  }

  /// Changes near touched_ may have made more of them.
  void refresh_below() {
    collect_bad_near_touched();
    below_.insert(below_.end(), bad_.begin(), bad_.end());
    pending_.insert(pending_.end(), bad_.begin(), bad_.end());
    touched_.clear();
    tidy(below_);
    tidy(pending_);
  }

  void collect_bad(double goal) {
    bad_.clear();
    std::copy_if(below_.begin(), below_.end(), std::back_inserter(bad_), [&](TetId t) { return quality(t) < goal; });
  }

  void collect_bad_near_touched() {
    bad_.clear();
    parallel_sort(context_, touched_, std::less<>());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    if (touched_.size() > complex_.slots() / kSlotsPerStar) {
      collect_bad_with_touched();
      return;
    }
    for (VertexId v : touched_) {
      mesh_.star(v, star_);
      for (TetId t : star_) {
        if (is_inside(t) && quality(t) < goal_) bad_.push_back(t);
      }
    }
    std::sort(bad_.begin(), bad_.end());
    bad_.erase(std::unique(bad_.begin(), bad_.end()), bad_.end());
  }

  /// The same by a look at all tets, in order.
  void collect_bad_with_touched() {
    is_touched_.assign(vertices_.size(), 0);
    for (const VertexId v : touched_) is_touched_[v] = 1;
    bad_ = all_inside([this](TetId t) {
      const auto& v = complex_.vertices(t);
      return (is_touched_[v[0]] | is_touched_[v[1]] | is_touched_[v[2]] | is_touched_[v[3]]) != 0 && quality(t) < goal_;
    });
  }

  // --- batches ---

  /// look(item, k, worker) for item k of a batch, side by side, while nothing changes; then change(item, k) in order. A
  /// batch is spread over the list, and so over the mesh, that few are near each other.
  template <class Item, class Look, class Change>
  void in_batches(const std::vector<Item>& items, const Look& look, const Change& change) {
    const std::size_t batches = (items.size() + kBatch - 1) / kBatch;
    for (std::size_t b = 0; b < batches && !should_stop(); ++b) {
      ++batch_number_;
      changed_.resize(vertices_.size(), 0);
      const std::size_t count = (items.size() - b + batches - 1) / batches;
      parallel_for(context_, (count + kGrain - 1) / kGrain, [&](std::size_t block, std::size_t worker) {
        for (std::size_t k = block * kGrain; k < std::min(count, (block + 1) * kGrain); ++k)
          look(items[b + k * batches], k, workers_[worker]);
      });
      for (std::size_t k = 0; k < count; ++k) change(items[b + k * batches], k);
    }
  }

  bool is_changed(VertexId v) const { return changed_[v] == batch_number_; }

  // --- reconnection ---

  /// Where one before has changed what it would exchange, a tet is looked at once more in its turn.
  void reconnect() {
    reconnections_.resize(kBatch);
    in_batches(
        bad_, [&](TetId t, std::size_t k, Worker&) { reconnections_[k] = find_reconnection(t); },
        [&](TetId t, std::size_t k) {
          std::optional<Reconnection>& found = reconnections_[k];
          if (found && is_disturbed(found->exchange)) found = find_reconnection(t);
          if (found) commit(t, *found);
        });
  }

  std::optional<Reconnection> find_reconnection(TetId t) const {
    if (!is_inside(t)) return std::nullopt;
    const double now = quality(t);
    if (now >= goal_) return std::nullopt;
    for (const auto& [i, j] : kEdge)
      if (const auto found = find_edge_removal(mesh_, {t, i, j}, least_sine, now))
        return Reconnection{found->exchange, &ImproveResult::edge_removals};
    for (int i = 0; i < 4; ++i)
      if (const auto found = find_faces_removal(mesh_, {t, i}, least_sine, now))
        return Reconnection{found->exchange, &ImproveResult::face_removals};
    return std::nullopt;
  }

  /// Whether a change of this batch is at one of the tets that would go.
  bool is_disturbed(const flips::Exchange& exchange) const {
    return std::any_of(exchange.old_tets.begin(), exchange.old_tets.end(), [this](TetId t) {
      if (!complex_.is_alive(t)) return true;
      const auto& v = complex_.vertices(t);
      return std::any_of(v.begin(), v.end(), [this](VertexId x) { return is_changed(x); });
    });
  }

  void commit(TetId t, const Reconnection& reconnection) {
    const flips::Exchange& exchange = reconnection.exchange;
    // All that replaces the tet shares a vertex with it.
    const auto v = complex_.vertices(t);
    touched_.insert(touched_.end(), v.begin(), v.end());
    for (TetId old : exchange.old_tets)
      for (VertexId x : complex_.vertices(old)) changed_[x] = batch_number_;
    ++(result_.*reconnection.counter);
    flips::commit(mesh_, exchange);
  }

  // --- smoothing ---

  /// The interior vertices of the bad tets that are left.
  void collect_movable() {
    movable_.clear();
    for (TetId t : bad_) {
      if (!is_inside(t) || quality(t) >= goal_) continue;
      for (VertexId v : complex_.vertices(t)) {
        if (vertices_.owner(v).kind == OwnerKind::interior) movable_.push_back(v);
      }
    }
    parallel_sort(context_, movable_, std::less<>());
    movable_.erase(std::unique(movable_.begin(), movable_.end()), movable_.end());
  }

  /// Where a neighbour has moved, a vertex looks for its best place once more in its turn.
  void smooth() {
    collect_movable();
    moves_.resize(kBatch);
    in_batches(
        movable_, [&](VertexId v, std::size_t k, Worker& worker) { find_move(v, worker, moves_[k]); },
        [&](VertexId v, std::size_t k) {
          Move& found = moves_[k];
          if (std::any_of(found.around.begin(), found.around.end(), [this](VertexId x) { return is_changed(x); }))
            find_move(v, workers_[0], found);
          if (!found.there) return;
          vertices_.move(v, *found.there);
          changed_[v] = batch_number_;
          touched_.push_back(v);
          ++result_.moves;
        });
  }

  /// The facets that an interior vertex sees; false if one of its own is locked.
  bool collect_facets(VertexId v, Worker& worker) const {
    mesh_.star(v, worker.marks, worker.star);
    worker.facets.clear();
    for (TetId t : worker.star) {
      const int i = complex_.local(t, v);
      if (complex_.is_ghost(t) || complex_.is_locked({t, (i + 1) % 4}) || complex_.is_locked({t, (i + 2) % 4}) ||
          complex_.is_locked({t, (i + 3) % 4})) {
        return false;
      }
      const auto f = complex_.facet_vertices({t, i});
      worker.facets.push_back({vertices_.position(f[0]), vertices_.position(f[1]), vertices_.position(f[2])});
    }
    return true;
  }

  void find_move(VertexId v, Worker& worker, Move& move) const {
    move.there.reset();
    move.around.clear();
    if (!collect_facets(v, worker)) return;
    for (TetId t : worker.star)
      for (VertexId x : complex_.vertices(t)) move.around.push_back(x);
    const Vec3 here = vertices_.position(v);
    const double now = worst_in_star(worker.facets, here);
    if (now >= goal_) return;
    const Vec3 there = worker.optimiser.optimise(worker.facets, here);
    if (worst_in_star(worker.facets, there) > now * (1 + 1e-3) && keeps_positive(worker.facets, there))
      move.there = there;
  }

  static bool keeps_positive(const StarFacets& facets, Vec3 there) {
    return std::all_of(facets.begin(), facets.end(),
                       [&](const auto& f) { return orient3d(f[0], f[1], f[2], there) > 0; });
  }

  /// A needle, a triangle with an angle below the goal, over which no tet is good, keeps the worst tet of a star bad
  /// wherever the vertex is; to make the best of it, smoothing lets the others go. Here they are made up for it.
  void smooth_beside_needles() {
    for (int sweep = 0; sweep < kNeedleSweeps && !stopped_; ++sweep) {
      collect_bad(std::sin(kNeedleGoal * kDegree));
      collect_movable();
      touched_.clear();
      for (std::size_t k = 0; k < movable_.size() && !should_stop(); ++k)
        if (smooth_beside_needles(movable_[k])) touched_.push_back(movable_[k]);
      if (touched_.empty()) return;
      refresh_below();
    }
  }

  bool smooth_beside_needles(VertexId v) {
    if (!collect_facets(v, workers_[0])) return false;
    StarFacets& facets = workers_[0].facets;
    const auto first = std::partition(facets.begin(), facets.end(), [](const auto& f) { return !is_needle(f); });
    const StarFacets others(facets.begin(), first), needles(first, facets.end());
    if (others.empty() || needles.empty()) return false;
    const Vec3 here = vertices_.position(v);
    const double now = worst_in_star(others, here);
    const double least = std::min(worst_in_star(needles, here), std::sin(kLeastOverNeedle * kDegree));
    const std::size_t bad = count_bad(facets, here);
    Vec3 there = workers_[0].optimiser.optimise(others, here);
    for (int halving = 0; halving < 4; ++halving, there = snap(0.5 * (here + there))) {
      if (worst_in_star(others, there) > now * (1 + 1e-3) && worst_in_star(needles, there) >= least &&
          count_bad(facets, there) <= bad && keeps_positive(facets, there)) {
        vertices_.move(v, there);
        ++result_.moves;
        return true;
      }
    }
    return false;
  }

  static std::size_t count_bad(const StarFacets& facets, Vec3 p) {
    return static_cast<std::size_t>(std::count_if(facets.begin(), facets.end(), [&](const auto& f) {
      return least_sine(f[0], f[1], f[2], p) < std::sin(kNeedleGoal * kDegree);
    }));
  }

  static bool is_needle(const std::array<Vec3, 3>& f) {
    return triangle_least_sine(f[0], f[1], f[2]) < std::sin(kNeedleGoal * kDegree);
  }

  std::size_t exchange_locks() {
    if (!options_.facet_allowed) return 0;
    std::size_t changed = 0;
    collect_bad(std::sin(options_.insertion_goal * kDegree));
    touched_.clear();
    for (TetId t : bad_) {
      if (!is_inside(t)) continue;
      const auto v = complex_.vertices(t);
      if (!exchange_lock(mesh_, t, options_.facet_allowed)) continue;
      touched_.insert(touched_.end(), v.begin(), v.end());
      ++changed;
    }
    refresh_below();
    result_.relocks += changed;
    return changed;
  }

  /// The worst tets first.
  std::size_t insert_vertices() {
    const double goal = std::sin(options_.insertion_goal * kDegree);
    collect_bad(goal);
    std::vector<std::pair<double, TetId>> order;
    for (TetId t : bad_) order.emplace_back(quality(t), t);
    std::sort(order.begin(), order.end());
    std::size_t changed = 0, failed = 0;
    touched_.clear();
    for (std::size_t k = 0; k < order.size() && failed < kFailedInsertions + 2 * changed && !should_stop(); ++k) {
      const TetId t = order[k].second;
      if (!is_inside(t) || quality(t) >= goal) continue;
      if (!insertion_.mend(t, quality(t) + kInsertionGain)) {
        ++failed;
        continue;
      }
      touched_.push_back(complex_.vertex(mesh_.last_star().front(), 3));
      ++changed;
    }
    refresh_below();
    result_.inserted += changed;
    return changed;
  }

  Tetrahedralization& mesh_;
  TetComplex& complex_;
  VertexStore& vertices_;
  const ImproveOptions& options_;
  Context& context_;
  VertexInsertion insertion_;
  double goal_;
  bool stopped_ = false;
  std::vector<TetId> below_;    ///< all tets below the goal, ascending, between the steps
  std::vector<TetId> pending_;  ///< that were made, or have a changed neighbour, since they were last worked on
  std::vector<TetId> bad_, star_;
  std::vector<VertexId> touched_, movable_;
  IndexedVector<VertexId, char> is_touched_;
  std::vector<Worker> workers_;
  std::vector<std::optional<Reconnection>> reconnections_;  ///< of a batch
  std::vector<Move> moves_;                                 ///< the same
  IndexedVector<VertexId, std::uint32_t> changed_;          ///< the last batch that changed a tet at the vertex
  std::uint32_t batch_number_ = 0;
  ImproveResult result_;
};

}  // namespace

Result<ImproveResult> improve(Tetrahedralization& mesh, VertexStore& vertices, const ImproveOptions& options,
                              Context& context) {
  return Improvement(mesh, vertices, options, context).run();
}

}  // namespace curvetet
