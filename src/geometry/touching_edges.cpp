// Sharing one edge was rejected: four facets of one solid would meet in it, which the CAD does not say, and many
// solvers refuse such a mesh. A hair is far below what any check of the distance to the CAD looks at, and far above the
// grid.
#include "geometry/touching_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace curvetet {

namespace {

constexpr double kHair = 2e-7;           ///< of the body's diagonal
constexpr double kHairOverDistance = 8;  ///< and over the distance between the two curves
constexpr double kLeastAngle = 0.01;     ///< between faces of the two edges, else they coincide
constexpr int kSamples = 16;             ///< stretches between the directions that are found

/// A curve drawn aside. Derivatives are those of the curve itself: the hair does not bend it.
class AsideCurve final : public Curve {
 public:
  AsideCurve(const Curve& base, double low, double high, std::array<Vec3, kSamples + 1> aside)
      : base_(base.clone()), low_(low), high_(high), aside_(aside) {}
  CurveKind kind() const override { return CurveKind::other; }
  Vec3 value(double t) const override { return base_->value(t) + aside(t); }
  CurveSecond second(double t) const override {
    CurveSecond s = base_->second(t);
    s.value = s.value + aside(t);
    return s;
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<AsideCurve>(*base_, low_, high_, aside_); }

 private:
  Vec3 aside(double t) const {
    const double at = kSamples * std::clamp((t - low_) / (high_ - low_), 0.0, 1.0);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), kSamples - 1);
    const double share = at - static_cast<double>(i);
    return (1 - share) * aside_[i] + share * aside_[i + 1];
  }

  std::unique_ptr<Curve> base_;
  double low_, high_;
  std::array<Vec3, kSamples + 1> aside_;
};

struct Side {
  FaceId face;
  const EdgeUse* use = nullptr;
};

class Parting {
 public:
  explicit Parting(Model& model) : model_(model), sides_(model.edges.size()) {
    for (std::size_t f = 0; f < model.faces.size(); ++f) {
      const FaceId id(f);
      for (const Loop& loop : model.faces[id].loops)
        for (const EdgeUse& use : loop.uses) sides_[use.edge].push_back({id, &use});
      for (const EdgeUse& use : model.faces[id].internal_edges) sides_[use.edge].push_back({id, &use});
    }
  }

  void run() {
    std::map<std::pair<CadVertexId, CadVertexId>, std::vector<EdgeId>> by_ends;
    for (std::size_t e = 0; e < model_.edges.size(); ++e)
      if (is_plain(EdgeId(e))) by_ends[ends_of(EdgeId(e))].push_back(EdgeId(e));
    for (const auto& [ends, edges] : by_ends)
      for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) part(edges[k], edges[i]);
  }

 private:
  std::pair<CadVertexId, CadVertexId> ends_of(EdgeId id) const {
    return std::minmax(model_.edges[id].start, model_.edges[id].end);
  }

  /// Between two different faces.
  bool is_plain(EdgeId id) const {
    const ModelEdge& edge = model_.edges[id];
    const std::vector<Side>& sides = sides_[id];
    return edge.curve && !edge.degenerate && sides.size() == 2 && sides[0].face != sides[1].face;
  }

  /// Largest distance between the curves if one parameter is an affine map of the other.
  double distance_between(const ModelEdge& a, const ModelEdge& b, bool reversed) const {
    double largest = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const double s = static_cast<double>(k) / kSamples, r = reversed ? 1 - s : s;
      largest = std::max(largest, distance(a.curve->value(a.low + s * (a.high - a.low)),
                                           b.curve->value(b.low + r * (b.high - b.low))));
    }
    return largest;
  }

  /// Unit direction from the edge into a face, across the edge.
  Vec3 into(EdgeId id, const Side& side, double t) const {
    Vec3 along = normalized(model_.edges[id].curve->second(t).dt);
    if (side.use->reversed) along = -along;
    return normalized(cross(model_.faces[side.face].surface->normal(side.use->curve->value(t)), along));
  }

  Vec3 wedge(EdgeId id, double t) const { return into(id, sides_[id][0], t) + into(id, sides_[id][1], t); }

  /// Do the faces of the two edges lie one pair beside the other, and none on another?
  bool are_beside(EdgeId a, double ta, EdgeId b, double tb) const {
    const Vec3 x = into(a, sides_[a][0], ta), y = cross(normalized(model_.edges[a].curve->second(ta).dt), x);
    const auto angle = [&](Vec3 d) {
      const double turn = std::atan2(dot(d, y), dot(d, x));
      return turn < 0 ? turn + 2 * std::numbers::pi : turn;
    };
    const double other = angle(into(a, sides_[a][1], ta));
    std::array<bool, 2> within{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double at = angle(into(b, sides_[b][i], tb));
      const double clear = std::min({at, 2 * std::numbers::pi - at, std::abs(at - other)});
      if (!(clear > kLeastAngle)) return false;
      within[i] = at < other;
    }
    return within[0] == within[1];
  }

  void part(EdgeId one, EdgeId two) {
    if (model_.edges[one].twin.valid() || model_.edges[two].twin.valid()) return;
    const ModelEdge &a = model_.edges[one], &b = model_.edges[two];
    const double forward = distance_between(a, b, false), backward = distance_between(a, b, true);
    const double apart = std::min(forward, backward), hair = kHair * model_.diagonal();
    if (apart > std::max(a.tolerance, b.tolerance) || kHairOverDistance * apart > hair) return;
    const bool reversed = backward < forward;
    const double ta = 0.5 * (a.low + a.high), tb = 0.5 * (b.low + b.high);
    if (!are_beside(one, ta, two, tb)) return;
    const bool second = norm(wedge(two, tb)) >= norm(wedge(one, ta));
    draw_back(second ? two : one, second ? one : two, reversed, hair);
  }

  void draw_back(EdgeId id, EdgeId twin, bool reversed, double hair) {
    ModelEdge& edge = model_.edges[id];
    const ModelEdge& other = model_.edges[twin];
    std::array<Vec3, kSamples + 1> aside{};
    for (int k = 1; k < kSamples; ++k) {
      const double s = static_cast<double>(k) / kSamples;
      const double fading = std::min(1.0, 4 * std::min(s, 1 - s));
      aside[static_cast<std::size_t>(k)] =
          (fading * hair) * normalized(wedge(id, edge.low + s * (edge.high - edge.low)));
    }
    edge.curve = std::make_shared<AsideCurve>(*edge.curve, edge.low, edge.high, aside);
    edge.tolerance = std::max(edge.tolerance, 1.5 * hair);
    edge.twin = twin;
    edge.twin_scale = (edge.high - edge.low) / (other.high - other.low) * (reversed ? -1 : 1);
    edge.twin_shift = (reversed ? edge.high : edge.low) - edge.twin_scale * other.low;
    model_.healing.push_back({"edge " + std::to_string(edge.label.cad_id),
                              "lies on edge " + std::to_string(other.label.cad_id) +
                                  " without sharing it, where the body touches itself, and is kept apart by a hair"});
  }

  Model& model_;
  IndexedVector<EdgeId, std::vector<Side>> sides_;
};

}  // namespace

void part_touching_edges(Model& model) { Parting(model).run(); }

}  // namespace curvetet
