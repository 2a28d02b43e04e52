// A finished run in words, for the end of `curvetet mesh`.
#pragma once

#include <string>

#include "curvetet/mesh.h"
#include "curvetet/report.h"

namespace curvetet::cli {

/// Several lines: unit, size, counts, volumes, worst angle with its place, reductions of size, rounds, times, verdict.
std::string summary(const Report& report);

}  // namespace curvetet::cli
