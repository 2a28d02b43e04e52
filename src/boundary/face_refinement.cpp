// Delaunay refinement on a surface (Chew, "Guaranteed-quality mesh generation for curved surfaces", 1993) with the size
// field in place of the circumradius bound, as a front (Rebay, "Efficient unstructured mesh generation by means of
// Delaunay triangulation and Bowyer-Watson algorithm", 1993): of the triangles that are too large those go first that
// lie beside what is finished, and the new point makes an equilateral triangle over the edge between. Points at centres
// of balls alone give valid meshes, too, but triangles that are less so: 0.91 instead of 0.98 to 0.99 on average, as
// twice the inner over the outer radius.
//
// All corners (position, derivatives, normal, size) are kept in flat arrays by node, so that the surface is evaluated
// for new points only. Splitting a curve because a point encroaches it, as Ruppert does, was rejected here: curves
// follow the size field already, and a point that is refused leaves a triangle at most a little too large.

#include "boundary/face_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "boundary/criteria.h"
#include "boundary/face_smoothing.h"

namespace curvetet {

namespace {

constexpr double kRadius = 0.72;        ///< largest circumradius over size
constexpr double kSpacing = 0.5;        ///< least distance of a new point to others over size
constexpr double kSpacingFloor = 0.02;  ///< the same for points that cure a fold
constexpr double kBentFloor = 0.05;     ///< least distance of points that cure bent edges, over size and usual segment
constexpr double kReachFloor = 2e-3;    ///< least distance that geometry can force points to, over size
constexpr double kSineSmallAngle = 0.342;  ///< of 20 degrees
constexpr double kLongEdge = 1.4;          ///< an edge over size that is split when no centre can be inserted
constexpr double kEncroachHeight = 0.45;   ///< distance over size within which a diametral sphere counts
constexpr std::size_t kLargestCavity = 64;
constexpr int kLastRounds = 4;
constexpr double kLeastHeight = 0.6;  ///< of a new triangle over the front, over size
constexpr double kNoFarther = 1.02;   ///< a centre's distance over that height up to which it is as good
constexpr double kOffHeight = 0.05;   ///< of a point at the front, over the height, that asks for another try
constexpr double kWraps = 1.1;        ///< an arc over its chord, just below that of a quarter turn
constexpr double kWideFan = 1.75;     ///< angle around a pole, 100 degrees, over which a triangle there is split

enum class Need : std::uint8_t { none, shape, fan, fold, size, bend };

struct Verdict {
  Need need = Need::none;
  double worth = 0;  ///< larger is worse
};

/// What is known of a triangle slot.
struct Progress {
  enum class State : std::uint8_t { finished, waits, queued } state = State::finished;
  std::uint32_t stamp = 0;  ///< entries with an older one are stale
  double worth = 0;
};

struct Entry {
  double worth;
  std::uint32_t triangle, stamp;
  friend bool operator<(const Entry& a, const Entry& b) {
    if (a.worth != b.worth) return a.worth < b.worth;
    if (a.triangle != b.triangle) return a.triangle > b.triangle;
    return a.stamp > b.stamp;
  }
};

class FaceRefiner {
 public:
  FaceRefiner(FaceMesh& mesh, FaceId face, const Surface& surface, const SizeField& sizes, const VertexStore& vertices)
      : mesh_(mesh), face_(face), surface_(surface), sizes_(sizes) {
    for (std::size_t n = 0; n < mesh.node_count(); ++n) {
      const FaceNode& node = mesh.node(NodeId(n));
      const Vec3 position = vertices.position(node.vertex);
      corners_.push_back(make_corner(node, position, surface.first(mesh.chart.to_uv(node.q)), mesh.chart));
      size_at_.push_back(sizes.at_face(face, position));
    }
    measure_segments();
    wanted_ = [this](NodeId a, NodeId b, NodeId c, NodeId d) {
      return flip_improves(corner(a), corner(b), corner(c), corner(d), order_, on());
    };
  }

  /// To be called first, if at all: triangles get their size while they are judged on the surface alone.
  void begin_on_surface(const Context& context) {
    order_ = FlipOrder::on_surface;
    enqueue(alive());
    empty_queue(context);
    order_ = FlipOrder::bends_first;
  }

