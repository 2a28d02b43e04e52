// The size that a surface's or curve's bending demands at a point.
#pragma once

#include <vector>

#include "geometry/model.h"
#include "sizing/size_field.h"

namespace curvetet::sizing {

/// A demanded size, and what demands it. `size` is infinite where nothing does.
struct Demand {
  double size = std::numeric_limits<double>::infinity();
  SizeReason reason = SizeReason::curvature;
};

/// Bending of a surface at a point.
struct SurfaceBending {
  Vec3 point, normal;  ///< unit normal, zero where it is undefined
  Vec2 scale;          ///< lengths of du and dv
  double largest = 0;  ///< principal curvature, absolute value
  Vec2 direction;      ///< of the largest one, in (u,v) per unit of length
};

SurfaceBending bending(const Surface& surface, Vec2 uv);

/// A point where a face's curvature grows without bound (the apex of a cone).
struct SingularPoint {
  Vec3 where;
  double reach = 0;  ///< curvature closer than this counts as it does at this distance
};

/// Demands at points of one face. Not thread-safe: it owns an evaluator.
class FaceBending {
 public:
  FaceBending(const Model& model, FaceId face, const SizingOptions& options);
  const Surface& surface() const { return *surface_; }
  Demand demand(Vec2 uv, const SurfaceBending& at) const;
  /// Curvature that counts at the point: bounded towards singular points.
  double effective_curvature(const SurfaceBending& at) const;

 private:
  void find_singular_points(const Model& model, const ModelFace& face);
  /// Not of unit length; the limit where a derivative collapses.
  Vec3 normal_at(Vec2 uv, const SurfaceFirst& s) const;
  double turning_size(Vec2 uv, const SurfaceBending& at, double angle) const;

  SizingOptions options_;
  std::unique_ptr<Surface> surface_;
  Vec2 low_, high_;
  bool analytic_ = false;
  std::vector<SingularPoint> singular_;
};

/// Size below which the bending of a curve of this tolerance means nothing: kToleranceSizes tolerances, or the chord
/// that leaves its arc by one.
double bending_floor(double tolerance, double curvature);

/// Demand of an edge's own bending at t. `curve` is an evaluator of the edge's curve.
Demand curve_demand(const ModelEdge& edge, const Curve& curve, double t, const SizingOptions& options);

/// Largest chord of a circle of this curvature whose distance to its arc is at most `height`; infinite for a straight
/// line.
double chord_for_height(double height, double curvature);

}  // namespace curvetet::sizing
