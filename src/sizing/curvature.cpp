// Sizes from bending.
//
// N elements per full turn mean that the normal turns by 2 pi / N over one element: size = 2 pi / (N kappa) where the
// curvature kappa is constant. On splines kappa can be a narrow spike (a knot, a collapsed derivative) over which the
// normal hardly turns. So the size is checked against the turning itself: if the normals half a size to either side
// differ by less than half the angle, the size is doubled and tried again.
//
// At the apex of a cone the curvature grows without bound, and "elements per turn" would demand ever smaller elements
// around a point that is represented exactly anyway. There the curvature counts as it does at a short distance, at most
// one element, from the apex.
//
// Chord height c: the chord of a circle of radius R is 2 sqrt(2 R c - c^2), about sqrt(8 c / kappa). A triangle's
// middle is further from the surface than its sides' middles are: an equilateral triangle of side h has circumradius h
// / sqrt(3) and height kappa h^2 / 6 on a sphere, so faces use sqrt(6 c / kappa), curves sqrt(8 c / kappa).
//
// A curve is known up to the tolerance of its edge only. Within it curves of real CAD double back, or wriggle against
// the surfaces they lie on; elements as small as that would be laid along the wriggles, off the faces and folded.

#include "sizing/curvature.h"

#include <cmath>
#include <numbers>

namespace curvetet::sizing {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kFaceHeightFactor = 0.75;  ///< 6 / 8: heights of triangles against those of chords
constexpr double kConfirmed = 0.5;          ///< part of the angle that must really be turned
constexpr double kToleranceSizes = 8;       ///< sizes that bending demands are at least this many tolerances
constexpr double kLeastFraction = 0.1;      ///< of a size over which a turning can be measured

Vec2 clamped(Vec2 uv, Vec2 low, Vec2 high) {
  return {std::clamp(uv.x, low.x, high.x), std::clamp(uv.y, low.y, high.y)};
}

bool is_analytic(SurfaceKind kind) {
  return kind == SurfaceKind::plane || kind == SurfaceKind::cylinder || kind == SurfaceKind::cone ||
         kind == SurfaceKind::sphere || kind == SurfaceKind::torus;
}

Demand smaller(Demand a, Demand b) { return b.size < a.size ? b : a; }

}  // namespace

double chord_for_height(double height, double curvature) {
  if (!(curvature > 0)) return kInfinite;
  const double radius = 1 / curvature;
  if (height >= radius) return 2 * radius;
  return 2 * std::sqrt(height * (2 * radius - height));
}

SurfaceBending bending(const Surface& surface, Vec2 uv) {
  const SurfaceSecond s = surface.second(uv);
  SurfaceBending result;
  result.point = s.value;
  result.scale = {norm(s.du), norm(s.dv)};
  const Vec3 across = cross(s.du, s.dv);
  const double area = norm(across);
  if (!(area > 1e-9 * result.scale.x * result.scale.y)) return result;
  result.normal = (1 / area) * across;
  // Shape operator: the inverse of the first fundamental form times the second.
  const double E = norm2(s.du), F = dot(s.du, s.dv), G = norm2(s.dv);
  const double L = dot(result.normal, s.duu), M = dot(result.normal, s.duv), N = dot(result.normal, s.dvv);
  const double det = area * area;
  const double a = (G * L - F * M) / det, b = (G * M - F * N) / det;
  const double c = (E * M - F * L) / det, d = (E * N - F * M) / det;
  const double mean = 0.5 * (a + d);
  const double spread = std::sqrt(std::max(0.0, mean * mean - (a * d - b * c)));
  const double k = mean >= 0 ? mean + spread : mean - spread;
  if (!std::isfinite(k)) return result;
  result.largest = std::abs(k);
  // An eigenvector of k, from the row of (shape operator - k) that is larger in lengths; any direction at an umbilic.
  const Vec2 from_first{b, k - a}, from_second{k - d, c};
  const auto length = [&](Vec2 x) { return norm(x.x * s.du + x.y * s.dv); };
  const double first = length(from_first), second = length(from_second);
  result.direction = first >= second ? from_first : from_second;
  const double longest = std::max(first, second);
  const double negligible = 1e-9 * result.largest * std::min(result.scale.x, result.scale.y);
  result.direction = longest > negligible ? (1 / longest) * result.direction : Vec2{1 / result.scale.x, 0};
  return result;
}

FaceBending::FaceBending(const Model& model, FaceId id, const SizingOptions& options) : options_(options) {
  const ModelFace& face = model.faces[id];
  surface_ = face.surface->clone();
  low_ = face.low;
  high_ = face.high;
  analytic_ = is_analytic(surface_->kind());
  if (surface_->kind() != SurfaceKind::sphere) find_singular_points(model, face);
}