  std::vector<AddedVertex> run(bool smooth, const Context& context) {
    mesh_.restore(wanted_, changed_);
    enqueue(alive());
    empty_queue(context);
    // Flips that the chart forbade while triangles were large have become legal meanwhile.
    order_ = FlipOrder::upright_first;
    for (int round = 0; round < kLastRounds && !context.should_stop(); ++round) {
      mesh_.restore(wanted_, changed_);
      if (changed_.empty()) break;
      enqueue(changed_);
      empty_queue(context);
    }
    if (smooth) move_nodes(context);
    return std::move(added_);
  }

  /// Whether some edge wraps around the surface, so that its ends are closer in space than on it.
  bool wraps() const {
    for (const TriangleId id : alive()) {
      const FaceTriangle& t = mesh_.triangle(id);
      for (std::size_t i = 0; i < 3; ++i) {
        const Corner &a = corner(t.node[(i + 1) % 3]), &b = corner(t.node[(i + 2) % 3]);
        if (t.use[i] == -1 && arc_estimate(a, b) > kWraps * distance(a.position, b.position)) return true;
      }
    }
    return false;
  }

  /// Triangles that stand on the surface or lie on it upside down.
  std::size_t count_folds() const {
    std::size_t folds = 0;
    for (const TriangleId id : alive()) {
      const FaceTriangle& t = mesh_.triangle(id);
      const Corner &a = corner(t.node[0]), &b = corner(t.node[1]), &c = corner(t.node[2]);
      if (!degenerate(a, b, c) && alignment(a, b, c, on()) < kFolded) ++folds;
    }
    return folds;
  }

 private:
  /// The median length of the segments on the face's boundary: on a thin wire far below the size.
  void measure_segments() {
    std::vector<double> lengths;
    for (std::size_t k = 0; k < mesh_.triangle_slots(); ++k) {
      const FaceTriangle& t = mesh_.triangle(TriangleId(k));
      for (std::size_t i = 0; t.alive() && i < 3; ++i) {
        if (t.use[i] == -1) continue;
        const Corner &a = corner(t.node[(i + 1) % 3]), &b = corner(t.node[(i + 2) % 3]);
        if (a.vertex != b.vertex) lengths.push_back(distance(a.position, b.position));
      }
    }
    if (lengths.empty()) return;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    usual_segment_ = *middle;
  }

  void move_nodes(const Context& context) {
    const std::size_t first = corners_.size() - added_.size();
    smooth_face(mesh_, NodeId(first), corners_, on(), wanted_, context);
    for (std::size_t k = 0; k < added_.size(); ++k)
      added_[k] = {corners_[first + k].position, mesh_.chart.to_uv(corners_[first + k].q)};
  }

  const Corner& corner(NodeId n) const { return corners_[n.value()]; }
  ChartSurface on() const { return {surface_, mesh_.chart, mesh_.has_tip()}; }

  std::vector<TriangleId> alive() const {
    std::vector<TriangleId> all;
    for (std::size_t t = 0; t < mesh_.triangle_slots(); ++t) {
      if (mesh_.triangle(TriangleId(t)).alive()) all.push_back(TriangleId(t));
    }
    return all;
  }

  void empty_queue(const Context& context) {
    for (std::size_t step = 0; !queue_.empty() || open_front(); ++step) {
      if (step % 256 == 0 && context.should_stop()) return;
      const Entry entry = queue_.top();
      queue_.pop();
      if (entry.stamp != progress_[entry.triangle].stamp) continue;
      const TriangleId t(entry.triangle);
      if (!refine(t)) finish(t);
    }
  }

  /// Judges them. What is too large waits until it lies at the front, all else that is wrong does not.
  void enqueue(const std::vector<TriangleId>& triangles) {
    progress_.resize(mesh_.triangle_slots());
    for (const TriangleId t : triangles) {
      Progress& progress = progress_[t.value()];
      progress.state = State::finished;
      ++progress.stamp;
      if (!mesh_.triangle(t).alive()) continue;
      const Verdict verdict = judge(t, true);
      progress.worth = verdict.worth;
      if (verdict.need == Need::size) {
        progress.state = State::waits;
      } else if (verdict.need != Need::none) {
        push(t);
      }
    }
    for (const TriangleId t : triangles) {
      if (!mesh_.triangle(t).alive()) continue;
      if (state(t) == State::waits && front_edge(mesh_.triangle(t))) push(t);
      if (state(t) == State::finished) finish(t);
    }
  }

  using State = Progress::State;
  State state(TriangleId t) const { return progress_[t.value()].state; }

  void push(TriangleId t) {
    Progress& progress = progress_[t.value()];
    progress.state = State::queued;
    queue_.push({progress.worth, t.value(), progress.stamp});
  }

