// Bodies as locked tetrahedralizations of solid 0, made without recovery: points on a convex surface, whose hull's
// facets are locked; or points on any surface with a box around, where tets go to the side their centroids are on.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "geometry/frame.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::test {

struct Body {
  VertexStore store;
  std::unique_ptr<Tetrahedralization> mesh;
};

/// The same vertices in the same places and the same tets in the same slots.
inline bool are_same(const Body& a, const Body& b) {
  const TetComplex &one = a.mesh->complex(), &other = b.mesh->complex();
  if (a.store.size() != b.store.size() || one.slots() != other.slots()) return false;
  for (std::size_t v = 0; v < a.store.size(); ++v)
    if (a.store.position(VertexId(v)) != b.store.position(VertexId(v))) return false;
  for (std::size_t t = 0; t < one.slots(); ++t) {
    if (one.is_alive(TetId(t)) != other.is_alive(TetId(t))) return false;
    if (one.is_alive(TetId(t)) && one.vertices(TetId(t)) != other.vertices(TetId(t))) return false;
  }
  return true;
}

/// A turn about an axis through no corner, so that points on flat and ruled faces are rounded off them.
inline Vec3 turned(Vec3 p) {
  const double c = std::cos(0.3), s = std::sin(0.3);
  p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}

/// The body of these surface points. `face_of` names the CAD face of a hull facet by its corners.
inline std::unique_ptr<Body> convex_body(const std::vector<Vec3>& points,
                                         const std::function<FaceId(Vec3, Vec3, Vec3)>& face_of) {
  auto body = std::make_unique<Body>();
  std::vector<VertexId> ids;
  for (const Vec3& p : points) ids.push_back(body->store.add(snap(p), Owner::of(FaceId(0)), {}, Origin::face_mesh));
  body->mesh = std::make_unique<Tetrahedralization>(body->store, 3);
  Context context;
  if (!body->mesh->build(ids, context).ok()) throw std::runtime_error("no tetrahedralization");
  TetComplex& complex = body->mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    complex.set_region(t, 1);
    for (int i = 0; i < 4; ++i) {
      if (!complex.is_ghost(complex.neighbour(t, i))) continue;
      const auto v = complex.facet_vertices({t, i});
      complex.lock({t, i}, face_of(body->store.position(v[0]), body->store.position(v[1]), body->store.position(v[2])));
    }
  }
  return body;
}

/// The body {distance < 0} with these points on its surface, within a box. Tets are inside where their centroid is,
/// flat ones on either side by rounding, and the facets between inside and outside are locked.
inline std::unique_ptr<Body> implicit_body(const std::vector<Vec3>& points, const std::function<double(Vec3)>& distance,
                                           const std::function<FaceId(Vec3, Vec3, Vec3)>& face_of) {
  auto body = std::make_unique<Body>();
  std::vector<VertexId> ids;
  for (const Vec3& p : points) ids.push_back(body->store.add(snap(p), Owner::of(FaceId(0)), {}, Origin::face_mesh));
  for (int k = 0; k < 8; ++k) {
    const Vec3 corner{k & 1 ? 0.875 : -0.875, k & 2 ? 0.875 : -0.875, k & 4 ? 0.875 : -0.875};
    ids.push_back(body->store.add(corner, Owner::of(FaceId(0)), {}, Origin::face_mesh));
  }
  body->mesh = std::make_unique<Tetrahedralization>(body->store, 3);
  Context context;
  if (!body->mesh->build(ids, context).ok()) throw std::runtime_error("no tetrahedralization");
  TetComplex& complex = body->mesh->complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.is_ghost(t)) continue;
    Vec3 sum;
    for (VertexId v : complex.vertices(t)) sum = sum + body->store.position(v);
    complex.set_region(t, distance(0.25 * sum) < 0 ? 1 : 0);
  }
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t) || complex.region(t) == 0) continue;
    for (int i = 0; i < 4; ++i) {
      if (complex.region(complex.neighbour(t, i)) != 0) continue;
      const auto v = complex.facet_vertices({t, i});
      complex.lock({t, i}, face_of(body->store.position(v[0]), body->store.position(v[1]), body->store.position(v[2])));
    }
  }
  return body;
}

