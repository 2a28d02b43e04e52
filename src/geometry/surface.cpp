// Differential geometry that every surface and curve shares.
//
// Normals at poles: there du x dv vanishes, and its sign on the two sides of the pole differs (a sphere's
// parametrisation continues over the pole inside out). So the limit is taken from the side of the trimmed domain, which
// the surface is told. Taking a limit through second derivatives was rejected: it fails where those vanish too
// (collapsed rows of a B-spline).
#include "geometry/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace curvetet {
namespace {

constexpr double kCollapsed = 1e-9;
constexpr int kProjectionSteps = 60;
/// Working length: the noise of a body ten thousand of its diagonals away from the origin, and some more.
constexpr double kNoise = 1e-10;

/// The unit normal unless the derivatives collapse; extents make du and dv comparable.
std::optional<Vec3> plain_normal(Vec3 du, Vec3 dv, double extent_u, double extent_v) {
  const double length_u = norm(du) * extent_u;
  const double length_v = norm(dv) * extent_v;
  const double longest = std::max(length_u, length_v);
  if (!(longest > 0) || !std::isfinite(longest)) return std::nullopt;
  if (std::min(length_u, length_v) <= kCollapsed * longest) return std::nullopt;
  const Vec3 n = cross(normalized(du), normalized(dv));
  const double sine = norm(n);
  if (!(sine > kCollapsed)) return std::nullopt;
  return (1 / sine) * n;
}

double extent(double low, double high) {
  const double length = high - low;
  return std::isfinite(length) && length > 0 ? length : 1;
}

/// One step of the given relative size from x towards the middle of the domain.
double inward(double x, double low, double high, double relative) {
  const double step = relative * extent(low, high);
  const double middle = 0.5 * (low + high);
  return std::isfinite(middle) && x > middle ? x - step : x + step;
}

struct Normal2 {
  double a = 0, b = 0, c = 0;  // symmetric matrix (a b; b c)
  double determinant() const { return a * c - b * b; }
};

/// Solves the damped 2x2 system; empty when singular.
std::optional<Vec2> solve(Normal2 m, double damping, Vec2 right) {
  m.a *= 1 + damping;
  m.c *= 1 + damping;
  const double det = m.determinant();
  if (!(std::abs(det) > 1e-300) || det < 1e-14 * m.a * m.c) return std::nullopt;
  return Vec2{(m.c * right.x - m.b * right.y) / det, (m.a * right.y - m.b * right.x) / det};
}

}  // namespace

const char* name(SurfaceKind kind) {
  static constexpr std::array names{"plane",   "cylinder",   "cone",      "sphere", "torus", "bezier",
                                    "bspline", "revolution", "extrusion", "offset", "other"};
  return names[static_cast<std::size_t>(kind)];
}

const char* name(CurveKind kind) {
  static constexpr std::array names{"line", "circle", "ellipse", "bspline", "other"};
  return names[static_cast<std::size_t>(kind)];
}

Vec3 Surface::normal(Vec2 uv) const {
  const double extent_u = extent(low_.x, high_.x);
  const double extent_v = extent(low_.y, high_.y);
  const SurfaceFirst here = first(uv);
  if (const auto n = plain_normal(here.du, here.dv, extent_u, extent_v)) return *n;
  // Towards v first (a pole of most surfaces is a row of constant v), then towards u, then both.
  for (const double relative : {1e-6, 1e-4, 1e-2}) {
    const double u = inward(uv.x, low_.x, high_.x, relative);
    const double v = inward(uv.y, low_.y, high_.y, relative);
    for (const Vec2 near : {Vec2{uv.x, v}, Vec2{u, uv.y}, Vec2{u, v}}) {
      const SurfaceFirst there = first(near);
      if (const auto n = plain_normal(there.du, there.dv, extent_u, extent_v)) return *n;
    }
  }
  return {};
}

