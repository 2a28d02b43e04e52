// Smoothing by an active set of gradients. The measure is a minimum over tets and over edges, so it has kinks: a
// gradient of the worst tet alone runs into the next tet at once. The shortest vector in the hull of the gradients of
// all nearly worst tets is the steepest direction that improves them all. It is found by Frank-Wolfe steps, which for
// at most eight vectors in space are shorter than an exact quadratic program and as good for a direction.
#include "volume/shape.h"

#include <numeric>

#include "geometry/frame.h"

namespace curvetet {

namespace {

constexpr std::size_t kActive = 8;    // gradients at most
constexpr int kSteps = 6;             // of ascent
constexpr int kHalvings = 5;          // of a step
constexpr double kActiveBand = 0.08;  // tets this much better than the worst count as worst
constexpr double kFiniteDifference = 1e-5;

double shortest_reach(const StarFacets& facets, Vec3 p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : facets) least = std::min({least, norm2(f[0] - p), norm2(f[1] - p), norm2(f[2] - p)});
  return std::sqrt(least);
}

Vec3 mean_of(const StarFacets& facets) {
  Vec3 sum;
  for (const auto& f : facets) sum = sum + f[0] + f[1] + f[2];
  return (1.0 / (3 * static_cast<double>(facets.size()))) * sum;
}

}  // namespace

double worst_in_star(const StarFacets& facets, Vec3 p) {
  double worst = std::numeric_limits<double>::infinity();
  for (const auto& f : facets) {
    worst = std::min(worst, least_sine(f[0], f[1], f[2], p));
    if (worst <= 0) break;
  }
  return worst;
}

void StarOptimiser::gradients_of_worst(const StarFacets& facets, Vec3 p, double step) {
  values_.clear();
  for (const auto& f : facets) values_.push_back(least_sine(f[0], f[1], f[2], p));
  order_.resize(facets.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  const std::size_t n = std::min(kActive, order_.size());
  std::partial_sort(
      order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(n), order_.end(),
      [this](std::size_t i, std::size_t j) { return values_[i] != values_[j] ? values_[i] < values_[j] : i < j; });
  gradients_.clear();
  for (std::size_t k = 0; k < n && values_[order_[k]] <= values_[order_[0]] + kActiveBand; ++k) {
    const auto& f = facets[order_[k]];
    Vec3 g;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 q = p;
      q[axis] += step;
      g[axis] = (least_sine(f[0], f[1], f[2], q) - values_[order_[k]]) / step;
    }
    gradients_.push_back(g);
  }
}

Vec3 StarOptimiser::shortest_in_hull() const {
  Vec3 x = gradients_[0];
  for (int round = 0; round < 16; ++round) {
    Vec3 best = gradients_[0];
    for (const Vec3& g : gradients_) {
      if (dot(x, g) < dot(x, best)) best = g;
    }
    const Vec3 d = best - x;
    const double length2 = norm2(d);
    if (!(length2 > 0)) break;
    const double s = std::clamp(-dot(x, d) / length2, 0.0, 1.0);
    if (s == 0) break;
    x = x + s * d;
  }
  return x;
}

Vec3 StarOptimiser::optimise(const StarFacets& facets, Vec3 p) {
  double worst = worst_in_star(facets, p);
  const Vec3 middle = snap(mean_of(facets));
  const double at_middle = worst_in_star(facets, middle);
  if (at_middle > worst) p = middle, worst = at_middle;
  double stride = 0.25 * shortest_reach(facets, p);
  for (int step = 0; step < kSteps && worst > 0; ++step) {
    gradients_of_worst(facets, p, kFiniteDifference * stride);
    const Vec3 direction = normalized(shortest_in_hull());
    double gained = 0;
    for (int halving = 0; halving < kHalvings; ++halving, stride *= 0.5) {
      const Vec3 q = snap(p + stride * direction);
      const double there = worst_in_star(facets, q);
      if (there <= worst) continue;
      gained = there - worst;
      p = q;
      worst = there;
      break;
    }
    if (gained < 1e-3 * worst) break;
  }
  return p;
}

}  // namespace curvetet