/// Ball of radius r, points about h apart on a spiral.
inline std::unique_ptr<Body> ball_body(double r, double h) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const int n = std::max(12, static_cast<int>(4 * std::numbers::pi * r * r / (0.866 * h * h)));
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, s = std::sqrt(1 - z * z);
    points.push_back(r * Vec3{s * std::cos(golden * i), s * std::sin(golden * i), z});
  }
  return convex_body(points, [](Vec3, Vec3, Vec3) { return FaceId(0); });
}

/// Box with these half lengths, points on a lattice of about h on every face.
inline std::unique_ptr<Body> box_body(Vec3 half, double h) {
  const auto steps = [h](double length) { return std::max(1, static_cast<int>(std::lround(2 * length / h))); };
  const int nx = steps(half.x), ny = steps(half.y), nz = steps(half.z);
  std::vector<Vec3> points;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      for (int k = 0; k <= nz; ++k) {
        if (i > 0 && i < nx && j > 0 && j < ny && k > 0 && k < nz) continue;
        points.push_back({half.x * (2.0 * i / nx - 1), half.y * (2.0 * j / ny - 1), half.z * (2.0 * k / nz - 1)});
      }
    }
  }
  return convex_body(points, [](Vec3 a, Vec3 b, Vec3 c) {
    for (int axis = 0; axis < 3; ++axis) {
      if (a[axis] == b[axis] && b[axis] == c[axis]) return FaceId(2 * axis + (a[axis] > 0));
    }
    return FaceId(6);
  });
}

/// Cylinder, turned: rings on the side (face 0), a lattice on the caps (faces 1 and 2), all with rounded coordinates,
/// so that there are flat tets on every face.
inline std::unique_ptr<Body> cylinder_body(double r, double height, double h) {
  std::vector<Vec3> points;
  const int n = static_cast<int>(std::lround(2 * std::numbers::pi * r / h));
  const int nz = std::max(1, static_cast<int>(std::lround(height / h)));
  for (int k = 0; k <= nz; ++k) {
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * i / n;
      points.push_back(turned({r * std::cos(a), r * std::sin(a), height * (static_cast<double>(k) / nz - 0.5)}));
    }
  }
  const int m = static_cast<int>(r / h);
  for (int i = -m; i <= m; ++i) {
    for (int j = -m; j <= m; ++j) {
      if (std::hypot(i * h, j * h) > r - 0.6 * h) continue;
      for (double z : {-height / 2, height / 2}) points.push_back(turned({i * h, j * h, z}));
    }
  }
  const Vec3 axis = turned({0, 0, 1});
  const auto distance = [=](Vec3 p) {
    const double z = dot(p, axis);
    return std::max(norm(p - z * axis) - r, std::abs(z) - height / 2);
  };
  return implicit_body(points, distance, [=](Vec3 a, Vec3 b, Vec3 c) {
    const double za = dot(a, axis), zb = dot(b, axis), zc = dot(c, axis), end = height / 2 - 1e-6;
    if (std::min({za, zb, zc}) > end) return FaceId(1);
    if (std::max({za, zb, zc}) < -end) return FaceId(2);
    return FaceId(0);
  });
}

/// Torus about the z axis.
inline std::unique_ptr<Body> torus_body(double major, double minor, double h) {
  std::vector<Vec3> points;
  const int n = static_cast<int>(std::lround(2 * std::numbers::pi * major / h));
  const int m = 2 * std::max(3, static_cast<int>(std::lround(std::numbers::pi * minor / (0.866 * h))));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * (i + 0.5 * (j % 2)) / n, b = 2 * std::numbers::pi * j / m;
      const double s = major + minor * std::cos(b);
      points.push_back({s * std::cos(a), s * std::sin(a), minor * std::sin(b)});
    }
  }
  const auto distance = [=](Vec3 p) { return std::hypot(std::hypot(p.x, p.y) - major, p.z) - minor; };
  return implicit_body(points, distance, [](Vec3, Vec3, Vec3) { return FaceId(0); });
}

}  // namespace curvetet::test