  /// Nothing is to be done there, or can be: what waits beside it is at the front now.
  void finish(TriangleId t) {
    progress_[t.value()].state = State::finished;
    for (const TriangleId n : mesh_.triangle(t).neighbour)
      if (n.valid() && state(n) == State::waits) push(n);
  }

  /// All that waits goes on where there is no front, as on a closed surface. False: nothing does.
  bool open_front() {
    for (const TriangleId t : alive())
      if (state(t) == State::waits) push(t);
    return !queue_.empty();
  }

  /// The shortest edge of a triangle on the boundary or beside what is finished.
  std::optional<std::size_t> front_edge(const FaceTriangle& t) const {
    double shortest2 = std::numeric_limits<double>::infinity();
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < 3; ++i) {
      if (t.use[i] == -1 && t.neighbour[i].valid() && state(t.neighbour[i]) != State::finished) continue;
      const double length2 = norm2(corner(t.node[(i + 1) % 3]).position - corner(t.node[(i + 2) % 3]).position);
      if (length2 >= shortest2) continue;
      shortest2 = length2;
      found = i;
    }
    return found;
  }

  double size_of(const FaceTriangle& t) const {
    return (size_at_[t.node[0].value()] + size_at_[t.node[1].value()] + size_at_[t.node[2].value()]) / 3;
  }

  /// Bent edges before sizes before folds before shapes; the larger the earlier among equals.
  Verdict judge(TriangleId id, bool bends) const {
    const FaceTriangle& t = mesh_.triangle(id);
    const Corner &a = corner(t.node[0]), &b = corner(t.node[1]), &c = corner(t.node[2]);
    const double size = size_of(t);
    if (bends && (must_split(a, b) || must_split(b, c) || must_split(c, a))) {
      return {Need::bend, 1e6 + std::max({arc_estimate(a, b), arc_estimate(b, c), arc_estimate(c, a)}) / size};
    }
    if (degenerate(a, b, c)) return {};
    const double ab = distance(a.position, b.position), bc = distance(b.position, c.position),
                 ca = distance(c.position, a.position);
    const double longest = std::max({ab, bc, ca}), shortest = std::min({ab, bc, ca});
    const double radius = circumradius(a.position, b.position, c.position);
    double wanted = size;
    if (radius > 0.5 * size) {
      const Vec3 centroid = (1.0 / 3) * (a.position + b.position + c.position);
      wanted = std::min(size, sizes_.at_face(face_, centroid));
    }
    // A flat triangle has a large radius and short edges: more points cure it only if they are far enough from its
    // corners.
    if (radius > kRadius * wanted && longest > kSpacing * wanted)
      return {Need::size, 1 + std::min(radius / wanted, 500.0)};
    // The normal turns with the radius, so a fold that is left within the size is cured at its radius or not at all.
    if (radius > 2 * kSpacingFloor * wanted && folded(a, b, c, on()))
      return {Need::fold, std::min(0.9, radius / wanted)};
    if (const auto fan = fan_of(t); fan && fan->turn > kWideFan) return {Need::fan, 0.02 * fan->turn};
    if (radius > kSpacing * wanted && shortest < 2 * kSineSmallAngle * radius)
      return {Need::shape, 0.01 * radius / wanted};
    return {};
  }

  /// Of a triangle with a corner at a pole: the middle of its edge across, and its angle around the pole.
  struct Fan {
    FacePoint middle;
    double turn;
  };

  std::optional<Fan> fan_of(const FaceTriangle& t) const {
    std::size_t at = mesh_.has_tip() ? 0 : 3;
    while (at < 3 && !at_pole(corner(t.node[at]))) ++at;
    if (at == 3) return std::nullopt;
    const Vec3 pole = corner(t.node[at]).position;
    const Corner &a = corner(t.node[(at + 1) % 3]), &b = corner(t.node[(at + 2) % 3]);
    if (t.use[at] != -1 || at_pole(a) || at_pole(b)) return std::nullopt;
    const FacePoint middle = evaluate(middle_of(a, b));
    // The direction around the pole: on a sharp cone the rays turn by little, on a flat one the normals.
    const auto around = [&](Vec3 normal, Vec3 position) { return cross(normal, position - pole); };
    const Vec3 half_way = around(unit_normal(middle.at), middle.at.value);
    return Fan{middle, angle_between(around(a.normal, a.position), half_way) +
                           angle_between(half_way, around(b.normal, b.position))};
  }

