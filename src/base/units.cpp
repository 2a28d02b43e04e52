#include "base/units.h"

namespace curvetet {

std::optional<double> millimetres(const std::string& unit) {
  if (unit == "mm") return 1.0;
  if (unit == "cm") return 10.0;
  if (unit == "m") return 1000.0;
  if (unit == "inch" || unit == "in") return 25.4;
  if (unit == "ft") return 304.8;
  if (unit == "um") return 1e-3;
  return std::nullopt;
}

}  // namespace curvetet
