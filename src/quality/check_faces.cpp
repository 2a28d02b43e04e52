// The triangles of each CAD face against its surface: vertices on it, no folds, no part of it left uncovered.
//
// A foot is searched from the parameters of the node and of nearby ones, then from a grid of samples; parameters stored
// in the mesh are only a first guess and are never believed. Faces are independent, so they run in parallel, each with
// a clone of its surface.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/box_tree.h"
#include "quality/measures.h"
#include "quality/model_checks.h"

namespace curvetet::checks {
namespace {

constexpr int kGuessSamples = 17;   ///< per direction, for guesses
constexpr int kManySamples = 160;   ///< per direction, where those lead nowhere: threads and other wound surfaces
constexpr int kCoverSamples = 8;    ///< per direction, for coverage
constexpr int kSamplesPerUse = 24;  ///< of a loop's parameter curves, before bisection
constexpr int kDepth = 12;          ///< of that bisection
// Of the extent of the face's domain: what a loop's polygon may leave the loop by, and how near to the polygon a point
// is too close to tell its side.
constexpr double kLoopDeviation = 0.004, kTooClose = 0.02;
constexpr double kGap = 0.01;  ///< the same for uses that join
constexpr std::size_t kGridGuesses = 4;
constexpr int kDescentSteps = 20;
constexpr double kLeastDescent = 1e-3;  ///< of a full step
constexpr double kDescentGain = 1e-6;   ///< of the distance, below which a step is not worth it
constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

/// What one face's task finds.
struct FaceOutcome {
  struct Off {
    std::uint32_t node;
    double distance, limit;
  };
  std::vector<Off> off;
  std::vector<std::uint32_t> folds, lost;  ///< triangles
  std::vector<Vec3> uncovered;
  double slack = 0;  ///< volume between the facets and the surface, at most
};

/// Squared distance from p to the segment ab.
template <class Vec>
double point_segment_distance2(Vec p, Vec a, Vec b) {
  const Vec ab = b - a;
  const double length2 = norm2(ab);
  const double t = length2 > 0 ? std::clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0;
  return norm2(p - (a + t * ab));
}

double point_triangle_distance2(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 n = cross(b - a, c - a);
  const double n2 = norm2(n);
  const double sides =
      std::min({point_segment_distance2(p, a, b), point_segment_distance2(p, b, c), point_segment_distance2(p, c, a)});
  if (!(n2 > 0)) return sides;
  const bool over =
      dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
  const double height = dot(p - a, n);
  return over ? std::min(sides, height * height / n2) : sides;
}

/// Turns of a closed polygon around a point; empty when the point is too close to tell.
std::optional<int> winding(const std::vector<Vec2>& polygon, Vec2 p) {
  double angle = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (point_segment_distance2(p, a, b) < kTooClose * kTooClose) return std::nullopt;
    angle += std::atan2(cross(a - p, b - p), dot(a - p, b - p));
  }
  return static_cast<int>(std::lround(angle / (2 * std::numbers::pi)));
}

/// The loops of a face as polygons in its (u,v), in which its domain is a unit square.
class LoopPolygons {
 public:
  LoopPolygons(const Model& model, const ModelFace& face) : model_(model), face_(face) {}

  /// Empty when the loop's uses do not join.
  std::vector<Vec2> of(const Loop& loop) {
    polygon_.clear();
    for (const EdgeUse& use : loop.uses) {
      if (!use.curve) return {};
      const ModelEdge& edge = model_.edges[use.edge];
      const double from = use.reversed ? edge.high : edge.low, to = use.reversed ? edge.low : edge.high;
      const Vec2 start = at(use, from);
      if (!polygon_.empty() && !is_join(polygon_.back(), start)) return {};
      polygon_.push_back(start);
      for (int i = 0; i < kSamplesPerUse; ++i)
        append(use, from + (to - from) * i / kSamplesPerUse, from + (to - from) * (i + 1) / kSamplesPerUse, 0);
    }
    if (polygon_.empty() || !is_join(polygon_.back(), polygon_.front())) return {};
    return polygon_;
  }

