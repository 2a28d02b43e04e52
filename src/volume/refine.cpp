// Delaunay refinement (Ruppert 1995; Shewchuk 1998) with a size field and a boundary that must not change. Where the
// classical algorithm splits an encroached facet, here the vertex is refused: the surface is as fine as the size field
// wants it already, and a finer one is not wanted. So there is no guarantee next to the boundary, only fewer tets.
//
// A tet is too large if its circumradius is above kRadiusOverSize times the size at its centroid; the factor is
// measured, so that the mean edge is about as long as the size. The worst tets go first, by classes of the ratio
// rather than by an exact order: a class costs the same for any number of tets. Places for the new vertex are tried in
// turn: a place at the wanted distance over the tet's smallest facet (off-centre; Rebay 1993, Ungor 2004), which grows
// well-shaped tets from the boundary inwards; the circumcentre; the middle of the longest edge. Each is reached by a
// walk that does not cross locked facets, and judged on the cavity the vertex would make before anything is changed.
//
// Many tets are worked on at a time, by all threads: places are found while nothing changes; cavities that are disjoint
// and do not touch are chosen in order; their stars are made; what is bad of them is queued in order. Batches follow
// from the mesh alone, so that it does not depend on the number of threads. The tets of a class are put along a
// space-filling curve, cut into stretches, and the first of each stretch make a batch, then the second ones, and so on:
// what comes next is near to what was there before, and in the cache. In a large mesh waiting for memory would
// otherwise be half of the time.
//
// Rejected: inserting a lattice of points at once. It is faster, but leaves a badly graded seam along the boundary, and
// graded fields are the rule. Blocks of space with a thread each, whose seams must be done again. Batches of the worst
// tets as they were queued: most of these are neighbours. Full batches, topped up with the next ones of each stretch:
// one in fourteen was disturbed, in place of one in 170.
#include "volume/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include "base/gather.h"
#include "base/hilbert.h"
#include "base/parallel_sort.h"
#include "base/team.h"
#include "geometry/frame.h"
#include "predicates/predicates.h"
#include "quality/measures.h"

