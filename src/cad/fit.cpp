// Kernels compare an edge with its parameter curve at a handful of points, so that files declare a tolerance of 1e-7
// where the two drift apart by a thousand times that in between. Projection on demand is exact and needs no new
// approximation.
#include "cad/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace curvetet {
namespace {

constexpr int kSamples = 16;
constexpr double kLargestTolerance = 1e-4;  ///< of the body's diagonal

/// How far a projection may move in (u,v), as part of the face's domain, and how far at the ends, where loops join.
constexpr double kMove = 0.05, kEndMove = 1e-3;

/// uv(t): the foot of curve(t) on the surface, near guess(t).
class ProjectedCurve final : public ParameterCurve {
 public:
  ProjectedCurve(std::unique_ptr<Curve> curve, std::unique_ptr<Surface> surface, std::unique_ptr<ParameterCurve> guess)
      : curve_(std::move(curve)), surface_(std::move(surface)), guess_(std::move(guess)) {}
  Vec2 value(double t) const override {
    const Vec2 near = guess_->value(t);
    const Vec3 point = curve_->value(t);
    const auto foot = surface_->project(point, near);
    if (!foot) return near;
    // Never a worse point than the given one: the projection may have run to another sheet.
    return distance(surface_->value(*foot), point) <= distance(surface_->value(near), point) ? *foot : near;
  }
  std::unique_ptr<ParameterCurve> clone() const override {
    return std::make_unique<ProjectedCurve>(curve_->clone(), surface_->clone(), guess_->clone());
  }

 private:
  std::unique_ptr<Curve> curve_;
  std::unique_ptr<Surface> surface_;
  std::unique_ptr<ParameterCurve> guess_;
};

class Fitter {
 public:
  explicit Fitter(Model& model) : model_(model), largest_(kLargestTolerance * model.diagonal()) {}

  void run() {
    needed_.assign(model_.edges.size(), 0);
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      ModelFace& face = model_.faces[FaceId(f)];
      if (face.surface == nullptr) continue;
      int refined = 0;
      for (Loop& loop : face.loops) {
        for (EdgeUse& use : loop.uses) refined += fit(face, use) ? 1 : 0;
      }
      for (EdgeUse& use : face.internal_edges) refined += fit(face, use) ? 1 : 0;
      if (refined > 0) {
        note("face", face.label,
             std::to_string(refined) + " parameter curves are replaced by projections of the edges");
      }
    }
    raise_edges();
    raise_vertices();
  }

 private:
  void note(const char* kind, const Label& label, const std::string& what) {
    model_.healing.push_back({std::string(kind) + " " + std::to_string(label.cad_id), what});
  }

  double deviation(const ModelFace& face, const ModelEdge& edge, const ParameterCurve& curve) const {
    double worst = 0;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = edge.low + (edge.high - edge.low) * i / kSamples;
      const Vec3 on_edge = edge.degenerate ? model_.vertices[edge.start].point : edge.curve->value(t);
      const double off = distance(face.surface->value(curve.value(t)), on_edge);
      if (!std::isfinite(off)) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, off);
    }
    return worst;
  }

  /// Near a pole the foot may lie far away in (u,v), and the loop would no longer close.
  bool stays_near(const ModelFace& face, const ModelEdge& edge, const ParameterCurve& given,
                  const ParameterCurve& projected) const {
    const Vec2 extent = face.high - face.low;
    for (int i = 0; i <= kSamples; ++i) {
      const double t = edge.low + (edge.high - edge.low) * i / kSamples;
      const Vec2 moved = projected.value(t) - given.value(t);
      const double allowed = i == 0 || i == kSamples ? kEndMove : kMove;
      if (std::abs(moved.x) > allowed * extent.x || std::abs(moved.y) > allowed * extent.y) return false;
    }
    return true;
  }

  /// True if the parameter curve was replaced.
  bool fit(const ModelFace& face, EdgeUse& use) {
    const ModelEdge& edge = model_.edges[use.edge];
    if (use.curve == nullptr || !(edge.low < edge.high) || !edge.start.valid()) return false;
    double off = deviation(face, edge, *use.curve);
    bool replaced = false;
    if (!edge.degenerate && off > std::max(edge.tolerance, face.tolerance)) {
      auto projected = std::make_shared<ProjectedCurve>(edge.curve->clone(), face.surface->clone(), use.curve->clone());
      const double better = deviation(face, edge, *projected);
      if (better < 0.5 * off && stays_near(face, edge, *use.curve, *projected)) {
        off = better;
        use.curve = std::move(projected);
        replaced = true;
      }
    }
    double& needed = needed_[use.edge.value()];
    needed = std::max(needed, off);
    return replaced;
  }

  void raise_edges() {
    for (std::size_t e = 0; e < model_.edges.size(); ++e) {
      ModelEdge& edge = model_.edges[EdgeId(e)];
      double& tolerance =
          edge.degenerate && edge.start.valid() ? model_.vertices[edge.start].tolerance : edge.tolerance;
      raise(tolerance, needed_[e], "edge", edge.label);
    }
  }

  void raise_vertices() {
    std::map<CadVertexId, double> needed;
    for (const ModelEdge& edge : model_.edges) {
      if (edge.degenerate || !edge.start.valid() || !edge.end.valid() || edge.curve == nullptr) continue;
      const auto measure = [&](double t, CadVertexId v) {
        double& off = needed[v];
        off = std::max(off, distance(edge.curve->value(t), model_.vertices[v].point));
      };
      measure(edge.low, edge.start);
      measure(edge.high, edge.end);
    }
    for (const auto& [v, off] : needed) raise(model_.vertices[v].tolerance, off, "vertex", model_.vertices[v].label);
  }

  void raise(double& tolerance, double needed, const char* kind, const Label& label) {
    if (!(needed > tolerance) || needed > largest_) return;
    if (needed > 10 * tolerance && needed > 1e-6 * model_.diagonal()) {
      note(kind, label, "its tolerance is raised to the distance that was measured");
    }
    tolerance = needed;
  }

  Model& model_;
  double largest_;
  std::vector<double> needed_;
};

}  // namespace

void fit_parameter_curves(Model& model) { Fitter(model).run(); }

}  // namespace curvetet
