// Levenberg-Marquardt with the full second derivatives where they make the matrix positive definite, Gauss-Newton's
// otherwise.
//
// Alternating projections were tried first and rejected: between two nearly parallel sheets, which is what a thin gap
// is, they shorten the way to the closest pair by a factor of about 1 - gap / radius per step.

#include "sizing/closest_pair.h"

#include <array>

namespace curvetet::sizing {

namespace {

constexpr int kSteps = 12;

using Vec4 = std::array<double, 4>;
using Mat4 = std::array<Vec4, 4>;

/// Solves by Cholesky's factors; empty unless the matrix is positive definite.
std::optional<Vec4> solve_definite(Mat4 m, Vec4 right) {
  for (std::size_t j = 0; j < 4; ++j) {
    const double before = m[j][j];
    for (std::size_t k = 0; k < j; ++k) m[j][j] -= m[j][k] * m[j][k];
    if (!(m[j][j] > 1e-13 * before)) return std::nullopt;
    m[j][j] = std::sqrt(m[j][j]);
    for (std::size_t i = j + 1; i < 4; ++i) {
      for (std::size_t k = 0; k < j; ++k) m[i][j] -= m[i][k] * m[j][k];
      m[i][j] /= m[j][j];
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < i; ++k) right[i] -= m[i][k] * right[k];
    right[i] /= m[i][i];
  }
  for (std::size_t i = 4; i-- > 0;) {
    for (std::size_t k = i + 1; k < 4; ++k) right[i] -= m[k][i] * right[k];
    right[i] /= m[i][i];
  }
  return right;
}

struct System {
  Mat4 gauss{}, newton{};
  Vec4 gradient{};
};

/// Gradient and second derivatives of the distance of the two points, in the four parameters.
System system_of(const SurfaceSecond& a, const SurfaceSecond& b) {
  const double length = distance(a.value, b.value);
  const Vec3 n = (1 / length) * (a.value - b.value);
  const std::array<Vec3, 4> d{a.du, a.dv, -b.du, -b.dv};
  System s;
  for (std::size_t i = 0; i < 4; ++i) {
    s.gradient[i] = dot(d[i], n);
    for (std::size_t j = 0; j < 4; ++j) s.gauss[i][j] = dot(d[i], d[j]) / length;
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) s.newton[i][j] = s.gauss[i][j] - s.gradient[i] * s.gradient[j] / length;
  const auto add = [&s](std::size_t i, std::size_t j, double x) {
    s.newton[i][j] += x;
    if (i != j) s.newton[j][i] += x;
  };
  add(0, 0, dot(a.duu, n));
  add(0, 1, dot(a.duv, n));
  add(1, 1, dot(a.dvv, n));
  add(2, 2, -dot(b.duu, n));
  add(2, 3, -dot(b.duv, n));
  add(3, 3, -dot(b.dvv, n));
  return s;
}

std::optional<Vec4> step_of(const System& s, double damping) {
  for (Mat4 m : {s.newton, s.gauss}) {
    for (std::size_t i = 0; i < 4; ++i) m[i][i] += damping * s.gauss[i][i];
    if (const auto step = solve_definite(m, s.gradient)) return step;
  }
  return std::nullopt;
}

}  // namespace

ParameterPair approach(const Surface& one, const Surface& two, ParameterPair start, double furthest) {
  ParameterPair best = start;
  SurfaceSecond a = one.second(best.one), b = two.second(best.two);
  const Vec3 origin = a.value;
  double least = distance(a.value, b.value);
  double damping = 1e-9;
  for (int i = 0; i < kSteps && least > 0; ++i) {
    const auto step = step_of(system_of(a, b), damping);
    damping = std::max(10 * damping, 1e-6);
    if (!step) continue;
    const Vec2 next = best.one - Vec2{(*step)[0], (*step)[1]};
    const SurfaceSecond next_a = one.second(next);
    if (!finite(next_a.value)) continue;
    const auto foot = two.project(next_a.value, best.two - Vec2{(*step)[2], (*step)[3]});
    if (!foot) continue;
    const SurfaceSecond next_b = two.second(*foot);
    const double distance_next = distance(next_a.value, next_b.value);
    if (!(distance_next < least)) continue;
    const bool done = least - distance_next < 1e-3 * least || distance(origin, next_a.value) > furthest;
    best = {next, *foot};
    a = next_a;
    b = next_b;
    least = distance_next;
    if (done) break;
    damping = 1e-9;
  }
  return best;
}

std::optional<ParameterPair> meeting_point(const Surface& one, const Surface& two, ParameterPair start, double contact,
                                           double furthest) {
  ParameterPair pair = start;
  SurfaceFirst a = one.first(pair.one);
  const Vec3 origin = a.value;
  Vec3 away = a.value - two.value(pair.two);
  for (int i = 0; i < kSteps; ++i) {
    const double least = norm(away);
    if (least <= contact) return pair;
    // The slope of the distance along the first surface: in lengths, and solved for in parameters.
    const Vec3 n = (1 / least) * away;
    const double E = norm2(a.du), F = dot(a.du, a.dv), G = norm2(a.dv);
    const double det = E * G - F * F;
    if (!(det > 1e-12 * E * G)) return std::nullopt;
    const double p = dot(n, a.du), q = dot(n, a.dv);
    const Vec2 slope{(G * p - F * q) / det, (E * q - F * p) / det};
    const double steepness2 = p * slope.x + q * slope.y;
    if (!(steepness2 > 0) || !(least <= std::sqrt(steepness2) * furthest)) return std::nullopt;
    pair.one = pair.one - (least / steepness2) * slope;
    a = one.first(pair.one);
    if (!(distance(a.value, origin) <= furthest)) return std::nullopt;
    const auto foot = two.project(a.value, pair.two);
    if (!foot) return std::nullopt;
    pair.two = *foot;
    away = a.value - two.value(pair.two);
    if (!(norm(away) < 0.9 * least)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace curvetet::sizing