  /// Two triangles around a pole for one that spans too much of the turn. On a sharp cone they are thinner than the
  /// size, but without them it has no volume at its tip. Each has half of the angle, so this ends.
  bool split_fan(TriangleId id) {
    const auto fan = fan_of(mesh_.triangle(id));
    return fan && fan->turn > kWideFan && insert(fan->middle, id, Need::fan);
  }

  /// Edges to a pole are flipped when they are askew; points on them would only come nearer to the pole.
  bool must_split(const Corner& a, const Corner& b) const {
    return !at_pole(a) && !at_pole(b) && (bent(a, b) || turns_about(a, b, on()));
  }

  /// False: nothing was wrong, or nothing could be done.
  bool refine(TriangleId id) {
    Verdict verdict = judge(id, true);
    if (verdict.need == Need::bend) {
      if (split_bent(id)) return true;
      verdict = judge(id, false);
    }
    if (verdict.need == Need::none) return false;
    if (verdict.need != Need::fan && place_point(id, verdict.need)) return true;
    if (verdict.need == Need::size && mesh_.has_tip() && is_folded(id) && place_point(id, Need::fold)) return true;
    return split_fan(id);
  }

  bool is_folded(TriangleId id) const {
    const auto& n = mesh_.triangle(id).node;
    return folded(corner(n[0]), corner(n[1]), corner(n[2]), on());
  }

  bool place_point(TriangleId id, Need need) {
    const FaceTriangle t = mesh_.triangle(id);
    std::array<Vec2, 3> q;
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      q[i] = corner(t.node[i]).q;
      p[i] = corner(t.node[i]).position;
    }
    auto centre = ball_centre(surface_, mesh_.chart, q, p);
    if (!centre) {
      if (const auto other = metric_centre(surface_, mesh_.chart, q)) centre = evaluate(*other);
    }
    if (centre && need == Need::size) {
      const auto at_front = point_at_front(t, *centre);
      if (at_front && insert(*at_front, id, need)) return true;
    }
    if (centre && insert(*centre, id, need)) return true;
    return need != Need::shape && split_longest(id, need);
  }

  /// The point over the front's edge, towards the centre, at the distance of one size from the edge's ends; nothing
  /// where there is no front, or the centre is no farther.
  std::optional<FacePoint> point_at_front(const FaceTriangle& t, const FacePoint& centre) const {
    const std::optional<std::size_t> at = front_edge(t);
    if (!at) return std::nullopt;
    const NodeId m = t.node[(*at + 1) % 3], n = t.node[(*at + 2) % 3];
    const double size = 0.5 * (size_at_[m.value()] + size_at_[n.value()]);
    const Vec3 middle = 0.5 * (corner(m).position + corner(n).position);
    const double half2 = norm2(corner(m).position - middle);
    const double height = std::sqrt(std::max(size * size - half2, kLeastHeight * kLeastHeight * size * size));
    const double far = distance(middle, centre.at.value);
    if (far < kNoFarther * height) return std::nullopt;
    const Vec2 from = 0.5 * (corner(m).q + corner(n).q);
    const auto on_the_way = [&](double share) {
      const Vec2 q = from + share * (centre.q - from);
      return evaluate({snap(q.x), snap(q.y)});
    };
    const FacePoint first = on_the_way(height / far);
    const double reached = distance(first.at.value, middle);
    // The chart is stretched on the way: once more, unless the surface bends back.
    if (std::abs(reached - height) < kOffHeight * height || reached < 0.5 * height) return first;
    return on_the_way(std::min(1.0, height / far * height / reached));
  }

  FacePoint evaluate(Vec2 q) const { return {q, surface_.first(mesh_.chart.to_uv(q))}; }

