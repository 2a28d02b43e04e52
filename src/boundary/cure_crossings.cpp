// Of two triangles that cross, the one farther from its face is refined: a flat facet on a flat face is never the
// culprit. Two facets of one sheet that lie on it and cross all the same are thinned out instead. Where facets pass
// through each other by more than they leave their faces, round after round, the faces themselves cross and no size
// helps. That crossings become more says nothing: those of a very thin wall do so for many rounds before they become
// fewer.
//
// Rejected: emptying equatorial spheres of all foreign vertices (the paper's rule), which on a thin shell asks for
// elements as small as the wall is thin though no triangle crosses another.
#include "boundary/cure_crossings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "boundary/criteria.h"

namespace curvetet {

namespace {

// Of a triangle that is not there any more.
constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();

constexpr std::size_t kPointsPerPair = 8;
// More crossings than this are no thin wall but a surface mesh gone wrong.
constexpr std::size_t kPairsPerTriangle = 4;

// The surface near a facet is looked at where the mean normal is off by more than 26 degrees, or the facet by this
// share of its longest edge.
constexpr double kStraight = 0.9;
constexpr double kFar = 0.05;

// A facet lies on its face where it is nearer than this share of its longest edge, and the surface below is flat: the
// normals of the corners' places are within 60 degrees of that below its middle. A coarse facet along a thin ring is as
// near to it. Where points have not made crossings and folds fewer for some rounds, bent surfaces are thinned, too.
constexpr double kOnFace = 0.1;
constexpr double kFlat = 0.5;
constexpr int kStalled = 3;

// Of what two facets leave their faces in their middles: more than they leave them anywhere. Where that is wrong all
// the same, as on a facet over half a wave, the next rounds show it.
constexpr double kHeights = 4;
constexpr int kRoundsThrough = 6;

// Folds that are reported, evenly spread over the list.
constexpr std::size_t kMostFolds = 200;
// Of a folded facet's longest edge, that the outer loop is asked for.
constexpr double kLeastShare = 0.05;

// A facet or segment that is no farther lies on its face or curve.
constexpr double kFlush = 8 * kGrid;

Vec3 centroid(const VertexStore& vertices, const SurfaceTriangle& t) {
  Vec3 sum;
  for (const VertexId v : t.vertices) sum = sum + vertices.position(v);
  return (1.0 / 3) * sum;
}

class CrossingCure {
 public:
  CrossingCure(Conjoint& conjoint, const CrossingOptions& options, Context& context)
      : conjoint_(conjoint), options_(options), context_(context) {
    refinement_.floor = options.floor;
    refinement_.origin = Origin::stage_one;
  }

  Result<CrossingResult> run() {
    for (result_.rounds = 0; result_.rounds <= options_.rounds; ++result_.rounds) {
      if (context_.should_stop()) return context_.stop_error("surface crossings");
      find_faults();
      if (result_.rounds == 0) {
        result_.first_pairs = pairs_.size();
        result_.first_folds = folds_.size();
        budget_ = budget();
      }
      context_.log(LogLevel::debug, fmt::format("crossings, round {}: {} pairs of {} triangles", result_.rounds,
                                                pairs_.size(), triangles_.size()));
      if (pairs_.empty() && folds_.empty()) return result_;
      count_stalled(pairs_.size() + folds_.size());
      deviations_.assign(triangles_.size(), std::nullopt);
      const bool any_through =
          std::any_of(pairs_.begin(), pairs_.end(), [this](const TrianglePair& p) { return through(p); });
      rounds_through_ = any_through ? rounds_through_ + 1 : 0;
      const bool hopeless = faces_cross() || result_.rounds == options_.rounds ||
                            static_cast<double>(result_.points) > budget_ ||
                            pairs_.size() >= kPairsPerTriangle * triangles_.size();
      const bool progress = !hopeless && (thin_out() || (refine() | unfold()));
      if (!progress) {
        report_all();
        return result_;
      }
    }
    return result_;
  }

