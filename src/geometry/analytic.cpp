// Plane, cylinder, cone, sphere, torus, line, circle, ellipse. Projections are in closed form, since these are most of
// what CAD holds and the mesher projects millions of times.
#include "geometry/analytic.h"

#include <cmath>
#include <numbers>

namespace curvetet {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The angle plus the multiple of a turn that brings it nearest to the guess.
double nearest_turn(double angle, double guess) { return angle + kTurn * std::nearbyint((guess - angle) / kTurn); }

/// The point's coordinates in the placement.
Vec3 local(const Placement& at, Vec3 p) {
  const Vec3 d = p - at.origin;
  return {dot(d, at.x), dot(d, at.y), dot(d, at.z)};
}

/// The unit direction at angle u in the plane of x and y, and its derivative.
struct Turn {
  Vec3 radial, tangent;
};
Turn turn(const Placement& at, double u) {
  const double c = std::cos(u), s = std::sin(u);
  return {c * at.x + s * at.y, c * at.y - s * at.x};
}

class Plane final : public Surface {
 public:
  explicit Plane(const Placement& at) : at_(at), du_(at.unit * at.x), dv_(at.unit * at.y) {}
  SurfaceKind kind() const override { return SurfaceKind::plane; }
  Vec3 value(Vec2 uv) const override { return at_.origin + uv.x * du_ + uv.y * dv_; }
  SurfaceFirst first(Vec2 uv) const override { return {value(uv), du_, dv_}; }
  SurfaceSecond second(Vec2 uv) const override { return {value(uv), du_, dv_, {}, {}, {}}; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Plane>(*this); }
  std::optional<Vec2> project(Vec3 point, Vec2 /*guess*/) const override {
    const Vec3 p = local(at_, point);
    return Vec2{p.x / at_.unit, p.y / at_.unit};
  }

 private:
  Placement at_;
  Vec3 du_, dv_;
};

/// Surface of revolution of a straight line: a cylinder where the sine of the semi-angle is zero.
class Cone final : public Surface {
 public:
  Cone(const Placement& at, double radius, double sine, double cosine)
      : at_(at), radius_(radius), sine_(sine), cosine_(cosine) {}
  SurfaceKind kind() const override { return sine_ == 0 ? SurfaceKind::cylinder : SurfaceKind::cone; }
  Vec3 value(Vec2 uv) const override { return at(uv, turn(at_, uv.x)); }
  SurfaceFirst first(Vec2 uv) const override {
    const Turn t = turn(at_, uv.x);
    return {at(uv, t), radius(uv.y) * t.tangent, along(t)};
  }
  SurfaceSecond second(Vec2 uv) const override {
    const Turn t = turn(at_, uv.x);
    const double r = radius(uv.y);
    return {at(uv, t), r * t.tangent, along(t), -r * t.radial, (at_.unit * sine_) * t.tangent, {}};
  }
  double period_u() const override { return kTurn; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Cone>(*this); }
  std::optional<Vec2> project(Vec3 point, Vec2 guess) const override {
    const Vec3 p = local(at_, point);
    const double rho = std::hypot(p.x, p.y);
    // On the ruling in the point's half-plane, or on the one opposite if that is nearer: then the point is level with
    // the other nappe. The guess does not tell: near the apex its radius is a rounding error.
    const auto off = [&](double r) { return std::abs((r - radius_) * cosine_ - p.z * sine_); };
    const double side = off(-rho) < off(rho) ? -1 : 1;
    const double u = rho > 0 ? std::atan2(side * p.y, side * p.x) : guess.x;
    const double v = (side * rho - radius_) * sine_ + p.z * cosine_;
    return Vec2{nearest_turn(u, guess.x), v / at_.unit};
  }

