// Local numbering of a triangle's corners, counter-clockwise.
#pragma once

namespace curvetet {

constexpr int next(int i) { return i == 2 ? 0 : i + 1; }
constexpr int previous(int i) { return i == 0 ? 2 : i - 1; }

}  // namespace curvetet