 private:
  /// Lists the triangles anew with what crosses or is folded, which is looked for among those alone that were not there
  /// in the last round.
  void find_faults() {
    const std::vector<SurfaceTriangle> before = std::move(triangles_);
    triangles_ = surface_triangles(conjoint_.boundary());
    std::vector<char> is_fresh(triangles_.size(), 1);
    const std::vector<std::uint32_t> place = places_of(before);
    for (const std::uint32_t i : place)
      if (i != kGone) is_fresh[i] = 0;
    std::vector<TrianglePair> pairs =
        crossing_pairs(conjoint_.vertices(), triangles_, is_fresh, kPairsPerTriangle * triangles_.size(), context_);
    for (const auto& [i, j] : pairs_)
      if (place[i] != kGone && place[j] != kGone) pairs.emplace_back(place[i], place[j]);
    std::sort(pairs.begin(), pairs.end());
    pairs_ = std::move(pairs);
    std::vector<std::uint32_t> folds;
    for (const std::uint32_t i : folds_)
      if (place[i] != kGone) folds.push_back(place[i]);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
      if (is_fresh[i] != 0 && is_fold(triangles_[i])) folds.push_back(i);
    std::sort(folds.begin(), folds.end());
    folds_ = std::move(folds);
  }

  /// Where each triangle of a former list is in the present one. Both are in the order of faces and slots.
  std::vector<std::uint32_t> places_of(const std::vector<SurfaceTriangle>& before) const {
    std::vector<std::uint32_t> place(before.size(), kGone);
    const auto key = [](const SurfaceTriangle& t) { return std::pair(t.face, t.triangle); };
    std::uint32_t i = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      while (i < triangles_.size() && key(triangles_[i]) < key(before[k])) ++i;
      const bool is_same =
          i < triangles_.size() && key(triangles_[i]) == key(before[k]) && triangles_[i].vertices == before[k].vertices;
      if (is_same) place[k] = i;
    }
    return place;
  }

  bool is_fold(const SurfaceTriangle& t) const {
    double cosine = facing(conjoint_, t.face, t.triangle);
    if (cosine < kStraight ||
        deviation(conjoint_, t.face, t.triangle) > kFar * longest_edge(conjoint_.vertices(), t.vertices))
      cosine = std::min(
          cosine, facing_at_foot(conjoint_, t.face, conjoint_.boundary().faces[t.face].triangle(t.triangle).node));
    return cosine < kFolded;
  }

  /// A legal cure of a thin wall may need many times the points of the first mesh: as many as triangles of the floor's
  /// spacing cover what crosses. Slivers have no area, so that some points per pair and triangle are granted, too.
  double budget() const {
    std::set<std::uint32_t> crossing;
    for (const auto& [i, j] : pairs_) crossing.insert({i, j});
    double area = 0;
    for (std::uint32_t i : crossing) {
      const auto at = [&](std::size_t k) { return conjoint_.vertices().position(triangles_[i].vertices[k]); };
      area += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    }
    return area / (options_.floor * options_.floor) +
           static_cast<double>(kPointsPerPair * pairs_.size() + triangles_.size());
  }

  bool still_there(const SurfaceTriangle& t) const {
    const FaceMesh& mesh = conjoint_.boundary().faces[t.face];
    return mesh.triangle(t.triangle).alive() && mesh.vertices(t.triangle) == t.vertices;
  }

  void count_stalled(std::size_t left) {
    stalled_ = left < fewest_ ? 0 : stalled_ + 1;
    fewest_ = std::min(fewest_, left);
  }

  /// Do two facets go through each other by more than they leave their faces?
  bool through(const TrianglePair& pair) {
    const auto [i, j] = pair;
    const double height = kHeights * (deviation_of(i) + deviation_of(j)) + 8 * kGrid;
    return passes_through(i, j, height) || passes_through(j, i, height);
  }

  bool faces_cross() const { return rounds_through_ >= kRoundsThrough; }

  /// Does an edge of facet i go through facet j, from farther than `height` on the one side to farther on the other,
  /// and within j's outline all that way?
  bool passes_through(std::uint32_t i, std::uint32_t j, double height) const {
    const auto at = [&](std::uint32_t t, std::size_t k) {
      return conjoint_.vertices().position(triangles_[t].vertices[k % 3]);
    };
    const Vec3 normal = normalized(cross(at(j, 1) - at(j, 0), at(j, 2) - at(j, 0)));
    const auto is_within = [&](Vec3 p) {
      for (std::size_t k = 0; k < 3; ++k)
        if (dot(cross(at(j, k + 1) - at(j, k), p - at(j, k)), normal) < 0) return false;
      return true;
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = at(i, k), q = at(i, k + 1);
      const double from = dot(p - at(j, 0), normal), to = dot(q - at(j, 0), normal);
      if (from * to >= 0 || std::min(std::abs(from), std::abs(to)) < height) continue;
      const auto where = [&](double away) { return p + ((from - away) / (from - to)) * (q - p); };
      if (is_within(where(height)) && is_within(where(-height))) return true;
    }
    return false;
  }

