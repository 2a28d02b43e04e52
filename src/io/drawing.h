// A depth buffer with colours: the canvas of pictures.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/vec.h"

namespace curvetet {

using Rgb = std::array<float, 3>;  ///< components in [0,1]

/// A triangle in pixels (x to the right, y down) with depth growing away from the viewer, of one colour. Along each
/// edge (edge i is opposite corner i) the pixels nearer than half_width[i] are drawn in the line's colour.
struct DrawnTriangle {
  std::array<Vec3, 3> corner;
  Rgb fill{}, line{};
  std::array<double, 3> half_width{};
};

class Canvas {
 public:
  /// Each pixel is averaged from samples x samples points.
  Canvas(int width, int height, int samples);
  /// Corners are in pixels of the finished picture; what lies outside of it is cut off.
  void draw(const DrawnTriangle& triangle);
  /// Rows from the top, red, green and blue bytes, over a background that fades from white to light grey.
  std::vector<std::uint8_t> pixels() const;

 private:
  using Byte3 = std::array<std::uint8_t, 3>;
  int width_, height_, samples_;
  std::vector<float> depth_;
  std::vector<Byte3> colour_;
};

/// Writes rows as Canvas::pixels() gives them to a PNG file, whole or not at all.
Status write_png(const std::string& path, const std::vector<std::uint8_t>& pixels, int width, int height);

}  // namespace curvetet
