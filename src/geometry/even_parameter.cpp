// Every stage looks at a curve at some places of its range first, and refines from there. Instead of teaching each of
// them to look for what is hidden between two places, a curve that hides something gets another parameter. Its pieces
// are bisected until each chord is short; their lengths are the map.
//
// Rejected: the knots of splines as places to look at. They tell where a kernel's tracing went slowly, but not that a
// piece between two of them is even.
#include "geometry/even_parameter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curvetet {

namespace {

constexpr int kParts = 32;              ///< of the range
constexpr double kLargestShare = 0.25;  ///< of the length, in one of them
constexpr double kLongestChord = 0.02;  ///< of the length, of a piece
constexpr double kLeastStep = 1e-9;     ///< of the range, for the even parameter
constexpr std::size_t kMostPieces = 2000;

struct Place {
  double t = 0;
  Vec3 point;
};

class EvenCurve final : public Curve {
 public:
  EvenCurve(std::unique_ptr<Curve> curve, std::shared_ptr<const ParameterSteps> steps)
      : curve_(std::move(curve)), steps_(std::move(steps)) {}
  CurveKind kind() const override { return curve_->kind(); }
  Vec3 value(double t) const override { return curve_->value(steps_->own(t)); }
  CurveSecond second(double t) const override {
    const double slope = steps_->slope(t);
    const CurveSecond s = curve_->second(steps_->own(t));
    return {s.value, slope * s.dt, slope * slope * s.dtt};
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<EvenCurve>(curve_->clone(), steps_); }

 private:
  std::unique_ptr<Curve> curve_;
  std::shared_ptr<const ParameterSteps> steps_;
};

class EvenParameterCurve final : public ParameterCurve {
 public:
  EvenParameterCurve(std::unique_ptr<ParameterCurve> curve, std::shared_ptr<const ParameterSteps> steps)
      : curve_(std::move(curve)), steps_(std::move(steps)) {}
  Vec2 value(double t) const override { return curve_->value(steps_->own(t)); }
  std::unique_ptr<ParameterCurve> clone() const override {
    return std::make_unique<EvenParameterCurve>(curve_->clone(), steps_);
  }

 private:
  std::unique_ptr<ParameterCurve> curve_;
  std::shared_ptr<const ParameterSteps> steps_;
};

/// Places along the curve, evenly spread over its range.
std::vector<Place> parts_of(const Curve& curve, double low, double high) {
  std::vector<Place> places;
  for (int i = 0; i <= kParts; ++i) {
    const double t = i == kParts ? high : low + (high - low) * i / kParts;
    places.push_back({t, curve.value(t)});
  }
  return places;
}

double length_of(const std::vector<Place>& places) {
  double length = 0;
  for (std::size_t i = 1; i < places.size(); ++i) length += distance(places[i - 1].point, places[i].point);
  return length;
}

/// With the middles of all pieces whose chords are too long; false if there are none that can be halved.
bool halve_long(const Curve& curve, double longest, double least, std::vector<Place>& places) {
  std::vector<Place> next{places.front()};
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Place &a = places[i - 1], &b = places[i];
    const double middle = 0.5 * (a.t + b.t);
    if (distance(a.point, b.point) > longest && b.t - a.t > least) next.push_back({middle, curve.value(middle)});
    next.push_back(b);
  }
  const bool any = next.size() > places.size();
  places = std::move(next);
  return any;
}

/// The largest part of the range that is as short in t as one of kParts, by length.
bool is_uneven(const std::vector<Place>& places, double low, double high) {
  std::vector<double> share(kParts, 0);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double middle = 0.5 * (places[i - 1].t + places[i].t);
    const auto part = static_cast<std::size_t>(std::clamp((middle - low) / (high - low) * kParts, 0.0, kParts - 0.5));
    share[part] += distance(places[i - 1].point, places[i].point);
  }
  return *std::max_element(share.begin(), share.end()) > kLargestShare * length_of(places);
}

}  // namespace

ParameterSteps::ParameterSteps(std::vector<double> even, std::vector<double> own)
    : even_(std::move(even)), own_(std::move(own)) {}

std::size_t ParameterSteps::step_of(const std::vector<double>& of, double value) {
  const auto upper = std::upper_bound(of.begin() + 1, of.end() - 1, value);
  return static_cast<std::size_t>(upper - of.begin());
}

double ParameterSteps::mapped(const std::vector<double>& from, const std::vector<double>& to, double value) {
  if (!(value > from.front()) || !(value < from.back())) return value;
  const std::size_t i = step_of(from, value);
  return to[i - 1] + (value - from[i - 1]) / (from[i] - from[i - 1]) * (to[i] - to[i - 1]);
}

double ParameterSteps::own(double even) const { return mapped(even_, own_, even); }

double ParameterSteps::even(double own) const { return mapped(own_, even_, own); }

double ParameterSteps::slope(double even) const {
  if (even < even_.front() || even > even_.back()) return 1;
  const std::size_t i = step_of(even_, even);
  return (own_[i] - own_[i - 1]) / (even_[i] - even_[i - 1]);
}

std::shared_ptr<const ParameterSteps> steps_along(const Curve& curve, double low, double high) {
  if (curve.kind() == CurveKind::line || !(low < high)) return nullptr;
  std::vector<Place> places = parts_of(curve, low, high);
  if (!std::isfinite(length_of(places)) || !is_uneven(places, low, high)) return nullptr;
  const double least = 64 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  while (places.size() < kMostPieces && halve_long(curve, kLongestChord * length_of(places), least, places)) continue;
  if (!is_uneven(places, low, high)) return nullptr;
  const double total = length_of(places), range = high - low;
  std::vector<double> even{low}, own{low};
  double length = 0;
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    length += distance(places[i - 1].point, places[i].point);
    const double at = low + range * length / total;
    if (at - even.back() < kLeastStep * range || high - at < kLeastStep * range) continue;
    even.push_back(at);
    own.push_back(places[i].t);
  }
  even.push_back(high);
  own.push_back(high);
  return std::make_shared<const ParameterSteps>(std::move(even), std::move(own));
}

std::unique_ptr<Curve> evened(std::unique_ptr<Curve> curve, const std::shared_ptr<const ParameterSteps>& steps) {
  if (steps == nullptr) return curve;
  return std::make_unique<EvenCurve>(std::move(curve), steps);
}

std::unique_ptr<ParameterCurve> evened(std::unique_ptr<ParameterCurve> curve,
                                       const std::shared_ptr<const ParameterSteps>& steps) {
  if (steps == nullptr) return curve;
  return std::make_unique<EvenParameterCurve>(std::move(curve), steps);
}

}  // namespace curvetet
