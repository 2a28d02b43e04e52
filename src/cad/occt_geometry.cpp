// OpenCASCADE's adaptors cache the span they evaluated last: fast, and the reason why an evaluator must not be shared
// between threads.
#include "cad/occt_geometry.h"

#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <cmath>
#include <limits>

#include "geometry/analytic.h"

namespace curvetet {
namespace {

Vec3 vec(const gp_Vec& v) { return {v.X(), v.Y(), v.Z()}; }
Vec3 vec(const gp_Dir& v) { return {v.X(), v.Y(), v.Z()}; }
Vec2 vec(const gp_XY& v) { return {v.X(), v.Y()}; }

Vec3 working(const Frame& frame, const gp_Pnt& p) { return frame.to_working(to_vec(p.XYZ())); }

Placement placement(const gp_Ax3& axes, const Frame& frame) {
  Placement at;
  at.origin = working(frame, axes.Location());
  at.x = vec(axes.XDirection());
  at.y = vec(axes.YDirection());
  at.z = vec(axes.Direction());
  at.unit = frame.scale;
  return at;
}

SurfaceKind kind_of(GeomAbs_SurfaceType type) {
  switch (type) {
    case GeomAbs_Plane:
      return SurfaceKind::plane;
    case GeomAbs_Cylinder:
      return SurfaceKind::cylinder;
    case GeomAbs_Cone:
      return SurfaceKind::cone;
    case GeomAbs_Sphere:
      return SurfaceKind::sphere;
    case GeomAbs_Torus:
      return SurfaceKind::torus;
    case GeomAbs_BezierSurface:
      return SurfaceKind::bezier;
    case GeomAbs_BSplineSurface:
      return SurfaceKind::bspline;
    case GeomAbs_SurfaceOfRevolution:
      return SurfaceKind::revolution;
    case GeomAbs_SurfaceOfExtrusion:
      return SurfaceKind::extrusion;
    case GeomAbs_OffsetSurface:
      return SurfaceKind::offset;
    default:
      return SurfaceKind::other;
  }
}

/// One parameter direction: its range, and its period if it closes.
struct Range {
  double low = 0, high = 0, period = 0;
  /// Where to evaluate: within one period for a surface that closes without being periodic.
  double inside(double x) const {
    if (period == 0 || (x >= low && x <= high)) return x;
    const double turns = std::floor((x - low) / period);
    return std::min(std::max(x - turns * period, low), high);
  }
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3 kNowhere{kNan, kNan, kNan};

/// The kernel throws where an offset has no place, or no derivative, for what it is offset from has no normal there.
template <typename Evaluate, typename Otherwise>
auto where_defined(Evaluate evaluate, Otherwise otherwise) {
  try {
    return evaluate();
  } catch (const Standard_Failure&) {
    return otherwise();
  }
}

class OcctSurface final : public Surface {
 public:
  OcctSurface(const Handle(Geom_Surface) & surface, const Frame& frame)
      : surface_(surface), adaptor_(surface), frame_(frame), kind_(kind_of(adaptor_.GetType())) {
    u_ = {adaptor_.FirstUParameter(), adaptor_.LastUParameter(), 0};
    v_ = {adaptor_.FirstVParameter(), adaptor_.LastVParameter(), 0};
    if (adaptor_.IsUPeriodic()) {
      u_.period = adaptor_.UPeriod();
    } else if (adaptor_.IsUClosed()) {
      u_.period = u_.high - u_.low;
    }
    if (adaptor_.IsVPeriodic()) {
      v_.period = adaptor_.VPeriod();
    } else if (adaptor_.IsVClosed()) {
      v_.period = v_.high - v_.low;
    }
    if (!std::isfinite(u_.period) || u_.period > 1e50) u_.period = 0;
    if (!std::isfinite(v_.period) || v_.period > 1e50) v_.period = 0;
  }
  OcctSurface(const OcctSurface& other)
      : Surface(other),
        surface_(other.surface_),
        adaptor_(other.surface_),
        frame_(other.frame_),
        kind_(other.kind_),
        u_(other.u_),
        v_(other.v_) {}
  OcctSurface& operator=(const OcctSurface&) = delete;

