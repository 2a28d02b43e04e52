// Inputs for the tests of face meshes: closed and open chains, with a vertex id per node.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "planar/face_mesh.h"

namespace curvetet::testing {

inline double on_grid(double x) { return std::nearbyint(x * 0x1p42) * 0x1p-42; }
inline Vec2 on_grid(Vec2 q) { return {on_grid(q.x), on_grid(q.y)}; }

/// A closed loop of one chain through the points, with vertex ids from `first` on.
inline LoopInput closed_loop(std::vector<Vec2> points, std::uint32_t first, std::int32_t use = 0) {
  ChainInput chain;
  chain.use = use;
  for (std::size_t i = 0; i <= points.size(); ++i) {
    const std::size_t k = i % points.size();
    chain.vertices.push_back(VertexId(first + static_cast<std::uint32_t>(k)));
    chain.q.push_back(on_grid(points[k]));
  }
  return {{chain}, false};
}

inline LoopInput open_chain(std::vector<std::pair<std::uint32_t, Vec2>> points, std::int32_t use) {
  ChainInput chain;
  chain.use = use;
  chain.two_sided = true;
  for (const auto& [v, q] : points) {
    chain.vertices.push_back(VertexId(v));
    chain.q.push_back(on_grid(q));
  }
  return {{chain}, true};
}

inline std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// Counter-clockwise.
inline std::vector<Vec2> circle(Vec2 centre, double radius, int n, double turn = 0) {
  std::vector<Vec2> out;
  for (int i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * i / n + turn;
    out.push_back(centre + radius * Vec2{std::cos(t), std::sin(t)});
  }
  return out;
}

inline std::vector<Vec2> reversed(std::vector<Vec2> points) { return {points.rbegin(), points.rend()}; }

inline double area(const FaceMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& f = mesh.triangle(TriangleId(t));
    if (!f.alive()) continue;
    const Vec2 a = mesh.node(f.node[0]).q;
    sum += 0.5 * cross(mesh.node(f.node[1]).q - a, mesh.node(f.node[2]).q - a);
  }
  return sum;
}

}  // namespace curvetet::testing