namespace curvetet {

namespace {

/// Circumradius over size above which a tet is too large.
constexpr double kRadiusOverSize = 0.75;
/// Least distance of a new vertex to an old one, over the size.
constexpr double kVertexDistance = 0.6;
/// Least distance of a new vertex to a locked facet, over the size.
constexpr double kFacetDistance = 0.4;
/// Places along the curve at which batches are taken: so few in so many tets that cavities seldom disturb each other,
/// and so few that the surroundings of all stay in the cache. Entries between them, at least, for the first reason.
constexpr std::size_t kTetsPerFront = 1000, kMostFronts = 128, kLeastStretch = 4;
/// Steps of a walk; far above what a walk within one tet's neighbourhood takes.
constexpr int kWalkSteps = 400;

/// Closest point of triangle abc to p, as a squared distance (Ericson, Real-Time Collision Detection, 5.1.5).
double squared_distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return norm2(ap);
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return norm2(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm2(ap - (d1 / (d1 - d3)) * ab);
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return norm2(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm2(ap - (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return norm2(bp - s * (c - b));
  }
  const double sum = va + vb + vc;
  return norm2(ap - (vb / sum) * ab - (vc / sum) * ac);
}

/// A tet as it was when it was queued: slots are recycled, so its vertices are remembered in a hash.
struct Entry {
  TetId tet;
  std::uint32_t stamp = 0;
  std::uint32_t badness = 0;  ///< class
  std::uint32_t place = 0;    ///< along a space-filling curve
};

std::uint32_t stamp_of(const TetComplex::Vertices& v) {
  std::uint32_t h = 0;
  for (VertexId x : v) h = (h ^ (h >> 15)) * 0x9E3779B1U + x.value();
  return h;
}

/// Bad tets in classes of badness, the worst class first.
class BadTets {
 public:
  static constexpr std::size_t kClasses = 64;
  static std::size_t class_of(double badness) {
    const double eighths = 8 * std::log2(std::max(badness, 1.0));
    return static_cast<std::size_t>(std::min(eighths, static_cast<double>(kClasses - 1)));
  }

  void push(const Entry& entry) {
    classes_[entry.badness].push_back(entry);
    top_ = std::max<std::size_t>(top_, entry.badness);
  }

  /// Appends an entry of each of `fronts` stretches of the curve, far apart in space; the next call those after them,
  /// whose surroundings are then in the processor's cache. False: all have been taken. prepare(entries) puts the worst
  /// classes in order, when their turn comes.
  template <class Prepare>
  bool take(std::size_t fronts, const Prepare& prepare, std::vector<Entry>& out) {
    if (column_ == stretch_ && !open_classes(fronts, prepare)) return false;
    for (std::size_t k = column_; k < open_.size(); k += stretch_) out.push_back(open_[k]);
    ++column_;
    return true;
  }

 private:
  template <class Prepare>
  bool open_classes(std::size_t fronts, const Prepare& prepare) {
    open_.clear();
    for (bool is_last = false; !is_last && open_.size() < fronts;) {
      open_.insert(open_.end(), classes_[top_].begin(), classes_[top_].end());
      classes_[top_].clear();
      is_last = top_ == 0;
      if (!is_last) --top_;
      if (is_last || open_.size() >= fronts) prepare(open_);
    }
    if (open_.empty()) return false;
    stretch_ = std::max(kLeastStretch, (open_.size() + fronts - 1) / fronts);
    column_ = 0;
    return true;
  }

  std::array<std::vector<Entry>, kClasses> classes_;
  std::size_t top_ = 0;
  std::vector<Entry> open_;               ///< of the classes that are being taken
  std::size_t stretch_ = 0, column_ = 0;  ///< length of the stretches, entries of each that were taken
};

/// What is wrong with a tet, and what its mending needs.
struct Judgement {
  double badness = 0;         ///< above 1: to be refined
  Vec3 centre;                ///< circumcentre
  double least_distance = 0;  ///< of a new vertex to old ones, where that is smaller than what the size demands
};

/// A bad tet and the place that was found for a vertex.
struct Attempt {
  Entry entry;
  Judgement judgement;
  Vec3 place;
  double size = 0;  ///< at the place
  Insertion insertion;
  bool found = false;
  std::vector<Entry> bad;  ///< of the tets that were made
};

/// What one thread needs for itself.
struct Scratch {
  CavityScratch search;
  kernel::StarBuilder stars;
};

class Refinement {
 public:
  Refinement(Tetrahedralization& mesh, VertexStore& vertices, const SizeField& field, const RefineOptions& options,
             Context& context)
      : mesh_(mesh),
        complex_(mesh.complex()),
        vertices_(vertices),
        field_(field),
        options_(options),
        context_(context),
        has_local_sizes_(field.options().callback || !field.options().solid_size.empty()),
        team_(context),
        scratch_(team_.size()) {}

  Result<RefineResult> run() {
    measure_vertices();
    queue_all();
    while (choose_batch()) {
      if (context_.should_stop()) return context_.stop_error("refinement");
      find_places();
      select_attempts();
      commit_selected();
      settle_selected();
      if (result_.budget_exhausted) break;
    }
    result_.unmet = static_cast<std::size_t>(
        std::count_if(unmet_.begin(), unmet_.end(), [this](const Entry& e) { return is_current(e); }));
    return result_;
  }

 private:
  bool is_current(const Entry& e) const {
    return complex_.is_alive(e.tet) && stamp_of(complex_.vertices(e.tet)) == e.stamp;
  }

  /// Of the worst tets, some that have no vertex in common; others wait for the next batch. False: there are none.
  bool choose_batch() {
    const std::size_t fronts = std::clamp<std::size_t>(complex_.alive() / kTetsPerFront, 1, kMostFronts);
    batch_.clear();
    ++batch_number_;
    in_batch_.resize(vertices_.size(), 0);
    column_.swap(waiting_);
    const auto prepare = [this](std::vector<Entry>& entries) { put_in_order(entries); };
    for (bool more = true; more && batch_.empty();) {
      more = bad_.take(fronts, prepare, column_);
      for (const Entry& e : column_) choose(e);
      column_.clear();
    }
    return !batch_.empty();
  }

  /// Along the curve; those of tets that are gone, which most are, are left out.
  void put_in_order(std::vector<Entry>& entries) {
    constexpr std::size_t kAhead = 16;
    is_there_.resize(entries.size());
    in_parallel(entries.size(), 256, [&](std::size_t k, Scratch&) {
      if (k + kAhead < entries.size()) complex_.prefetch(entries[k + kAhead].tet);
      is_there_[k] = is_current(entries[k]) ? 1 : 0;
    });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (is_there_[k] != 0) entries[kept++] = entries[k];
    entries.resize(kept);
    parallel_sort(context_, entries,
                  [](const Entry& a, const Entry& b) { return std::tie(a.place, a.tet) < std::tie(b.place, b.tet); });
  }

  void choose(const Entry& e) {
    if (!is_current(e)) return;
    const auto& v = complex_.vertices(e.tet);
    if (std::any_of(v.begin(), v.end(), [&](VertexId x) { return in_batch_[x] == batch_number_; })) {
      waiting_.push_back(e);
      return;
    }
    for (VertexId x : v) in_batch_[x] = batch_number_;
    batch_.push_back(e);
  }

  /// body(i, scratch) for i below n, some at a time.
  template <class Body>
  void in_parallel(std::size_t n, std::size_t grain, const Body& body) {
    team_.run(n, grain, [&](std::size_t i, std::size_t worker) { body(i, scratch_[worker]); });
  }

  // --- what is bad ---

  double size_at(Vec3 p, std::uint32_t region) const { return field_.at_solid(SolidId(region - 1), p); }

  void measure_vertices() {
    if (has_local_sizes_) return;
    vertex_size_.resize(vertices_.size());
    in_parallel(vertices_.size(), 256, [&](std::size_t v, Scratch&) {
      if (mesh_.contains(VertexId(v))) vertex_size_[VertexId(v)] = field_.at(vertices_.position(VertexId(v)));
    });
  }

  std::array<Vec3, 4> points(TetId t) const {
    const auto& v = complex_.vertices(t);
    return {vertices_.position(v[0]), vertices_.position(v[1]), vertices_.position(v[2]), vertices_.position(v[3])};
  }

  /// Nearly all tets are good, and this tells so without a root or a look at the field: by the grading, the sizes at
  /// the vertices bound the size at the centroid, which lies within the circumradius of one of them.
  bool is_surely_good(TetId t) const {
    if (has_local_sizes_) return false;
    const auto p = points(t);
    const Vec3 u = p[0] - p[3], v = p[1] - p[3], w = p[2] - p[3], vw = cross(v, w);
    const double u2 = norm2(u), v2 = norm2(v), w2 = norm2(w), twelve_volumes = 2 * dot(u, vw);
    const double reach2 = norm2(u2 * vw + v2 * cross(w, u) + w2 * cross(u, v));  // circumradius * twelve volumes
    const double volumes2 = twelve_volumes * twelve_volumes;
    const double shortest2 = std::min({u2, v2, w2, norm2(p[1] - p[0]), norm2(p[2] - p[1]), norm2(p[0] - p[2])});
    double least = std::numeric_limits<double>::infinity();
    for (VertexId x : complex_.vertices(t)) least = std::min(least, vertex_size_[x]);
    const double largest = kRadiusOverSize * least / (1 + kRadiusOverSize * field_.options().grading);
    return reach2 <= std::min(options_.radius_edge * options_.radius_edge * shortest2, largest * largest) * volumes2;
  }

  /// The size at a tet's centroid, or where it is clear without whether the radius is too large, about that size: by
  /// the grading, the sizes at the corners bound it.
  double size_to_judge_by(TetId t, const std::array<Vec3, 4>& p, double radius) const {
    const Vec3 centroid = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    if (has_local_sizes_) return size_at(centroid, complex_.region(t));
    double low = 0, high = std::numeric_limits<double>::infinity(), sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double size = vertex_size_[complex_.vertices(t)[i]];
      const double change = field_.options().grading * distance(p[i], centroid);
      low = std::max(low, size - change);
      high = std::min(high, size + change);
      sum += size;
    }
    const bool is_clear = radius <= kRadiusOverSize * low || radius > kRadiusOverSize * high;
    return is_clear ? std::min(std::max(0.25 * sum, low), high) : size_at(centroid, complex_.region(t));
  }

  Judgement judge(TetId t) const {
    const auto p = points(t);
    Judgement j;
    j.centre = circumcentre(p[0], p[1], p[2], p[3]);
    const double radius = finite(j.centre) ? distance(j.centre, p[0]) : 1e9;
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : kEdge) {
      shortest = std::min(shortest, norm2(p[static_cast<std::size_t>(a)] - p[static_cast<std::size_t>(b)]));
    }
    shortest = std::sqrt(shortest);
    const double shape = radius / (options_.radius_edge * shortest);
    const double too_large = radius / (kRadiusOverSize * size_to_judge_by(t, p, radius));
    j.badness = std::max(shape, too_large);
    j.least_distance = too_large > 1 ? std::numeric_limits<double>::infinity() : shortest;
    return j;
  }

  /// Adds the tet if it is bad.
  void note_if_bad(TetId t, std::vector<Entry>& bad) const {
    if (is_surely_good(t)) return;
    const double badness = judge(t).badness;
    if (badness <= 1) return;
    const TetComplex::Vertices& v = complex_.vertices(t);
    bad.push_back({t, stamp_of(v), static_cast<std::uint32_t>(BadTets::class_of(badness)), place_of(v[0])});
  }

  std::uint32_t place_of(VertexId v) const {
    constexpr int kBits = 10;
    const auto cell = [](double x) { return static_cast<std::uint32_t>((x + 1) * (1 << (kBits - 1))); };
    const Vec3 p = vertices_.position(v);
    return static_cast<std::uint32_t>(hilbert_index({cell(p.x), cell(p.y), cell(p.z)}, kBits));
  }

  void queue_all() {
    const auto bad = gather<Entry>(context_, complex_.slots(), 1024, [&](std::size_t k, std::vector<Entry>& out) {
      const TetId t(k);
      if (complex_.is_alive(t) && complex_.region(t) != 0 && !complex_.is_ghost(t)) note_if_bad(t, out);
    });
    for (const Entry& e : bad) bad_.push(e);
  }

  // --- places for vertices: nothing is changed ---

  /// For all of the batch, as the mesh is now.
  void find_places() {
    if (attempts_.size() < batch_.size()) attempts_.resize(batch_.size());
    in_parallel(batch_.size(), 2, [&](std::size_t k, Scratch& scratch) {
      Attempt& attempt = attempts_[k];
      attempt.entry = batch_[k];
      attempt.judgement = judge(attempt.entry.tet);
      attempt.found = find_place(attempt, scratch);
    });
  }

  bool find_place(Attempt& attempt, Scratch& scratch) const {
    const Judgement& j = attempt.judgement;
    const auto off = off_centre(attempt.entry.tet, j);
    return (off && is_place(*off, attempt, scratch)) || (finite(j.centre) && is_place(j.centre, attempt, scratch)) ||
           is_place(middle_of_longest_edge(attempt.entry.tet), attempt, scratch);
  }

  /// The point over the smallest facet, towards the circumcentre, at the distance of one size from the facet's
  /// vertices; nothing if the circumcentre is not much farther.
  std::optional<Vec3> off_centre(TetId t, const Judgement& j) const {
    if (!finite(j.centre)) return std::nullopt;
    const auto p = points(t);
    double best = std::numeric_limits<double>::infinity();
    Vec3 foot;
    for (const auto& f : kFacet) {
      const Vec3 a = p[static_cast<std::size_t>(f[0])];
      const Vec3 c = equatorial_centre(a, p[static_cast<std::size_t>(f[1])], p[static_cast<std::size_t>(f[2])]);
      const double r = distance(a, c);
      if (r < best) best = r, foot = c;
    }
    if (!finite(foot)) return std::nullopt;
    const double size = size_at(foot, complex_.region(t));
    const double height = std::sqrt(std::max(size * size - best * best, 0.36 * size * size));
    const double far = distance(foot, j.centre);
    if (far < 1.2 * height) return std::nullopt;
    return foot + (height / far) * (j.centre - foot);
  }

  Vec3 middle_of_longest_edge(TetId t) const {
    double longest = 0;
    Vec3 middle;
    for (const auto& [a, b] : kEdge) {
      const Vec3 p = vertices_.position(complex_.vertex(t, a)), q = vertices_.position(complex_.vertex(t, b));
      if (distance(p, q) > longest) longest = distance(p, q), middle = 0.5 * (p + q);
    }
    return middle;
  }

  /// Walks from t to p without crossing locked facets; nothing if p cannot be reached so.
  std::optional<TetId> walk(TetId t, Vec3 p) const {
    TetId from;
    for (int step = 0; step < kWalkSteps; ++step) {
      bool blocked = false;
      TetId next;
      for (int k = 0; k < 4 && !next.valid(); ++k) {
        const int i = (k + step) % 4;
        const TetId n = complex_.neighbour(t, i);
        if (n == from) continue;
        const auto f = complex_.facet_vertices({t, i});
        if (orient3d(vertices_.position(f[0]), vertices_.position(f[1]), vertices_.position(f[2]), p) >= 0) continue;
        if (complex_.is_locked({t, i}) || complex_.is_ghost(n)) {
          blocked = true;
        } else {
          next = n;
        }
      }
      if (!next.valid()) return blocked ? std::nullopt : std::optional(t);
      from = t;
      t = next;
    }
    return std::nullopt;
  }

  /// Whether a vertex may go there; if so the attempt knows all that inserting it takes.
  bool is_place(Vec3 place, Attempt& attempt, Scratch& scratch) const {
    const Vec3 p = snap(place);
    if (!(std::abs(p.x) < 1 && std::abs(p.y) < 1 && std::abs(p.z) < 1)) return false;
    const auto at = walk(attempt.entry.tet, p);
    if (!at) return false;
    const double size = size_at(p, complex_.region(*at));
    const double apart = std::min(kVertexDistance * size, attempt.judgement.least_distance);
    if (is_close_to_corner(p, *at, apart)) return false;
    attempt.place = p;
    attempt.size = size;
    Cavity& cavity = attempt.insertion.cavity;
    mesh_.find_cavity_at(p, *at, scratch.search, cavity);
    if (!cavity.ok() || !is_legal(cavity, p, size, apart)) return false;
    mesh_.note_walls(attempt.insertion);
    return true;
  }

  bool is_close_to_corner(Vec3 p, TetId t, double apart) const {
    const auto corners = points(t);
    return std::any_of(corners.begin(), corners.end(), [&](Vec3 c) { return norm2(p - c) < apart * apart; });
  }

  bool is_legal(const Cavity& cavity, Vec3 p, double size, double apart) const {
    const std::uint32_t region = complex_.region(cavity.tets[0]);
    for (TetId t : cavity.tets) {
      if (complex_.is_ghost(t) || complex_.region(t) != region) return false;
    }
    for (const TetFacet& f : cavity.boundary) {
      const auto v = complex_.facet_vertices(f);
      const Vec3 a = vertices_.position(v[0]), b = vertices_.position(v[1]), c = vertices_.position(v[2]);
      if (std::min({norm2(p - a), norm2(p - b), norm2(p - c)}) < apart * apart) return false;
      if (!complex_.is_locked(f)) continue;
      const Vec3 centre = equatorial_centre(a, b, c);
      if (norm2(p - centre) < norm2(a - centre)) return false;
      if (squared_distance(p, a, b, c) < kFacetDistance * kFacetDistance * size * size) return false;
    }
    return true;
  }

  // --- insertion ---

  /// In order; what one before it disturbs is queued again.
  void select_attempts() {
    selected_.clear();
    complex_.start_flood();
    for (std::size_t k = 0; k < batch_.size() && !result_.budget_exhausted; ++k) {
      Attempt& attempt = attempts_[k];
      if (!attempt.found) {
        unmet_.push_back(attempt.entry);
      } else if (is_disturbed(attempt.insertion.cavity)) {
        bad_.push(attempt.entry);
      } else if (result_.inserted >= options_.max_points) {
        result_.budget_exhausted = true;
      } else {
        select(attempt);
      }
    }
  }

  /// Whether a tet of the cavity, or one beside it, is in another one of the batch.
  bool is_disturbed(const Cavity& cavity) const {
    const auto goes = [this](TetId t) { return complex_.tets()[t.value()].stamp == goes_stamp(); };
    return std::any_of(cavity.tets.begin(), cavity.tets.end(), goes) ||
           std::any_of(cavity.boundary.begin(), cavity.boundary.end(),
                       [&](const TetFacet& f) { return goes(complex_.neighbour(f.tet, f.local)); });
  }

  /// Of a tet in a cavity of the batch.
  std::uint32_t goes_stamp() const { return complex_.flood() + 1; }

  void select(Attempt& attempt) {
    const std::uint32_t region = complex_.region(attempt.insertion.cavity.tets[0]);
    const VertexId v = vertices_.add(attempt.place, Owner::of(SolidId(region - 1)), {}, Origin::interior);
    if (!has_local_sizes_) vertex_size_.push_back(attempt.size);
    mesh_.reserve(attempt.insertion, v);
    for (TetId t : attempt.insertion.cavity.tets) complex_.tets()[t.value()].stamp = goes_stamp();
    selected_.push_back(&attempt);
    ++result_.inserted;
  }

  void commit_selected() {
    in_parallel(selected_.size(), 2, [&](std::size_t k, Scratch& scratch) {
      Attempt& attempt = *selected_[k];
      mesh_.commit(attempt.insertion, scratch.stars);
      attempt.bad.clear();
      for (std::size_t i = 0; i < attempt.insertion.walls.size(); ++i)
        note_if_bad(attempt.insertion.slots[i], attempt.bad);
    });
  }

  void settle_selected() {
    for (Attempt* attempt : selected_) {
      mesh_.settle(attempt->insertion);
      for (const Entry& e : attempt->bad) bad_.push(e);
    }
  }

  Tetrahedralization& mesh_;
  TetComplex& complex_;
  VertexStore& vertices_;
  const SizeField& field_;
  const RefineOptions& options_;
  Context& context_;
  bool has_local_sizes_;  ///< that do not follow the grading
  Team team_;
  std::vector<Scratch> scratch_;  ///< by worker
  IndexedVector<VertexId, double> vertex_size_;
  BadTets bad_;
  std::vector<Entry> batch_, waiting_, unmet_, column_;
  std::vector<char> is_there_;                       ///< of the entries that are put in order
  IndexedVector<VertexId, std::uint32_t> in_batch_;  ///< the last batch with a tet at the vertex
  std::vector<Attempt> attempts_;                    ///< of the batch, in its order
  std::vector<Attempt*> selected_;
  std::uint32_t batch_number_ = 0;
  RefineResult result_;
};

}  // namespace

Result<RefineResult> refine_interior(Tetrahedralization& mesh, VertexStore& vertices, const SizeField& field,
                                     const RefineOptions& options, Context& context) {
  const VertexId first(vertices.size());
  // Its lists are gone before the sorting needs memory.
  Result<RefineResult> result = Refinement(mesh, vertices, field, options, context).run();
  if (result.ok()) {
    mesh.sort_in_space(vertices, first, context);
  } else {
    mesh.link_vertices();
  }
  return result;
}

}  // namespace curvetet