  SurfaceKind kind() const override { return kind_; }
  Vec3 value(Vec2 uv) const override {
    return where_defined([&] { return working(frame_, adaptor_.Value(u_.inside(uv.x), v_.inside(uv.y))); },
                         [] { return kNowhere; });
  }
  SurfaceFirst first(Vec2 uv) const override {
    const auto evaluate = [&]() -> SurfaceFirst {
      gp_Pnt p;
      gp_Vec du, dv;
      adaptor_.D1(u_.inside(uv.x), v_.inside(uv.y), p, du, dv);
      return {working(frame_, p), scaled(du), scaled(dv)};
    };
    return where_defined(evaluate, [&] { return SurfaceFirst{value(uv), {}, {}}; });
  }
  SurfaceSecond second(Vec2 uv) const override {
    const auto evaluate = [&]() -> SurfaceSecond {
      gp_Pnt p;
      gp_Vec du, dv, duu, dvv, duv;
      adaptor_.D2(u_.inside(uv.x), v_.inside(uv.y), p, du, dv, duu, dvv, duv);
      return {working(frame_, p), scaled(du), scaled(dv), scaled(duu), scaled(duv), scaled(dvv)};
    };
    return where_defined(evaluate, [&] {
      const SurfaceFirst lower = first(uv);
      return SurfaceSecond{lower.value, lower.du, lower.dv, {}, {}, {}};
    });
  }
  double period_u() const override { return u_.period; }
  double period_v() const override { return v_.period; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<OcctSurface>(*this); }

 private:
  Vec3 scaled(const gp_Vec& v) const { return frame_.scale * vec(v); }
  Handle(Geom_Surface) surface_;
  GeomAdaptor_Surface adaptor_;
  Frame frame_;
  SurfaceKind kind_;
  Range u_, v_;
};

class OcctCurve final : public Curve {
 public:
  OcctCurve(const Handle(Geom_Curve) & curve, const Frame& frame) : curve_(curve), adaptor_(curve), frame_(frame) {}
  OcctCurve(const OcctCurve& other)
      : Curve(other), curve_(other.curve_), adaptor_(other.curve_), frame_(other.frame_) {}
  OcctCurve& operator=(const OcctCurve&) = delete;

  CurveKind kind() const override {
    return adaptor_.GetType() == GeomAbs_BSplineCurve ? CurveKind::bspline : CurveKind::other;
  }
  Vec3 value(double t) const override {
    return where_defined([&] { return working(frame_, adaptor_.Value(t)); }, [] { return kNowhere; });
  }
  CurveSecond second(double t) const override {
    const auto evaluate = [&]() -> CurveSecond {
      gp_Pnt p;
      gp_Vec d, dd;
      adaptor_.D2(t, p, d, dd);
      return {working(frame_, p), frame_.scale * vec(d), frame_.scale * vec(dd)};
    };
    return where_defined(evaluate, [&] { return CurveSecond{value(t), {}, {}}; });
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<OcctCurve>(*this); }

 private:
  Handle(Geom_Curve) curve_;
  GeomAdaptor_Curve adaptor_;
  Frame frame_;
};

class OcctParameterCurve final : public ParameterCurve {
 public:
  OcctParameterCurve(const Handle(Geom2d_Curve) & curve, const ParameterMap& map)
      : curve_(curve), adaptor_(curve), map_(map) {}
  OcctParameterCurve(const OcctParameterCurve& other)
      : ParameterCurve(other), curve_(other.curve_), adaptor_(other.curve_), map_(other.map_) {}
  OcctParameterCurve& operator=(const OcctParameterCurve&) = delete;

  Vec2 value(double t) const override {
    return where_defined([&] { return vec(adaptor_.Value(map_.scale * t + map_.offset).XY()) + map_.shift; },
                         [] {
                           return Vec2{kNan, kNan};
                         });
  }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<OcctParameterCurve>(*this); }