  /// How a triangle lies on its face, if it does.
  struct Lying {
    bool on_face = false;
    Vec3 normal;  ///< of the surface below
  };

  Lying lying(const SurfaceTriangle& t) const {
    const FaceMesh& mesh = conjoint_.boundary().faces[t.face];
    const std::array<NodeId, 3>& nodes = mesh.triangle(t.triangle).node;
    const auto foot = foot_of(conjoint_, t.face, nodes);
    if (!foot || foot->distance >= kOnFace * longest_edge(conjoint_.vertices(), t.vertices)) return {};
    const Surface& surface = *conjoint_.model().faces[t.face].surface;
    const Vec3 below = surface.normal(foot->uv);
    const bool flat = stalled_ >= kStalled || std::all_of(nodes.begin(), nodes.end(), [&](NodeId n) {
                        return dot(below, surface.normal(mesh.chart.to_uv(mesh.node(n).q))) > kFlat;
                      });
    return {flat, below};
  }

  /// Takes out nodes where a face overlaps itself in one sheet: facets that lie on it already do so because its
  /// parameters are sheared, and more points would only make more such facets.
  bool thin_out() {
    std::map<std::uint32_t, Lying> known;
    const auto lying_of = [&](std::uint32_t i) {
      const auto [at, is_new] = known.try_emplace(i);
      if (is_new) at->second = lying(triangles_[i]);
      return at->second;
    };
    bool any = false;
    for (const auto& [i, j] : pairs_) {
      const SurfaceTriangle &a = triangles_[i], &b = triangles_[j];
      if (a.face != b.face || !still_there(a) || !still_there(b)) continue;
      const Lying one = lying_of(i), two = lying_of(j);
      if (!one.on_face || !two.on_face || dot(one.normal, two.normal) <= 0) continue;
      for (const SurfaceTriangle* t : {&a, &b}) any |= remove_nodes(*t);
    }
    for (const std::uint32_t i : folds_)
      if (still_there(triangles_[i]) && lying_of(i).on_face) any |= remove_nodes(triangles_[i]);
    return any;
  }

  /// Those of the first surface mesh, so that this ends.
  bool remove_nodes(const SurfaceTriangle& t) {
    FaceMesh& mesh = conjoint_.boundary().faces[t.face];
    std::vector<TriangleId> changed;
    bool any = false;
    for (const VertexId v : t.vertices) {
      if (conjoint_.vertices().origin(v) != Origin::face_mesh) continue;
      for (const NodeId n : mesh.nodes_of(v)) any |= mesh.remove_node(n, conjoint_.criterion(t.face), changed);
    }
    return any;
  }

  bool refine() {
    bool any = false;
    for (const auto& [i, j] : pairs_) {
      if (context_.should_stop()) return any;
      const SurfaceTriangle &a = triangles_[i], &b = triangles_[j];
      if (!still_there(a) || !still_there(b)) continue;
      const double da = deviation_of(i), db = deviation_of(j);
      const bool a_first = da >= db;
      if (refine_one(a_first ? a : b, std::max(da, db)) || refine_one(a_first ? b : a, std::min(da, db))) any = true;
    }
    return any;
  }

  bool unfold() {
    bool any = false;
    for (std::uint32_t i : folds_) {
      const SurfaceTriangle& t = triangles_[i];
      if (!still_there(t)) continue;
      any |= split_chord(t, deviation_of(i)) || refine_facet(t);
    }
    return any;
  }

  /// Of a triangle, or a segment of it, from its face or curve; asked for again and again, but measured once a round.
  double deviation_of(std::uint32_t i) {
    if (!deviations_[i]) deviations_[i] = measure_deviation(triangles_[i]);
    return *deviations_[i];
  }

  double measure_deviation(const SurfaceTriangle& t) const {
    double largest = deviation(conjoint_, t.face, t.triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const EdgeId edge = conjoint_.segment_edge(t.vertices[k], t.vertices[(k + 1) % 3]);
      if (edge.valid())
        largest = std::max(largest, segment_deviation(conjoint_, edge, t.vertices[k], t.vertices[(k + 1) % 3]));
    }
    return largest;
  }

  bool refine_one(const SurfaceTriangle& t, double dev) {
    return dev > kFlush && (split_chord(t, dev) || refine_facet(t));
  }

