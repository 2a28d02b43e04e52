// The analytic surfaces and curves by our own formulas, with the parametrisation of STEP (ISO 10303-42), which is also
// OpenCASCADE's: angles in radians, lengths in the CAD's unit. Values are in working coordinates.
#pragma once

#include <memory>

#include "geometry/surface.h"

namespace curvetet {

/// Where an analytic curve or surface sits: a point and three orthonormal directions in working coordinates. The third
/// direction may be minus the product of the first two (a mirrored part).
struct Placement {
  Vec3 origin{};
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  double unit = 1;  ///< working length of one CAD unit (Frame::scale); scales the parameters that are lengths
};

/// origin + u x + v y.
std::unique_ptr<Surface> make_plane(const Placement& at);
/// origin + radius (cos u x + sin u y) + v z. Radii are working lengths here and below.
std::unique_ptr<Surface> make_cylinder(const Placement& at, double radius);
/// origin + (radius + v sin a)(cos u x + sin u y) + v cos a z; the apex is at v = -radius / sin a.
std::unique_ptr<Surface> make_cone(const Placement& at, double radius, double semi_angle);
/// origin + radius cos v (cos u x + sin u y) + radius sin v z.
std::unique_ptr<Surface> make_sphere(const Placement& at, double radius);
/// origin + (major + minor cos v)(cos u x + sin u y) + minor sin v z.
std::unique_ptr<Surface> make_torus(const Placement& at, double major, double minor);

/// origin + t direction (times the unit); `direction` is a unit vector in working coordinates.
std::unique_ptr<Curve> make_line(Vec3 origin, Vec3 direction, double unit = 1);
/// origin + major cos t x + minor sin t y; a circle if both are alike.
std::unique_ptr<Curve> make_ellipse(const Placement& at, double major, double minor);

/// origin + t direction in the parameter plane.
std::unique_ptr<ParameterCurve> make_parameter_line(Vec2 origin, Vec2 direction);
/// origin + cos t x + sin t y in the parameter plane.
std::unique_ptr<ParameterCurve> make_parameter_ellipse(Vec2 origin, Vec2 x, Vec2 y);

}  // namespace curvetet
