// Point sets for tests of the kernel: random ones and the degenerate ones that CAD bodies are full of.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "mesh/vertex_store.h"

namespace curvetet::oracle {

inline Vec3 to_grid(Vec3 p) {
  const auto snap = [](double x) { return std::nearbyint(x * 0x1p42) * 0x1p-42; };
  return {snap(p.x), snap(p.y), snap(p.z)};
}

enum class PointSet { cube, cluster, sphere, cylinder, lattice, cube_corners, flat_and_apex, rotated_grid, skew_lines };
inline constexpr std::array kPointSets{PointSet::cube,          PointSet::cluster,      PointSet::sphere,
                                       PointSet::cylinder,      PointSet::lattice,      PointSet::cube_corners,
                                       PointSet::flat_and_apex, PointSet::rotated_grid, PointSet::skew_lines};
inline std::string name(PointSet set) {
  constexpr std::array<const char*, 9> names{"cube",         "cluster",       "sphere",       "cylinder",  "lattice",
                                             "cube_corners", "flat_and_apex", "rotated_grid", "skew_lines"};
  return names[static_cast<std::size_t>(set)];
}

/// Draws points of one kind; draws may repeat a place.
class PointSource {
 public:
  PointSource(PointSet set, std::uint64_t seed) : set_(set), random_(seed) {}

  Vec3 next() { return to_grid(draw()); }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  Vec3 draw() {
    switch (set_) {
      case PointSet::cube:
        return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      case PointSet::cluster:
        return Vec3{0.5, 0.25, -0.125} +
               uniform(0, 0x1p-35) * normalized(Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
      case PointSet::sphere:
        return 0.5 * normalized(Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
      case PointSet::cylinder: {
        const double angle = integer(0, 15) * 0.392699081698724;
        return {0.5 * std::cos(angle), 0.5 * std::sin(angle), integer(-8, 8) * 0.0625};
      }
      case PointSet::lattice:
        return {integer(0, 7) * 0.125, integer(0, 7) * 0.125, integer(0, 7) * 0.125};
      case PointSet::cube_corners:
        return {integer(-1, 1) * 0.5, integer(-1, 1) * 0.5, integer(-1, 1) * 0.5};
      case PointSet::flat_and_apex:
        return {integer(0, 9) * 0.1, integer(0, 9) * 0.1, integer(0, 9) == 0 ? 0.5 : 0.0};
      case PointSet::rotated_grid: {
        const Vec3 a{1.0 / 3, 2.0 / 3, 2.0 / 3}, b{-2.0 / 3, -1.0 / 3, 2.0 / 3}, c{2.0 / 3, -2.0 / 3, 1.0 / 3};
        return (0.1 * integer(0, 7)) * a + (0.1 * integer(0, 7)) * b + (0.3 * integer(0, 1)) * c;
      }
      case PointSet::skew_lines: {
        const double t = integer(0, 100) * 0.01;
        return integer(0, 1) == 0 ? Vec3{t, 0, 0} : Vec3{0, t, 0.5};
      }
    }
    return {};
  }

  PointSet set_;
  std::mt19937_64 random_;
};

/// A store of up to n different points of a kind, on the grid.
inline VertexStore make_store(PointSet set, std::size_t n, std::uint64_t seed) {
  PointSource source(set, seed);
  VertexStore store;
  std::set<std::array<double, 3>> seen;
  for (std::size_t draws = 0; draws < 20 * n && store.size() < n; ++draws) {
    const Vec3 p = source.next();
    if (seen.insert({p.x, p.y, p.z}).second) store.add(p, {}, {}, Origin::interior);
  }
  return store;
}

inline std::vector<VertexId> all_vertices(const VertexStore& store) {
  std::vector<VertexId> ids;
  for (std::size_t k = 0; k < store.size(); ++k) ids.emplace_back(k);
  return ids;
}

}  // namespace curvetet::oracle