std::optional<Vec2> Surface::project(Vec3 point, Vec2 guess) const {
  Vec2 uv = guess;
  SurfaceSecond s = second(uv);
  if (!finite(s.value)) return std::nullopt;
  double damping = 0, moved = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kProjectionSteps; ++step) {
    const Vec3 r = s.value - point;
    const Vec2 gradient{dot(s.du, r), dot(s.dv, r)};
    const double size_u = norm(s.du), size_v = norm(s.dv);
    // Orthogonal to both derivatives up to rounding, or on the surface.
    const double distance_now = norm(r);
    const double small = 1e-13 * distance_now + 1e-16;
    if (std::abs(gradient.x) <= small * size_u && std::abs(gradient.y) <= small * size_v) return uv;
    const Normal2 gauss{norm2(s.du), dot(s.du, s.dv), norm2(s.dv)};
    Normal2 newton{gauss.a + dot(s.duu, r), gauss.b + dot(s.duv, r), gauss.c + dot(s.dvv, r)};
    const bool convex = newton.a > 0 && newton.c > 0 && newton.determinant() > 1e-8 * gauss.a * gauss.c;
    const Normal2 matrix = convex ? newton : gauss;
    auto move = solve(matrix, damping, gradient);
    if (!move) {  // a collapsed derivative: descend in the other direction only
      move = Vec2{matrix.a > 0 ? gradient.x / matrix.a : 0, matrix.c > 0 ? gradient.y / matrix.c : 0};
      if (size_u < kCollapsed * size_v) move->x = 0;
      if (size_v < kCollapsed * size_u) move->y = 0;
    }
    const Vec2 next = uv - *move;
    if (!std::isfinite(next.x) || !std::isfinite(next.y)) return std::nullopt;
    const SurfaceSecond there = second(next);
    const double distance_next = distance(there.value, point);
    moved = size_u * std::abs(move->x) + size_v * std::abs(move->y);
    if (distance_next <= distance_now * (1 + 1e-15)) {
      uv = next;
      s = there;
      damping = damping < 1e-6 ? 0 : damping / 10;
      if (moved <= 1e-15 + 1e-13 * distance_next) return uv;
    } else {
      if (moved <= 1e-13) return uv;  // at the limit of rounding: no step of any length improves
      damping = damping == 0 ? 1e-3 : damping * 10;
      if (damping > 1e12) return std::nullopt;
    }
  }
  // Far from the origin of its coordinates a body's values are noisy: steps of that size never end.
  return moved * (1 + damping) <= kNoise ? std::optional(uv) : std::nullopt;
}

Vec2 Surface::curvatures(Vec2 uv) const {
  const SurfaceSecond s = second(uv);
  const Vec3 n = cross(s.du, s.dv);
  const double area = norm(n);
  if (!(area > kCollapsed * norm(s.du) * norm(s.dv)) || !(area > 0)) return {};
  const Vec3 unit = (1 / area) * n;
  const double E = norm2(s.du), F = dot(s.du, s.dv), G = norm2(s.dv);
  const double L = dot(unit, s.duu), M = dot(unit, s.duv), N = dot(unit, s.dvv);
  const double det = area * area;
  const double mean = (E * N - 2 * F * M + G * L) / (2 * det);
  const double gauss = (L * N - M * M) / det;
  const double spread = std::sqrt(std::max(0.0, mean * mean - gauss));
  const double one = std::abs(mean + spread), two = std::abs(mean - spread);
  if (!std::isfinite(one) || !std::isfinite(two)) return {};
  return {std::max(one, two), std::min(one, two)};
}

double Curve::curvature(double t) const {
  const CurveSecond c = second(t);
  const double speed = norm(c.dt);
  if (!(speed > 0)) return 0;
  const double k = norm(cross(c.dt, c.dtt)) / (speed * speed * speed);
  return std::isfinite(k) ? k : 0;
}

double Curve::project(Vec3 point, double guess, double low, double high) const {
  double t = std::clamp(guess, low, high);
  CurveSecond c = second(t);
  double damping = 0;
  for (int step = 0; step < kProjectionSteps; ++step) {
    const Vec3 r = c.value - point;
    const double gradient = dot(c.dt, r);
    const double gauss = norm2(c.dt);
    if (!(gauss > 0)) return t;
    const double newton = gauss + dot(c.dtt, r);
    const double slope = (newton > 1e-3 * gauss ? newton : gauss) * (1 + damping);
    const double next = std::clamp(t - gradient / slope, low, high);
    if (next == t) return t;
    const CurveSecond there = second(next);
    if (distance(there.value, point) <= norm(r)) {
      const bool done = std::abs(next - t) * std::sqrt(gauss) <= 1e-15;
      t = next;
      c = there;
      damping = 0;
      if (done) return t;
    } else {
      if (std::abs(next - t) * std::sqrt(gauss) <= 1e-14) return t;
      damping = damping == 0 ? 1 : damping * 4;
    }
  }
  return t;
}

}  // namespace curvetet