  /// A point at the middle of the most bent edge: it says where a point is missing, while a centre could be anywhere.
  /// Only if the surface there is indeed off the chord; the derivatives at the ends may have been at a jump of speed.
  bool split_bent(TriangleId id) {
    const FaceTriangle t = mesh_.triangle(id);
    double longest = 0;
    std::size_t at = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &a = corner(t.node[(i + 1) % 3]), &b = corner(t.node[(i + 2) % 3]);
      if (t.use[i] != -1 || !must_split(a, b) || arc_estimate(a, b) <= longest) continue;
      longest = arc_estimate(a, b);
      at = i;
    }
    if (at == 3) return false;
    const Corner &a = corner(t.node[(at + 1) % 3]), &b = corner(t.node[(at + 2) % 3]);
    const FacePoint middle = evaluate(middle_of(a, b));
    const Vec3 chord = b.position - a.position;
    if (!off_chord(middle.at.value - 0.5 * (a.position + b.position), chord)) {
      if (arc_estimate(a, b) < 2 * norm(chord) && !turns_about(a, b, on())) return false;
    }
    return insert(middle, id, Need::bend);
  }

  static Vec2 middle_of(const Corner& a, const Corner& b) {
    const Vec2 middle = 0.5 * (a.q + b.q);
    return {snap(middle.x), snap(middle.y)};
  }

  /// A point at the middle of the longest edge that may be split, if it is too long or is what is wrong. Of a fold the
  /// other edges are tried, too: next to the longest one's middle there may be the third corner.
  bool split_longest(TriangleId id, Need need) {
    const FaceTriangle t = mesh_.triangle(id);
    std::array<std::size_t, 3> order{0, 1, 2};
    const auto length = [&](std::size_t i) {
      return t.use[i] != -1 ? 0 : distance(corner(t.node[(i + 1) % 3]).position, corner(t.node[(i + 2) % 3]).position);
    };
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return length(i) > length(j); });
    if (need == Need::size && length(order[0]) < kLongEdge * size_of(t)) return false;
    for (const std::size_t i : order) {
      if (t.use[i] != -1) continue;
      if (insert(evaluate(middle_of(corner(t.node[(i + 1) % 3]), corner(t.node[(i + 2) % 3]))), id, need)) return true;
      if (need != Need::fold || !mesh_.has_tip()) return false;
    }
    return false;
  }

  /// What counts as the size for a new point: the cure of a fold, of an edge that turns about or of a wide fan may be
  /// as close to others as the geometry itself forces it to.
  double reach(const FaceTriangle& t, Need need, double size, const FacePoint& point) const {
    const Corner &a = corner(t.node[0]), &b = corner(t.node[1]), &c = corner(t.node[2]);
    if (need == Need::fan)
      return std::min({distance(point.at.value, a.position), distance(point.at.value, b.position),
                       distance(point.at.value, c.position)});
    const bool turns = turns_about(a, b, on()) || turns_about(b, c, on()) || turns_about(c, a, on());
    if (!(need == Need::bend && turns) && !(need == Need::fold && mesh_.has_tip())) return size;
    const double curvature = surface_.curvatures(mesh_.chart.to_uv(point.q)).x;
    return std::clamp(1 / curvature, kReachFloor * size, size);
  }

  /// Least distance to other nodes; `near` is what `reach` says.
  double spacing(const FaceTriangle& t, Need need, double near, double size) const {
    const Corner &a = corner(t.node[0]), &b = corner(t.node[1]), &c = corner(t.node[2]);
    if (need == Need::bend) {
      const double longest = std::max({arc_estimate(a, b), arc_estimate(b, c), arc_estimate(c, a)});
      return std::min(kSpacing * near, std::max(0.1 * longest, kBentFloor * std::min(size, usual_segment_)));
    }
    if (need == Need::fold) return kSpacing * std::min(near, circumradius(a.position, b.position, c.position));
    return kSpacing * near;
  }

  bool insert(const FacePoint& point, TriangleId from, Need need) {
    if (!finite(point.at.value)) return false;
    const auto holder = mesh_.walk(point.q, from).triangle;
    if (!holder) return false;
    const Vec3 position = snap(point.at.value);
    const double size = sizes_.at_face(face_, position);
    const FaceTriangle& cured = mesh_.triangle(from);
    const double near = reach(cured, need, size, point);
    if (crowded(point, *holder, from, spacing(cured, need, near, size), near)) return false;
    if (mesh_.judge_insert(point.q, *holder) != PlanarRefusal::none) return false;
    const VertexId vertex(static_cast<std::uint32_t>(kLocalVertices + added_.size()));
    const FaceNode node{vertex, point.q};
    corners_.push_back(make_corner(node, position, point.at, mesh_.chart));
    size_at_.push_back(size);
    added_.push_back({position, mesh_.chart.to_uv(point.q)});
    const NodeId made = mesh_.insert(vertex, point.q, *holder, wanted_, changed_);
    CURVETET_CHECK(made.value() + 1 == corners_.size());
    enqueue(changed_);
    return true;
  }

  /// Too close to a node, or within the diametral sphere of a segment, among the triangles whose spheres hold the
  /// point.
  bool crowded(const FacePoint& point, TriangleId holder, TriangleId from, double spacing, double size) {
    const Vec3 p = snap(point.at.value);
    cavity_.assign(1, holder);
    if (from != holder) cavity_.push_back(from);
    for (std::size_t k = 0; k < cavity_.size(); ++k) {
      const FaceTriangle& t = mesh_.triangle(cavity_[k]);
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = corner(t.node[(i + 1) % 3]).position, b = corner(t.node[(i + 2) % 3]).position;
        if (distance(p, a) < spacing) return true;
        if (t.use[i] != -1) {
          if (encroaches(p, a, b, size)) return true;
          continue;
        }
        const TriangleId n = t.neighbour[i];
        if (!n.valid() || cavity_.size() >= kLargestCavity) continue;
        // Across an edge a node may be as near as the point is to the edge, in whatever triangle.
        const Vec2 qa = corner(t.node[(i + 1) % 3]).q, qb = corner(t.node[(i + 2) % 3]).q;
        if (k > 1 && !is_near_edge(point, qa, qb, spacing) && !in_sphere(n, p)) continue;
        if (std::find(cavity_.begin(), cavity_.end(), n) == cavity_.end()) cavity_.push_back(n);
      }
    }
    return false;
  }

  /// On the surface: the chord of a long edge may pass far from a point beside it.
  bool is_near_edge(const FacePoint& point, Vec2 a, Vec2 b, double near) const {
    const Vec2 along = b - a;
    const double share = std::clamp(dot(point.q - a, along) / dot(along, along), 0.0, 1.0);
    const Vec2 off = point.q - a - share * along;
    const Vec3 in_space = (off.x / mesh_.chart.scale_u) * point.at.du + (off.y / mesh_.chart.scale_v) * point.at.dv;
    return norm2(in_space) < near * near;
  }

  static bool encroaches(Vec3 p, Vec3 a, Vec3 b, double size) {
    if (dot(a - p, b - p) >= 0) return false;
    return norm(cross(a - p, b - p)) < kEncroachHeight * size * distance(a, b);
  }

  /// Whether p lies in the equatorial sphere of a triangle.
  bool in_sphere(TriangleId id, Vec3 p) const {
    const FaceTriangle& t = mesh_.triangle(id);
    const Vec3 a = corner(t.node[0]).position, u = corner(t.node[1]).position - a, v = corner(t.node[2]).position - a;
    const Vec3 normal = cross(u, v);
    const double area2 = norm2(normal);
    if (!(area2 > 0)) return false;
    const Vec3 centre = (0.5 / area2) * (norm2(u) * cross(v, normal) + norm2(v) * cross(normal, u));
    return norm2(p - a - centre) < norm2(centre);
  }

  FaceMesh& mesh_;
  FaceId face_;
  const Surface& surface_;
  const SizeField& sizes_;
  FaceMesh::FlipWanted wanted_;
  FlipOrder order_ = FlipOrder::bends_first;
  double usual_segment_ = 0;
  std::vector<Corner> corners_;     ///< by node
  std::vector<double> size_at_;     ///< by node
  std::vector<Progress> progress_;  ///< by triangle
  std::priority_queue<Entry> queue_;
  std::vector<AddedVertex> added_;
  std::vector<TriangleId> changed_, cavity_;
};

