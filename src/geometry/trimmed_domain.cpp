// A face's loops as polygons in (u,v), with their segments sorted into strips of v so that each question looks at few.
//
// Parameter curves are bisected until the middle of each piece is near its chord, measured against the box of the
// domain. That is coarser than the curve meshes of the mesher and need not agree with them: here a point close to the
// boundary may be told either way.

#include "geometry/trimmed_domain.h"

#include <algorithm>
#include <cmath>

namespace curvetet {

namespace {

constexpr double kChordTolerance = 2e-3;  ///< of the domain's box
constexpr int kFirstPieces = 8;
constexpr int kDeepest = 6;  ///< bisections of each first piece

double period_shift(double x, double low, double high, double period) {
  if (period <= 0 || (x >= low && x <= high)) return 0;
  return -period * std::floor((x - low) / period);
}

double point_to_segment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 d = b - a;
  const double length2 = norm2(d);
  const double t = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0;
  return distance(p, a + t * d);
}

/// The polygon of one parameter curve, by recursive bisection.
class Polygoniser {
 public:
  Polygoniser(const ParameterCurve& curve, Vec2 extent) : curve_(curve), extent_(extent) {}

  std::vector<Vec2> run(double low, double high) {
    points_ = {curve_.value(low)};
    double t = low;
    for (int i = 1; i <= kFirstPieces; ++i) {
      const double next = i == kFirstPieces ? high : low + (high - low) * i / kFirstPieces;
      const Vec2 end = curve_.value(next);
      bisect(t, points_.back(), next, end, kDeepest);
      points_.push_back(end);
      t = next;
    }
    return std::move(points_);
  }

 private:
  void bisect(double t0, Vec2 a, double t1, Vec2 b, int depth) {
    if (depth == 0) return;
    const double middle = 0.5 * (t0 + t1);
    const Vec2 m = curve_.value(middle);
    const Vec2 off = m - 0.5 * (a + b);
    if (std::abs(off.x) <= kChordTolerance * extent_.x && std::abs(off.y) <= kChordTolerance * extent_.y) return;
    bisect(t0, a, middle, m, depth - 1);
    points_.push_back(m);
    bisect(middle, m, t1, b, depth - 1);
  }

  const ParameterCurve& curve_;
  Vec2 extent_;
  std::vector<Vec2> points_;
};

}  // namespace

TrimmedDomain::TrimmedDomain(const Model& model, FaceId id) {
  const ModelFace& face = model.faces[id];
  low_ = face.low;
  high_ = face.high;
  period_u_ = face.surface->period_u();
  period_v_ = face.surface->period_v();
  for (const Loop& loop : face.loops)
    for (const EdgeUse& use : loop.uses)
      if (use.curve) add_use(use, model.edges[use.edge]);
  sort_into_rows();
}

void TrimmedDomain::add_use(const EdgeUse& use, const ModelEdge& edge) {
  const auto curve = use.curve->clone();
  const std::vector<Vec2> points = Polygoniser(*curve, high_ - low_).run(edge.low, edge.high);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    if (std::isfinite(norm2(points[i]) + norm2(points[i + 1]))) segments_.push_back({points[i], points[i + 1]});
}

std::size_t TrimmedDomain::row_of(double v) const {
  const double row = (v - low_.y) / (high_.y - low_.y) * static_cast<double>(rows_.size());
  if (!(row > 0)) return 0;  // also where it is not a number
  return row < static_cast<double>(rows_.size()) ? static_cast<std::size_t>(row) : rows_.size() - 1;
}

void TrimmedDomain::sort_into_rows() {
  rows_.resize(std::clamp<std::size_t>(segments_.size() / 4, 1, 256));
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const auto [a, b] = segments_[i];
    const std::size_t last = row_of(std::max(a.y, b.y));
    for (std::size_t row = row_of(std::min(a.y, b.y)); row <= last; ++row)
      rows_[row].push_back(static_cast<std::uint32_t>(i));
  }
}

bool TrimmedDomain::inside(Vec2 uv) const {
  if (!(uv.x >= low_.x && uv.x <= high_.x && uv.y >= low_.y && uv.y <= high_.y)) return false;
  if (segments_.empty()) return true;
  bool odd = false;
  for (const std::uint32_t i : rows_[row_of(uv.y)]) {
    const auto [a, b] = segments_[i];
    if ((a.y > uv.y) == (b.y > uv.y)) continue;
    if (uv.x < a.x + (uv.y - a.y) / (b.y - a.y) * (b.x - a.x)) odd = !odd;
  }
  return odd;
}

bool TrimmedDomain::meets(Vec2 cell_low, Vec2 cell_high) const {
  if (inside(0.5 * (cell_low + cell_high))) return true;
  const std::size_t last = row_of(cell_high.y);
  for (std::size_t row = row_of(cell_low.y); row <= last; ++row)
    for (const std::uint32_t i : rows_[row]) {
      const auto [a, b] = segments_[i];
      if (std::max(a.x, b.x) < cell_low.x || std::min(a.x, b.x) > cell_high.x) continue;
      if (std::max(a.y, b.y) < cell_low.y || std::min(a.y, b.y) > cell_high.y) continue;
      return true;
    }
  return false;
}

Vec2 TrimmedDomain::lifted(Vec2 uv) const {
  return {uv.x + period_shift(uv.x, low_.x, high_.x, period_u_), uv.y + period_shift(uv.y, low_.y, high_.y, period_v_)};
}

bool TrimmedDomain::is_near_boundary(Vec2 uv, Vec2 scale, double reach) const {
  const auto scaled = [scale](Vec2 p) { return Vec2{scale.x * p.x, scale.y * p.y}; };
  const double reach_v = scale.y > 0 ? reach / scale.y : high_.y - low_.y;
  const std::size_t last = row_of(uv.y + reach_v);
  for (std::size_t row = row_of(uv.y - reach_v); row <= last; ++row)
    for (const std::uint32_t i : rows_[row])
      if (point_to_segment(scaled(uv), scaled(segments_[i].a), scaled(segments_[i].b)) <= reach) return true;
  return false;
}

}  // namespace curvetet
