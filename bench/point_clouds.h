// Point clouds for the kernel's benchmarks: random ones, and those that CAD bodies bring.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "mesh/vertex_store.h"

namespace curvetet::bench {

enum class Cloud { cube, sphere, cylinder, torus, lattice, plane_grids };

inline const char* name(Cloud cloud) {
  constexpr const char* names[] = {"cube", "sphere", "cylinder", "torus", "lattice", "plane_grids"};
  return names[static_cast<int>(cloud)];
}

inline Vec3 to_grid(Vec3 p) {
  const auto snap = [](double x) { return std::nearbyint(x * 0x1p42) * 0x1p-42; };
  return {snap(p.x), snap(p.y), snap(p.z)};
}

/// About n points: random in a cube or on a surface; an axis-parallel lattice; two parallel grids in a rotated plane.
inline std::vector<Vec3> make_cloud(Cloud cloud, std::size_t n) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  const auto add = [&](Vec3 p) { points.push_back(to_grid(p)); };
  if (cloud == Cloud::lattice) {
    const int m = static_cast<int>(std::cbrt(static_cast<double>(n)) + 0.5);
    for (int k = 0; k < m * m * m; ++k) add(0x1p-7 * Vec3{double(k % m), double(k / m % m), double(k / m / m)});
    return points;
  }
  if (cloud == Cloud::plane_grids) {
    const Vec3 a{1.0 / 3, 2.0 / 3, 2.0 / 3}, b{-2.0 / 3, -1.0 / 3, 2.0 / 3}, c{2.0 / 3, -2.0 / 3, 1.0 / 3};
    const int m = static_cast<int>(std::sqrt(0.5 * static_cast<double>(n)));
    for (int k = 0; k < 2 * m * m; ++k)
      add((0.7 / m * (k % m)) * a + (0.7 / m * (k / m % m)) * b + (0.05 * (k / m / m)) * c);
    return points;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const double u = std::numbers::pi * uniform(random), v = std::numbers::pi * uniform(random), w = uniform(random);
    switch (cloud) {
      case Cloud::sphere:
        add(0.9 * normalized(Vec3{normal(random), normal(random), normal(random)}));
        break;
      case Cloud::cylinder:
        add({0.3 * std::cos(u), 0.3 * std::sin(u), w});
        break;
      case Cloud::torus: {
        const double r = 0.6 + 0.2 * std::cos(v);
        add({r * std::cos(u), r * std::sin(u), 0.2 * std::sin(v)});
        break;
      }
      default:
        add({u / std::numbers::pi, v / std::numbers::pi, w});
        break;
    }
  }
  return points;
}

inline VertexStore make_store(const std::vector<Vec3>& points) {
  VertexStore store;
  for (const Vec3 p : points) store.add(p, {}, {}, Origin::interior);
  return store;
}

inline std::vector<VertexId> all_vertices(const VertexStore& store) {
  std::vector<VertexId> ids;
  for (std::size_t k = 0; k < store.size(); ++k) ids.emplace_back(k);
  return ids;
}

}  // namespace curvetet::bench