 private:
  static bool is_join(Vec2 a, Vec2 b) { return std::abs(a.x - b.x) <= kGap && std::abs(a.y - b.y) <= kGap; }

  Vec2 at(const EdgeUse& use, double t) const {
    const Vec2 extent = face_.high - face_.low, q = use.curve->value(t) - face_.low;
    return {q.x / extent.x, q.y / extent.y};
  }

  /// What follows the polygon's last point, that at `from`.
  void append(const EdgeUse& use, double from, double to, int depth) {
    const double middle = 0.5 * (from + to);
    const Vec2 end = at(use, to);
    const double off2 = point_segment_distance2(at(use, middle), polygon_.back(), end);
    if (depth < kDepth && off2 > kLoopDeviation * kLoopDeviation) {
      append(use, from, middle, depth + 1);
      append(use, middle, to, depth + 1);
      return;
    }
    polygon_.push_back(end);
  }

  const Model& model_;
  const ModelFace& face_;
  std::vector<Vec2> polygon_;
};

/// One face's task.
class FaceTask {
 public:
  FaceTask(const MeshOnModel& m, FaceId id, const BoxTree& tree)
      : m_(m), id_(id), face_(m.model.faces[id]), tree_(tree), projector_(face_) {}

  FaceOutcome run(const Context& context) {
    FaceOutcome outcome;
    for (const std::uint32_t t : m_.triangles[id_]) {
      if (context.should_stop()) return outcome;
      check_triangle(t, outcome);
    }
    for (const Vec2 uv : domain_samples(m_.model, face_)) check_covered(projector_.value(uv), outcome);
    return outcome;
  }

  static std::vector<Vec2> domain_samples(const Model& model, const ModelFace& face);

 private:
  void check_triangle(std::uint32_t t, FaceOutcome& outcome) {
    const auto& nodes = m_.mesh.triangles[t];
    std::array<Vec2, 3> guesses{};
    std::size_t found = 0;
    for (const std::uint32_t node : nodes) {
      if (const auto foot = foot_of(node, std::span(guesses).first(found), outcome)) guesses[found++] = foot->uv;
    }
    const Vec3 a = m_.points[nodes[0]], b = m_.points[nodes[1]], c = m_.points[nodes[2]];
    const Vec3 centroid = (1.0 / 3) * (a + b + c), normal = cross(b - a, c - a);
    const auto foot = projector_.project(centroid, std::span(guesses).first(found), kAnyDistance);
    if (!foot) {
      outcome.lost.push_back(t);
      return;
    }
    outcome.slack += 0.5 * norm(normal) * foot->distance;
    if (projector_.looks_away(centroid, normal, *foot)) outcome.folds.push_back(t);
  }

  /// The foot of a node, found once; reports the node if it is off the surface.
  std::optional<Foot> foot_of(std::uint32_t node, std::span<const Vec2> others, FaceOutcome& outcome) {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node);
    const auto i = static_cast<std::size_t>(at - nodes_.begin());
    if (known_[i] != 0) return feet_[i];
    known_[i] = 1;
    std::vector<Vec2> guesses = guesses_of(node);
    guesses.insert(guesses.end(), others.begin(), others.end());
    const double limit = m_.limit(face_.tolerance, node);
    feet_[i] = projector_.project(m_.points[node], guesses, limit);
    const double distance = feet_[i] ? feet_[i]->distance : std::numeric_limits<double>::infinity();
    if (!(distance <= limit)) outcome.off.push_back({node, distance, limit});
    return feet_[i];
  }

  /// Where the mesh says that a node is on this face, or on the parameter curves of an edge of it.
  std::vector<Vec2> guesses_of(std::uint32_t node) const {
    if (node >= m_.mesh.nodes.size()) return {};
    const NodeOnCad& owner = m_.mesh.nodes[node];
    if (owner.dimension == 2 && owner.entity < m_.faces.size() && m_.faces[owner.entity] == id_)
      return {{owner.parameter[0], owner.parameter[1]}};
    if (owner.dimension == 0 && owner.entity < m_.vertices.size()) return ends_at(m_.vertices[owner.entity]);
    if (owner.dimension != 1 || owner.entity >= m_.edges.size()) return {};
    const auto [first, last] = std::equal_range(uses_.begin(), uses_.end(), UseOfEdge{m_.edges[owner.entity], nullptr});
    std::vector<Vec2> guesses;
    for (auto use = first; use != last; ++use) {
      const double t = m_.model.edges[use->edge].from_own_parameter(owner.parameter[0]);
      guesses.push_back(use->curve->value(t));
    }
    return guesses;
  }