void FaceBending::find_singular_points(const Model& model, const ModelFace& face) {
  for (const Loop& loop : face.loops)
    for (const EdgeUse& use : loop.uses) {
      const ModelEdge& edge = model.edges[use.edge];
      if (!edge.degenerate || !use.curve) continue;
      const auto curve = use.curve->clone();
      const Vec2 pole = curve->value(0.5 * (edge.low + edge.high));
      const Vec2 along = curve->value(edge.high) - curve->value(edge.low);
      // A pole is a line of constant u or v; the domain lies on the side of the box's middle.
      Vec2 inward = 0.5 * (low_ + high_) - pole;
      (std::abs(along.x) >= std::abs(along.y) ? inward.x : inward.y) = 0;
      const double near = bending(*surface_, pole + (1.0 / 32) * inward).largest;
      const double far = bending(*surface_, pole + (1.0 / 16) * inward).largest;
      if (!(near > 1.5 * far)) continue;
      const Vec3 apex = model.vertices[edge.start].point;
      const double extent = distance(apex, surface_->value(pole + 2.0 * inward));
      singular_.push_back({apex, std::min(0.25 * extent, options_.size)});
    }
}

double FaceBending::effective_curvature(const SurfaceBending& at) const {
  double curvature = at.largest;
  for (const SingularPoint& point : singular_)
    if (point.reach > 0) curvature *= std::min(1.0, distance(at.point, point.where) / point.reach);
  return curvature;
}

Vec3 FaceBending::normal_at(Vec2 uv, const SurfaceFirst& s) const {
  const double along_u = norm(s.du) * (high_.x - low_.x), along_v = norm(s.dv) * (high_.y - low_.y);
  const bool collapsed = std::min(along_u, along_v) <= 1e-6 * std::max(along_u, along_v);
  return collapsed ? surface_->normal(uv) : cross(s.du, s.dv);
}

double FaceBending::turning_size(Vec2 uv, const SurfaceBending& at, double angle) const {
  double size = angle / effective_curvature(at);
  if (analytic_) return size;
  while (size < options_.size) {
    const Vec2 step = (0.5 * size) * at.direction;
    const Vec2 one = clamped(uv - step, low_, high_), two = clamped(uv + step, low_, high_);
    // Near a border the two points are closer than the size; too close, they prove nothing.
    const SurfaceFirst here = surface_->first(one), there = surface_->first(two);
    const double fraction = std::min(1.0, distance(here.value, there.value) / size);
    const double turned = angle_between(normal_at(one, here), normal_at(two, there));
    if (fraction >= kLeastFraction && turned >= kConfirmed * fraction * std::min(angle, 1.0)) break;
    size *= 2;
  }
  return size;
}

Demand FaceBending::demand(Vec2 uv, const SurfaceBending& at) const {
  Demand result;
  if (!(at.largest > 0) || norm2(at.normal) == 0) return result;
  if (options_.curvature > 0) {
    result.size = turning_size(uv, at, 2 * std::numbers::pi / options_.curvature);
    if (!analytic_) result.size = std::max(result.size, options_.free_form_floor);
  }
  if (options_.chord_height > 0) {
    const double size = chord_for_height(kFaceHeightFactor * options_.chord_height, effective_curvature(at));
    result = smaller(result, {size, SizeReason::chord_height});
  }
  return result;
}

double bending_floor(double tolerance, double curvature) {
  return std::max(kToleranceSizes * tolerance,
                  tolerance * curvature < 1 ? chord_for_height(tolerance, curvature) : 0.0);
}

Demand curve_demand(const ModelEdge& edge, const Curve& curve, double t, const SizingOptions& options) {
  Demand result;
  const double curvature = curve.curvature(t);
  if (!(curvature > 0)) return result;
  if (options.curvature > 0) {
    const double angle = 2 * std::numbers::pi / options.curvature;
    const double speed = norm(curve.second(t).dt);
    result.size = angle / curvature;
    const bool analytic = curve.kind() == CurveKind::circle || curve.kind() == CurveKind::ellipse;
    while (!analytic && result.size < options.size) {
      const double step = 0.5 * result.size / speed;
      const CurveSecond one = curve.second(std::max(edge.low, t - step)),
                        two = curve.second(std::min(edge.high, t + step));
      const double fraction = std::min(1.0, distance(one.value, two.value) / result.size);
      const double turned = angle_between(one.dt, two.dt);
      if (fraction >= kLeastFraction && turned >= kConfirmed * fraction * std::min(angle, 1.0)) break;
      result.size *= 2;
    }
    if (!analytic) result.size = std::max(result.size, options.free_form_floor);
  }
  if (options.chord_height > 0)
    result = smaller(result, {chord_for_height(options.chord_height, curvature), SizeReason::chord_height});
  result.size = std::max(result.size, bending_floor(edge.tolerance, curvature));
  return result;
}

}  // namespace curvetet::sizing