 private:
  Handle(Geom2d_Curve) curve_;
  Geom2dAdaptor_Curve adaptor_;
  ParameterMap map_;
};

// A trimmed curve or surface has the parametrisation of its basis.

Handle(Geom_Surface) basis_of(Handle(Geom_Surface) surface) {
  while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface)) {
    surface = trimmed->BasisSurface();
  }
  return surface;
}

Handle(Geom_Curve) basis_of(Handle(Geom_Curve) curve) {
  while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
  return curve;
}

Handle(Geom2d_Curve) basis_of(Handle(Geom2d_Curve) curve) {
  while (const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
  return curve;
}

}  // namespace

Vec3 to_vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

std::unique_ptr<Surface> make_surface(const Handle(Geom_Surface) & surface, const Frame& frame) {
  const Handle(Geom_Surface) basis = basis_of(surface);
  if (const auto plane = Handle(Geom_Plane)::DownCast(basis)) return make_plane(placement(plane->Position(), frame));
  if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(basis)) {
    return make_cylinder(placement(cylinder->Position(), frame), frame.length_to_working(cylinder->Radius()));
  }
  if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(basis)) {
    return make_cone(placement(cone->Position(), frame), frame.length_to_working(cone->RefRadius()), cone->SemiAngle());
  }
  if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(basis)) {
    return make_sphere(placement(sphere->Position(), frame), frame.length_to_working(sphere->Radius()));
  }
  if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(basis)) {
    return make_torus(placement(torus->Position(), frame), frame.length_to_working(torus->MajorRadius()),
                      frame.length_to_working(torus->MinorRadius()));
  }
  return std::make_unique<OcctSurface>(basis, frame);
}

std::unique_ptr<Curve> make_curve(const Handle(Geom_Curve) & curve, const Frame& frame) {
  const Handle(Geom_Curve) basis = basis_of(curve);
  if (const auto line = Handle(Geom_Line)::DownCast(basis)) {
    const gp_Ax1& at = line->Position();
    return make_line(working(frame, at.Location()), vec(at.Direction()), frame.scale);
  }
  if (const auto circle = Handle(Geom_Circle)::DownCast(basis)) {
    const double radius = frame.length_to_working(circle->Radius());
    return make_ellipse(placement(gp_Ax3(circle->Position()), frame), radius, radius);
  }
  if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(basis)) {
    return make_ellipse(placement(gp_Ax3(ellipse->Position()), frame), frame.length_to_working(ellipse->MajorRadius()),
                        frame.length_to_working(ellipse->MinorRadius()));
  }
  return std::make_unique<OcctCurve>(basis, frame);
}

std::unique_ptr<ParameterCurve> make_parameter_curve(const Handle(Geom2d_Curve) & curve, const ParameterMap& map) {
  const Handle(Geom2d_Curve) basis = basis_of(curve);
  if (const auto line = Handle(Geom2d_Line)::DownCast(basis)) {
    const Vec2 origin = vec(line->Location().XY()), direction = vec(line->Direction().XY());
    return make_parameter_line(origin + map.offset * direction + map.shift, map.scale * direction);
  }
  if (map.scale == 1 && map.offset == 0) {
    if (const auto circle = Handle(Geom2d_Circle)::DownCast(basis)) {
      const gp_Ax22d axes = circle->Position();
      return make_parameter_ellipse(vec(axes.Location().XY()) + map.shift,
                                    circle->Radius() * vec(axes.XDirection().XY()),
                                    circle->Radius() * vec(axes.YDirection().XY()));
    }
    if (const auto ellipse = Handle(Geom2d_Ellipse)::DownCast(basis)) {
      const gp_Ax22d axes = ellipse->Position();
      return make_parameter_ellipse(vec(axes.Location().XY()) + map.shift,
                                    ellipse->MajorRadius() * vec(axes.XDirection().XY()),
                                    ellipse->MinorRadius() * vec(axes.YDirection().XY()));
    }
  }
  return std::make_unique<OcctParameterCurve>(basis, map);
}

}  // namespace curvetet
