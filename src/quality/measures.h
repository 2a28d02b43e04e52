// Measures of tets and triangles. All take working or CAD coordinates alike: they are scale-free unless said.
#pragma once

#include <array>

#include "base/vec.h"

namespace curvetet {

double tet_volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d);                      ///< signed, length cubed
std::array<double, 6> dihedral_angles(Vec3 a, Vec3 b, Vec3 c, Vec3 d);  ///< degrees, by kEdge
double smallest_dihedral(Vec3 a, Vec3 b, Vec3 c, Vec3 d);               ///< degrees; 0 for a flat or inverted tet
double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d);                    ///< 3 r / R in [0,1]; 0 for flat or inverted
double radius_edge_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d);               ///< circumradius over shortest edge
/// Circumcentre; not finite for a flat tet.
Vec3 circumcentre(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
/// Centre of the smallest sphere through three points.
Vec3 equatorial_centre(Vec3 a, Vec3 b, Vec3 c);
double triangle_area(Vec3 a, Vec3 b, Vec3 c);
/// Of the angles of a triangle: twice its area over the product of the two longer edges. 0 for a degenerate one.
double triangle_least_sine(Vec3 a, Vec3 b, Vec3 c);

}  // namespace curvetet