  // A segment that leaves its curve about as far as the triangle leaves its face is split first: a point inside the
  // triangle would not move the chord.
  bool split_chord(const SurfaceTriangle& t, double dev) {
    double worst = std::max(0.5 * dev, kFlush);
    std::size_t at = 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t.vertices[k], b = t.vertices[(k + 1) % 3];
      const EdgeId edge = conjoint_.segment_edge(a, b);
      if (!edge.valid()) continue;
      const double d = segment_deviation(conjoint_, edge, a, b);
      if (d > worst) {
        worst = d;
        at = k;
      }
    }
    if (at == 3) return false;
    const VertexId a = t.vertices[at], b = t.vertices[(at + 1) % 3];
    return count(refine_segment(conjoint_, conjoint_.segment_edge(a, b), a, b, refinement_));
  }

  bool refine_facet(const SurfaceTriangle& t) {
    return count(refine_triangle(conjoint_, t.face, t.triangle, refinement_));
  }

  bool count(const ConjointResult& done) {
    if (done.ok()) ++result_.points;
    return done.ok();
  }

  /// Where faces cross, that is the failure, whatever else is left.
  void report_all() {
    for (const TrianglePair& pair : pairs_)
      if (!faces_cross() || through(pair)) report(pair.first, pair.second);
    if (faces_cross()) return;
    std::vector<SurfaceTriangle> folded;
    for (const std::uint32_t i : folds_) folded.push_back(triangles_[i]);
    for (RecoveryFailure& failure : fold_failures(conjoint_, folded)) result_.failures.push_back(std::move(failure));
  }

  void report(std::uint32_t i, std::uint32_t j) {
    const SurfaceTriangle &a = triangles_[i], &b = triangles_[j];
    if (!reported_.insert({std::min(a.face, b.face), std::max(a.face, b.face)}).second) return;
    RecoveryFailure failure;
    failure.faces = {a.face, b.face};
    failure.where = centroid(conjoint_.vertices(), a);
    failure.crossing = true;
    failure.size = faces_cross() ? 0 : 0.5 * shortest_edge(a);
    failure.proved = deviation_of(i) <= kFlush && deviation_of(j) <= kFlush;
    failure.what = failure.proved ? "flat facets that lie on their faces cross: the body crosses itself"
                                  : "facets of the surface mesh cross";
    result_.failures.push_back(failure);
  }

  double shortest_edge(const SurfaceTriangle& t) const {
    double shortest = 1;
    for (std::size_t k = 0; k < 3; ++k)
      shortest = std::min(shortest, distance(conjoint_.vertices().position(t.vertices[k]),
                                             conjoint_.vertices().position(t.vertices[(k + 1) % 3])));
    return shortest;
  }

  Conjoint& conjoint_;
  const CrossingOptions& options_;
  Context& context_;
  SurfaceRefinement refinement_;
  CrossingResult result_;
  double budget_ = 0;
  std::size_t fewest_ = std::numeric_limits<std::size_t>::max();  ///< crossings and folds of a round
  int stalled_ = 0;                                               ///< rounds since then
  int rounds_through_ = 0;  ///< running, in which facets passed through each other
  std::vector<SurfaceTriangle> triangles_;
  std::vector<TrianglePair> pairs_;                ///< that cross; of the last round
  std::vector<std::uint32_t> folds_;               ///< of the last round
  std::vector<std::optional<double>> deviations_;  ///< by triangle
  std::set<std::pair<FaceId, FaceId>> reported_;
};

}  // namespace

std::vector<RecoveryFailure> fold_failures(const Conjoint& conjoint, const std::vector<SurfaceTriangle>& folded) {
  const auto size_of = [&](const SurfaceTriangle& t) {
    const Bend bend =
        bend_below(conjoint.boundary().faces[t.face], t.triangle, *conjoint.model().faces[t.face].surface);
    const double longest = longest_edge(conjoint.vertices(), t.vertices);
    return std::clamp(bend.radius, kLeastShare * longest, 0.5 * longest);
  };
  std::vector<RecoveryFailure> failures;
  const std::size_t count = std::min(folded.size(), kMostFolds);
  for (std::size_t k = 0; k < count; ++k) {
    const SurfaceTriangle& t = folded[k * folded.size() / count];
    failures.push_back({{t.face},
                        centroid(conjoint.vertices(), t),
                        size_of(t),
                        "a facet of the surface mesh is folded against its face"});
  }
  return failures;
}

Result<CrossingResult> cure_crossings(Conjoint& conjoint, const CrossingOptions& options, Context& context) {
  return CrossingCure(conjoint, options, context).run();
}

}  // namespace curvetet
