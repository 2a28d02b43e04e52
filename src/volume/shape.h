// The shape measure that improvement maximises, and the best place of a vertex in its star.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/vec.h"

namespace curvetet {

/// Least sine of the six dihedral angles of a positive tet: in (0, 1), small for angles near 0 and near 180 degrees.
/// Not positive for a tet that is not. The sine at an edge is six volumes times its length over the product of the two
/// facets' doubled areas.
inline double least_sine(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const Vec3 nd = cross(u, v), nb = cross(v, w), nc = cross(w, u), na = nd + nb + nc;
  const double volume = dot(nd, w);
  if (!(volume > 0)) return volume < 0 ? -1 : 0;
  const double fa = norm2(na), fb = norm2(nb), fc = norm2(nc), fd = norm2(nd);
  const double least = std::min({norm2(u) / (fc * fd), norm2(v) / (fb * fd), norm2(w) / (fb * fc),
                                 norm2(c - b) / (fa * fd), norm2(d - b) / (fa * fc), norm2(d - c) / (fa * fb)});
  return volume * std::sqrt(least);
}

/// The facets that a vertex sees: with the vertex p, (a, b, c, p) is a tet of its star.
using StarFacets = std::vector<std::array<Vec3, 3>>;

/// Least least_sine of the tets that join p to the facets.
double worst_in_star(const StarFacets& facets, Vec3 p);

/// Moves p to where the worst tet of the star is best, by steps along the direction that improves all of the worst tets
/// at once (the shortest vector in the hull of their gradients; Freitag and Ollivier-Gooch 1997). The result is on the
/// grid, and the worst tet there is at least as good as at p. Ends after a fixed number of steps.
class StarOptimiser {
 public:
  Vec3 optimise(const StarFacets& facets, Vec3 p);

 private:
  void gradients_of_worst(const StarFacets& facets, Vec3 p, double step);
  Vec3 shortest_in_hull() const;

  std::vector<double> values_;
  std::vector<std::size_t> order_;
  std::vector<Vec3> gradients_;
};

}  // namespace curvetet