 private:
  double radius(double v) const { return radius_ + at_.unit * v * sine_; }
  Vec3 at(Vec2 uv, const Turn& t) const {
    return at_.origin + radius(uv.y) * t.radial + (at_.unit * uv.y * cosine_) * at_.z;
  }
  Vec3 along(const Turn& t) const { return (at_.unit * sine_) * t.radial + (at_.unit * cosine_) * at_.z; }
  Placement at_;
  double radius_, sine_, cosine_;
};

/// A torus; a sphere where the major radius is zero.
class Torus final : public Surface {
 public:
  Torus(const Placement& at, SurfaceKind kind, double major, double minor)
      : at_(at), kind_(kind), major_(major), minor_(minor) {}
  SurfaceKind kind() const override { return kind_; }
  Vec3 value(Vec2 uv) const override {
    const Turn t = turn(at_, uv.x);
    return at_.origin + (major_ + minor_ * std::cos(uv.y)) * t.radial + (minor_ * std::sin(uv.y)) * at_.z;
  }
  SurfaceFirst first(Vec2 uv) const override {
    const SurfaceSecond s = second(uv);
    return {s.value, s.du, s.dv};
  }
  SurfaceSecond second(Vec2 uv) const override {
    const Turn t = turn(at_, uv.x);
    const double c = minor_ * std::cos(uv.y), s = minor_ * std::sin(uv.y), r = major_ + c;
    return {at_.origin + r * t.radial + s * at_.z,
            r * t.tangent,
            -s * t.radial + c * at_.z,
            -r * t.radial,
            -s * t.tangent,
            -c * t.radial - s * at_.z};
  }
  double period_u() const override { return kTurn; }
  double period_v() const override { return kind_ == SurfaceKind::torus ? kTurn : 0; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Torus>(*this); }
  std::optional<Vec2> project(Vec3 point, Vec2 guess) const override {
    const Vec3 p = local(at_, point);
    const double rho = std::hypot(p.x, p.y);
    // A spindle torus has a part of negative distance from the axis; stay on the guess's side.
    const double side = major_ + minor_ * std::cos(guess.y) < 0 && kind_ == SurfaceKind::torus ? -1 : 1;
    const double u = rho > 0 ? nearest_turn(std::atan2(side * p.y, side * p.x), guess.x) : guess.x;
    const double across = side * rho - major_;
    if (across == 0 && p.z == 0) return Vec2{u, guess.y};
    const double v = std::atan2(p.z, across);
    return Vec2{u, kind_ == SurfaceKind::torus ? nearest_turn(v, guess.y) : v};
  }

 private:
  Placement at_;
  SurfaceKind kind_;
  double major_, minor_;
};

class Line final : public Curve {
 public:
  Line(Vec3 origin, Vec3 step) : origin_(origin), step_(step) {}
  CurveKind kind() const override { return CurveKind::line; }
  Vec3 value(double t) const override { return origin_ + t * step_; }
  CurveSecond second(double t) const override { return {value(t), step_, {}}; }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<Line>(*this); }

 private:
  Vec3 origin_, step_;
};

class Ellipse final : public Curve {
 public:
  Ellipse(const Placement& at, double major, double minor)
      : at_(at), major_(major), minor_(minor), x_(major * at.x), y_(minor * at.y) {}
  CurveKind kind() const override { return major_ == minor_ ? CurveKind::circle : CurveKind::ellipse; }
  Vec3 value(double t) const override { return at_.origin + std::cos(t) * x_ + std::sin(t) * y_; }
  CurveSecond second(double t) const override {
    const double c = std::cos(t), s = std::sin(t);
    const Vec3 out = c * x_ + s * y_;
    return {at_.origin + out, c * y_ - s * x_, -out};
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<Ellipse>(*this); }

 private:
  Placement at_;
  double major_, minor_;
  Vec3 x_, y_;
};

class ParameterLine final : public ParameterCurve {
 public:
  ParameterLine(Vec2 origin, Vec2 direction) : origin_(origin), direction_(direction) {}
  Vec2 value(double t) const override { return origin_ + t * direction_; }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<ParameterLine>(*this); }

 private:
  Vec2 origin_, direction_;
};

class ParameterEllipse final : public ParameterCurve {
 public:
  ParameterEllipse(Vec2 origin, Vec2 x, Vec2 y) : origin_(origin), x_(x), y_(y) {}
  Vec2 value(double t) const override { return origin_ + std::cos(t) * x_ + std::sin(t) * y_; }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<ParameterEllipse>(*this); }

 private:
  Vec2 origin_, x_, y_;
};

}  // namespace

std::unique_ptr<Surface> make_plane(const Placement& at) { return std::make_unique<Plane>(at); }

std::unique_ptr<Surface> make_cylinder(const Placement& at, double radius) {
  return std::make_unique<Cone>(at, radius, 0.0, 1.0);
}

std::unique_ptr<Surface> make_cone(const Placement& at, double radius, double semi_angle) {
  return std::make_unique<Cone>(at, radius, std::sin(semi_angle), std::cos(semi_angle));
}

std::unique_ptr<Surface> make_sphere(const Placement& at, double radius) {
  auto sphere = std::make_unique<Torus>(at, SurfaceKind::sphere, 0.0, radius);
  sphere->set_domain({0, -kTurn / 4}, {kTurn, kTurn / 4});
  return sphere;
}

std::unique_ptr<Surface> make_torus(const Placement& at, double major, double minor) {
  return std::make_unique<Torus>(at, SurfaceKind::torus, major, minor);
}

std::unique_ptr<Curve> make_line(Vec3 origin, Vec3 direction, double unit) {
  return std::make_unique<Line>(origin, unit * direction);
}

std::unique_ptr<Curve> make_ellipse(const Placement& at, double major, double minor) {
  return std::make_unique<Ellipse>(at, major, minor);
}

std::unique_ptr<ParameterCurve> make_parameter_line(Vec2 origin, Vec2 direction) {
  return std::make_unique<ParameterLine>(origin, direction);
}

std::unique_ptr<ParameterCurve> make_parameter_ellipse(Vec2 origin, Vec2 x, Vec2 y) {
  return std::make_unique<ParameterEllipse>(origin, x, y);
}

}  // namespace curvetet
