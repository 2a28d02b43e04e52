// Analytic bodies as Models, built without a CAD kernel, for the tests of every room. Lengths are CAD units (mm);
// bodies of revolution have the z axis, seams at u = 0, and one vertex per circle, as a CAD kernel would make them.
#pragma once

#include <vector>

#include "geometry/model.h"

namespace curvetet::test {

/// Axis-aligned box with a corner at the origin.
Model make_box(double x, double y, double z);
/// Boxes side by side along x that share faces: one solid per length.
Model make_boxes(const std::vector<double>& lengths, double y, double z);
/// Ball: one face, a seam and two poles.
Model make_ball(double radius);
/// Ball with a ball-shaped hole: two faces that never meet.
Model make_shell(double outer, double inner);
Model make_cylinder(double radius, double height);
/// Cone or frustum; the apex is a pole where the top radius is zero.
Model make_cone(double bottom, double top, double height);
/// One face with two seams.
Model make_torus(double major, double minor);
/// No body, since its faces cross: a ball with a hole, shaped as a cylinder, that sticks out of it on both sides;
/// around it, if given, a sound ball with a cavity, shaped as a cylinder, that leaves a wall between its rims and the
/// outside.
Model make_pierced_ball(double ball, double radius, double height, double outer = 0, double wall = 0);
/// Cylinder with a coaxial bore: plane faces with two loops.
Model make_tube(double outer, double inner, double height);
/// Two spherical caps that meet in a sharp circle; `half_thickness` < radius of the rim.
Model make_lens(double rim, double half_thickness);
/// The half with y > 0 of a ball of radius b stretched to the half length a > b along x, as a CAD kernel makes it: the
/// poles, at z = -b and b, lie on the rim of the flat face.
Model make_half_ellipsoid(double a, double b);
/// Ball of one solid inside another: the inner face has a solid on either side.
Model make_nested_balls(double outer, double inner);

}  // namespace curvetet::test