/// Surfaces whose first fundamental form varies slowly, so that its mean over a large triangle means something. On the
/// others, and around poles, triangles judged on the surface are the second choice.
bool has_even_form(SurfaceKind kind) {
  constexpr std::array kinds{SurfaceKind::cylinder, SurfaceKind::cone, SurfaceKind::torus, SurfaceKind::revolution,
                             SurfaceKind::extrusion};
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

}  // namespace

std::vector<AddedVertex> refine_face(FaceMesh& mesh, FaceId face, const Surface& surface, const SizeField& sizes,
                                     const VertexStore& vertices, bool smooth, const Context& context) {
  FaceRefiner refiner(mesh, face, surface, sizes, vertices);
  if (!refiner.wraps()) return refiner.run(smooth, context);
  if (has_even_form(surface.kind()) && !mesh.has_pole()) {
    refiner.begin_on_surface(context);
    return refiner.run(smooth, context);
  }
  FaceMesh other = mesh;
  std::vector<AddedVertex> added = refiner.run(smooth, context);
  const std::size_t folds = refiner.count_folds();
  if (folds == 0) return added;
  FaceRefiner again(other, face, surface, sizes, vertices);
  again.begin_on_surface(context);
  std::vector<AddedVertex> others = again.run(smooth, context);
  if (again.count_folds() >= folds) return added;
  mesh = std::move(other);
  return others;
}

}  // namespace curvetet
