// Curves whose parameter runs unevenly along them.
#pragma once

#include <memory>
#include <vector>

#include "geometry/surface.h"

namespace curvetet {

/// A rising map of [low, high] onto itself, linear between steps: from a parameter that runs evenly along a curve to
/// the curve's own. Outside of the range both are the same.
class ParameterSteps {
 public:
  /// Both rising, with the same ends.
  ParameterSteps(std::vector<double> even, std::vector<double> own);
  double own(double even) const;
  double even(double own) const;
  /// How fast the own parameter runs there.
  double slope(double even) const;

 private:
  static std::size_t step_of(const std::vector<double>& of, double value);
  static double mapped(const std::vector<double>& from, const std::vector<double>& to, double value);

  std::vector<double> even_, own_;
};

/// The steps that a curve needs over [low, high]; null for most. It does if a thirty-second of the range holds more
/// than a quarter of the length: a few places evenly spread over the range would then miss most of the curve.
/// Intersections that kernels trace may have half of their length in a millionth of their range.
std::shared_ptr<const ParameterSteps> steps_along(const Curve& curve, double low, double high);

/// The same curve by the even parameter. `curve` as it is without steps.
std::unique_ptr<Curve> evened(std::unique_ptr<Curve> curve, const std::shared_ptr<const ParameterSteps>& steps);
std::unique_ptr<ParameterCurve> evened(std::unique_ptr<ParameterCurve> curve,
                                       const std::shared_ptr<const ParameterSteps>& steps);

}  // namespace curvetet
