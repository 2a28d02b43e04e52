// Units of length.
#pragma once

#include <optional>
#include <string>

namespace curvetet {

/// A length as a user gives it.
struct Length {
  double value = 0;
  std::string unit{};  ///< empty: that of what is measured
};

/// Millimetres of a unit ("mm", "cm", "m", "inch", "um", "ft"); empty if unknown.
std::optional<double> millimetres(const std::string& unit);

}  // namespace curvetet
