// Measures in closed form, without a division by the volume where a nearly flat tet would make it useless: the radius
// ratio is 108 V^2 / (A |N|), where A is the sum of the facets' areas and N / (12 V) the vector from a vertex to the
// circumcentre. Dihedral angles come from the arc tangent of two products rather than from an arc cosine, which loses
// half of the digits at 0 and at 180 degrees, just where slivers are.
#include "quality/measures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/tet_complex.h"

namespace curvetet {
namespace {

/// Twelve times the volume, times the vector from a to the circumcentre. Arguments are relative to a.
Vec3 circumcentre_numerator(Vec3 b, Vec3 c, Vec3 d) {
  return norm2(b) * cross(c, d) + norm2(c) * cross(d, b) + norm2(d) * cross(b, c);
}

double six_volumes(Vec3 b, Vec3 c, Vec3 d) { return dot(cross(b, c), d); }

/// A dihedral angle as the arguments of an arc tangent.
struct Opening {
  double across = 0, along = 0;
};

double degrees(const Opening& opening) { return std::atan2(opening.across, opening.along) * (180 / std::numbers::pi); }

/// By kEdge. The two facets at edge e are those opposite to the vertices of edge 5 - e.
std::array<Opening, 6> dihedral_openings(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const std::array<Vec3, 4> p{a, b, c, d};
  const std::array<Vec3, 4> normals{cross(c - b, d - b), cross(d - a, c - a), cross(b - a, d - a), cross(c - a, b - a)};
  const double volume6 = std::abs(six_volumes(b - a, c - a, d - a));
  std::array<Opening, 6> openings;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto end = [&](std::size_t edge, std::size_t i) { return static_cast<std::size_t>(kEdge[edge][i]); };
    openings[e] = {distance(p[end(e, 0)], p[end(e, 1)]) * volume6,
                   -dot(normals[end(5 - e, 0)], normals[end(5 - e, 1)])};
  }
  return openings;
}

}  // namespace

double tet_volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) { return six_volumes(b - a, c - a, d - a) / 6; }

std::array<double, 6> dihedral_angles(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const std::array<Opening, 6> openings = dihedral_openings(a, b, c, d);
  std::array<double, 6> angles{};
  std::transform(openings.begin(), openings.end(), angles.begin(), degrees);
  return angles;
}

double smallest_dihedral(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  if (!(six_volumes(b - a, c - a, d - a) > 0)) return 0;
  const std::array<Opening, 6> openings = dihedral_openings(a, b, c, d);
  return degrees(*std::min_element(openings.begin(), openings.end(), [](const Opening& p, const Opening& q) {
    return p.across * q.along < q.across * p.along;  // both turn by less than half a turn
  }));
}

double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const double volume6 = six_volumes(b - a, c - a, d - a);
  if (!(volume6 > 0)) return 0;
  const double area = triangle_area(b, c, d) + triangle_area(a, c, d) + triangle_area(a, b, d) + triangle_area(a, b, c);
  const double product = area * norm(circumcentre_numerator(b - a, c - a, d - a));
  return product > 0 ? std::min(1.0, 3 * volume6 * volume6 / product) : 0;
}

double radius_edge_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const double shortest2 =
      std::min({norm2(b - a), norm2(c - a), norm2(d - a), norm2(c - b), norm2(d - b), norm2(d - c)});
  return distance(circumcentre(a, b, c, d), a) / std::sqrt(shortest2);
}

Vec3 circumcentre(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const double volume6 = six_volumes(b - a, c - a, d - a);
  return a + (1 / (2 * volume6)) * circumcentre_numerator(b - a, c - a, d - a);
}

Vec3 equatorial_centre(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, normal = cross(ab, ac);
  const Vec3 numerator = norm2(ac) * cross(normal, ab) + norm2(ab) * cross(ac, normal);
  return a + (1 / (2 * norm2(normal))) * numerator;
}

double triangle_area(Vec3 a, Vec3 b, Vec3 c) { return 0.5 * norm(cross(b - a, c - a)); }

double triangle_least_sine(Vec3 a, Vec3 b, Vec3 c) {
  std::array<double, 3> edges{distance(a, b), distance(b, c), distance(c, a)};
  std::sort(edges.begin(), edges.end());
  return edges[1] > 0 ? 2 * triangle_area(a, b, c) / (edges[1] * edges[2]) : 0;
}

}  // namespace curvetet
