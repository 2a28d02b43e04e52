// Parametric curves and surfaces in working coordinates. Evaluation is const but not thread-safe: one clone per thread.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "base/vec.h"

namespace curvetet {

enum class SurfaceKind { plane, cylinder, cone, sphere, torus, bezier, bspline, revolution, extrusion, offset, other };
enum class CurveKind { line, circle, ellipse, bspline, other };

const char* name(SurfaceKind kind);
const char* name(CurveKind kind);

/// Value and derivatives of a surface at (u,v).
struct SurfaceFirst {
  Vec3 value, du, dv;
};
struct SurfaceSecond {
  Vec3 value, du, dv, duu, duv, dvv;
};

/// A parametric surface. Values and derivatives are in working coordinates per unit of parameter. Where an offset
/// surface is not defined its value is no number; derivatives that are not defined are zero, as at a pole.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual SurfaceKind kind() const = 0;
  virtual Vec3 value(Vec2 uv) const = 0;
  virtual SurfaceFirst first(Vec2 uv) const = 0;
  virtual SurfaceSecond second(Vec2 uv) const = 0;
  /// Period in u or v; 0 where not periodic.
  virtual double period_u() const { return 0; }
  virtual double period_v() const { return 0; }
  /// An independent evaluator for another thread.
  virtual std::unique_ptr<Surface> clone() const = 0;

  /// Tells the surface the box of the trimmed domain. Only normal() uses it: at a pole it takes the limit from this
  /// side.
  void set_domain(Vec2 low, Vec2 high) {
    low_ = low;
    high_ = high;
  }
  /// Unit normal du x dv; where the derivatives collapse (a pole), the limit from nearby, or zero if there is none.
  Vec3 normal(Vec2 uv) const;
  /// Parameters of the closest point near the guess (damped Gauss-Newton on the squared distance); empty if it does not
  /// converge. Not confined to the trimmed domain.
  virtual std::optional<Vec2> project(Vec3 point, Vec2 guess) const;
  /// Principal curvatures, absolute values, {largest, smallest}; zero where undefined (poles).
  Vec2 curvatures(Vec2 uv) const;

 private:
  Vec2 low_{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Vec2 high_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
};

struct CurveSecond {
  Vec3 value, dt, dtt;
};

/// A curve in space. What is not defined is as on surfaces.
class Curve {
 public:
  virtual ~Curve() = default;
  virtual CurveKind kind() const = 0;
  virtual Vec3 value(double t) const = 0;
  virtual CurveSecond second(double t) const = 0;
  virtual std::unique_ptr<Curve> clone() const = 0;
  /// Curvature at t (working units: one over length).
  double curvature(double t) const;
  /// Parameter of the closest point within [low, high] near the guess.
  double project(Vec3 point, double guess, double low, double high) const;
};

/// A curve in the parameter plane of a face (a CAD pcurve), over the same parameter as its edge's curve.
class ParameterCurve {
 public:
  virtual ~ParameterCurve() = default;
  virtual Vec2 value(double t) const = 0;
  virtual std::unique_ptr<ParameterCurve> clone() const = 0;
};

}  // namespace curvetet