  /// Ends of parameter curves at a vertex.
  std::vector<Vec2> ends_at(CadVertexId vertex) const {
    std::vector<Vec2> ends;
    for (const UseOfEdge& use : uses_) {
      const ModelEdge& edge = m_.model.edges[use.edge];
      if (edge.start == vertex) ends.push_back(use.curve->value(edge.low));
      if (edge.end == vertex) ends.push_back(use.curve->value(edge.high));
    }
    return ends;
  }

  void check_covered(Vec3 sample, FaceOutcome& outcome) {
    const auto& boundary = m_.topology.boundary;
    const auto corner = [&](std::uint32_t f, std::size_t i) { return m_.points[boundary[f].vertices[i]]; };
    const std::uint32_t f = tree_.nearest(sample, [&](std::uint32_t i) {
      return point_triangle_distance2(sample, corner(i, 0), corner(i, 1), corner(i, 2));
    });
    if (f == kOutside) return;
    const Vec3 a = corner(f, 0), b = corner(f, 1), c = corner(f, 2);
    const double longest2 = std::max({norm2(b - a), norm2(c - b), norm2(a - c)});
    if (point_triangle_distance2(sample, a, b, c) > 0.25 * longest2) outcome.uncovered.push_back(sample);
  }

  static std::vector<std::uint32_t> nodes_of(const MeshOnModel& m, FaceId id) {
    std::vector<std::uint32_t> nodes;
    for (const std::uint32_t t : m.triangles[id]) {
      nodes.insert(nodes.end(), m.mesh.triangles[t].begin(), m.mesh.triangles[t].end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }

  struct UseOfEdge {
    EdgeId edge;
    const ParameterCurve* curve;
    bool operator<(const UseOfEdge& other) const { return edge < other.edge; }
  };

  static std::vector<UseOfEdge> uses_of(const ModelFace& face) {
    std::vector<UseOfEdge> uses;
    const auto add = [&](const EdgeUse& use) {
      if (use.curve) uses.push_back({use.edge, use.curve.get()});
    };
    for (const Loop& loop : face.loops) std::for_each(loop.uses.begin(), loop.uses.end(), add);
    std::for_each(face.internal_edges.begin(), face.internal_edges.end(), add);
    std::stable_sort(uses.begin(), uses.end());
    return uses;
  }

  const MeshOnModel& m_;
  FaceId id_;
  const ModelFace& face_;
  const BoxTree& tree_;
  FaceProjector projector_;
  std::vector<UseOfEdge> uses_ = uses_of(face_);
  std::vector<std::uint32_t> nodes_ = nodes_of(m_, id_);
  std::vector<std::uint8_t> known_ = std::vector<std::uint8_t>(nodes_.size(), 0);
  std::vector<std::optional<Foot>> feet_ = std::vector<std::optional<Foot>>(nodes_.size());
};

std::vector<Vec2> FaceTask::domain_samples(const Model& model, const ModelFace& face) {
  const Vec2 extent = face.high - face.low;
  if (!(extent.x > 0) || !(extent.y > 0)) return {};
  std::vector<std::vector<Vec2>> polygons;
  LoopPolygons polygon(model, face);
  for (const Loop& loop : face.loops) {
    polygons.push_back(polygon.of(loop));
    if (polygons.back().empty()) return {};
  }
  std::vector<Vec2> samples;
  for (int i = 0; i < kCoverSamples * kCoverSamples; ++i) {
    const int row = i / kCoverSamples, column = i % kCoverSamples;
    const Vec2 p{(column + 0.5) / kCoverSamples, (row + 0.5) / kCoverSamples};
    int turns = 0;
    const bool clear = std::all_of(polygons.begin(), polygons.end(), [&](const std::vector<Vec2>& loop) {
      const std::optional<int> w = winding(loop, p);
      turns += w.value_or(0);
      return w.has_value();
    });
    if (clear && turns == 1) samples.push_back(face.low + Vec2{p.x * extent.x, p.y * extent.y});
  }
  return samples;
}

}  // namespace

FaceProjector::FaceProjector(const ModelFace& face) : face_(face), surface_(face.surface->clone()) {}

Vec3 FaceProjector::outward_normal(Vec2 uv) const {
  const Vec3 n = surface_->normal(uv);
  return face_.reversed ? -n : n;
}

// Around a sharp bend the corners may lead to a place that is not the closest of the face; and beyond the face's border
// its surface may turn back.
bool FaceProjector::looks_away(Vec3 centroid, Vec3 normal, const Foot& foot) {
  const auto is_against = [&](Vec2 uv) { return dot(normal, outward_normal(uv)) < 0; };
  if (foot.inside_box && !is_against(foot.uv)) return false;
  return is_against(closest(centroid, foot.uv));
}

bool FaceProjector::inside_box(Vec2 uv) const {
  const Vec2 margin = 0.01 * (face_.high - face_.low);
  const auto within = [](double x, double low, double high, double pad, double period) {
    if (period > 0) x -= period * std::floor((x - (low - pad)) / period);
    return x >= low - pad && x <= high + pad;
  };
  return within(uv.x, face_.low.x, face_.high.x, margin.x, surface_->period_u()) &&
         within(uv.y, face_.low.y, face_.high.y, margin.y, surface_->period_v());
}

void FaceProjector::consider(Vec3 point, Vec2 guess, std::optional<Foot>& best) const {
  const std::optional<Vec2> uv = surface_->project(point, guess);
  if (!uv) return;
  const Foot foot{*uv, distance(point, surface_->value(*uv)), inside_box(*uv)};
  const bool better = !best || (foot.inside_box != best->inside_box ? foot.inside_box : foot.distance < best->distance);
  if (better) best = foot;
}

Vec2 FaceProjector::closest(Vec3 point, Vec2 guess) {
  if (coarse_.uv.empty()) coarse_.fill(face_, *surface_, kGuessSamples);
  Vec2 best = descend(point, within_box(face_, guess));
  double least = distance(point, surface_->value(best));
  for (const Vec2 sample : coarse_.nearest(point)) {
    const auto foot = surface_->project(point, sample);
    for (const Vec2 uv : {descend(point, sample), within_box(face_, foot.value_or(sample))}) {
      const double away = distance(point, surface_->value(uv));
      if (away >= least) continue;
      least = away;
      best = uv;
    }
  }
  return best;
}

// Gauss-Newton, each step cut off at the box and halved until it leads closer. A projection that does not know of the
// box may end turns away from it, on a face that is a part of a round.
Vec2 FaceProjector::descend(Vec3 point, Vec2 uv) const {
  double least = distance(point, surface_->value(uv));
  for (int step = 0; step < kDescentSteps; ++step) {
    const SurfaceFirst at = surface_->first(uv);
    const Vec3 off = point - at.value;
    const double e = norm2(at.du), f = dot(at.du, at.dv), g = norm2(at.dv), determinant = e * g - f * f;
    if (!(determinant > 0)) return uv;
    const double p = dot(off, at.du), q = dot(off, at.dv);
    const Vec2 full{(p * g - q * f) / determinant, (q * e - p * f) / determinant};
    bool is_closer = false;
    for (double part = 1; part > kLeastDescent && !is_closer; part *= 0.5) {
      const Vec2 next = within_box(face_, uv + part * full);
      const double away = distance(point, surface_->value(next));
      if (!(away < (1 - kDescentGain) * least)) continue;
      is_closer = true;
      least = away;
      uv = next;
    }
    if (!is_closer) return uv;
  }
  return uv;
}

void FaceProjector::Grid::fill(const ModelFace& face, const Surface& surface, int samples) {
  for (int i = 0; i < samples * samples; ++i) {
    const int row = i / samples, column = i % samples;
    const double s = static_cast<double>(column) / (samples - 1), t = static_cast<double>(row) / (samples - 1);
    uv.push_back({face.low.x + s * (face.high.x - face.low.x), face.low.y + t * (face.high.y - face.low.y)});
    value.push_back(surface.value(uv.back()));
  }
}

std::vector<Vec2> FaceProjector::Grid::nearest(Vec3 point) const {
  std::vector<std::pair<double, std::size_t>> order(uv.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {norm2(value[i] - point), i};
  const auto middle = order.begin() + kGridGuesses;
  std::partial_sort(order.begin(), middle, order.end());
  std::vector<Vec2> result;
  for (auto entry = order.begin(); entry != middle; ++entry) result.push_back(uv[entry->second]);
  return result;
}

std::optional<Foot> FaceProjector::project(Vec3 point, std::span<const Vec2> guesses, double near_enough) {
  std::optional<Foot> best;
  const auto good = [&] { return best && best->inside_box && best->distance <= near_enough; };
  for (const Vec2 guess : guesses) consider(point, guess, best);
  if (good()) return best;
  if (coarse_.uv.empty()) coarse_.fill(face_, *surface_, kGuessSamples);
  for (const Vec2 guess : coarse_.nearest(point)) consider(point, guess, best);
  if (good() || !std::isfinite(near_enough)) return best;
  if (fine_.uv.empty()) fine_.fill(face_, *surface_, kManySamples);
  for (const Vec2 guess : fine_.nearest(point)) consider(point, guess, best);
  return best;
}

double MeshOnModel::limit(double entity_tolerance, std::uint32_t node) const {
  return std::max(least_limit, 10 * std::max(entity_tolerance, tolerance[node]));
}

void check_faces(const MeshOnModel& m, Context& context, Findings& findings, std::vector<double>& solid_slack) {
  std::vector<Box3> boxes(m.topology.boundary.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (const std::uint32_t v : m.topology.boundary[i].vertices) boxes[i].extend(m.points[v]);
  }
  const BoxTree tree(boxes);
  std::vector<FaceId> order;
  for (std::uint32_t f = 0; f < m.model.faces.size(); ++f) {
    if (m.model.faces[FaceId(f)].front != m.model.faces[FaceId(f)].back) order.emplace_back(f);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](FaceId a, FaceId b) { return m.triangles[a].size() > m.triangles[b].size(); });
  IndexedVector<FaceId, FaceOutcome> outcomes(m.model.faces.size());
  parallel_for(context, order.size(),
               [&](std::size_t i) { outcomes[order[i]] = FaceTask(m, order[i], tree).run(context); });

  const auto triangle = [&](std::uint32_t t, const ModelFace& face) {
    return fmt::format("triangle {} of face {} at {}", t, face.label.cad_id,
                       place(vec(m.mesh.points[m.mesh.triangles[t][0]])));
  };
  for (std::uint32_t f = 0; f < m.model.faces.size(); ++f) {
    const ModelFace& face = m.model.faces[FaceId(f)];
    const FaceOutcome& outcome = outcomes[FaceId(f)];
    for (const auto& off : outcome.off) {
      findings.add("vertex_off_face", Severity::error, [&] {
        return fmt::format("node {} is {:.3g} from face {} (limit {:.3g}) at {}", off.node,
                           m.to_mesh_length(off.distance), face.label.cad_id, m.to_mesh_length(off.limit),
                           place(vec(m.mesh.points[off.node])));
      });
    }
    for (const std::uint32_t t : outcome.folds) {
      findings.add("fold", Severity::error, [&] { return triangle(t, face); });
    }
    for (const std::uint32_t t : outcome.lost) {
      findings.add("centre_without_foot", Severity::warning, [&] { return triangle(t, face); });
    }
    for (const Vec3 p : outcome.uncovered) {
      findings.add("uncovered_face", Severity::error,
                   [&] { return fmt::format("face {} at {}", face.label.cad_id, m.place_of(p)); });
    }
    for (const SolidId s : {face.front, face.back}) {
      if (s.valid()) solid_slack[s.value()] += outcome.slack;
    }
  }
}

}  // namespace curvetet::checks
