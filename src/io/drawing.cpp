// Lines are part of the triangles rather than drawn after them: they are then hidden exactly where their triangle is,
// with no fight between depths. Averaging several samples per pixel smooths both.
#include "io/drawing.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/formats.h"

namespace curvetet {

namespace {

std::array<std::uint8_t, 3> bytes(const Rgb& colour) {
  std::array<std::uint8_t, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(colour[i], 0.0F, 1.0F)));
  }
  return result;
}

double area2(const Vec3& a, const Vec3& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// First and last of n samples within [low, high]; empty (first > last) also where the range is not finite.
std::array<int, 2> sample_range(double low, double high, int n) {
  if (!(low <= high) || high < 0 || low > n) return {0, -1};
  return {static_cast<int>(std::max(0.0, std::floor(low))), static_cast<int>(std::min(n - 1.0, std::ceil(high)))};
}

}  // namespace

Canvas::Canvas(int width, int height, int samples) : width_(width), height_(height), samples_(samples) {
  const std::size_t n = static_cast<std::size_t>(width) * height * samples * samples;
  depth_.assign(n, std::numeric_limits<float>::infinity());
  colour_.resize(n);
}

void Canvas::draw(const DrawnTriangle& triangle) {
  std::array<Vec3, 3> p = triangle.corner;
  for (Vec3& corner : p) corner = {samples_ * corner.x, samples_ * corner.y, corner.z};
  const double area = area2(p[0], p[1], p[2].x, p[2].y);
  if (!(std::abs(area) > 0)) return;
  const auto [x_low, x_high] = std::minmax({p[0].x, p[1].x, p[2].x});
  const auto [y_low, y_high] = std::minmax({p[0].y, p[1].y, p[2].y});
  const auto [first_x, last_x] = sample_range(x_low, x_high, width_ * samples_);
  const auto [first_y, last_y] = sample_range(y_low, y_high, height_ * samples_);
  const std::array<std::uint8_t, 3> fill = bytes(triangle.fill), line = bytes(triangle.line);
  // A barycentric coordinate times this is the distance to its edge, in half widths of the line.
  std::array<double, 3> per_line{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
    const double height = std::abs(area) / std::max(std::hypot(b.x - a.x, b.y - a.y), 1e-12);
    const double half_width = samples_ * triangle.half_width[i];
    per_line[i] = half_width > 0 ? height / half_width : std::numeric_limits<double>::infinity();
  }
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      std::array<double, 3> weight{};
      for (std::size_t i = 0; i < 3; ++i) weight[i] = area2(p[(i + 1) % 3], p[(i + 2) % 3], x + 0.5, y + 0.5) / area;
      if (!(weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0)) continue;
      const auto z = static_cast<float>(weight[0] * p[0].z + weight[1] * p[1].z + weight[2] * p[2].z);
      const std::size_t at = static_cast<std::size_t>(y) * width_ * samples_ + x;
      if (!(z < depth_[at])) continue;
      depth_[at] = z;
      const bool on_line = weight[0] * per_line[0] < 1 || weight[1] * per_line[1] < 1 || weight[2] * per_line[2] < 1;
      colour_[at] = on_line ? line : fill;
    }
  }
}

std::vector<std::uint8_t> Canvas::pixels() const {
  std::vector<std::uint8_t> result;
  result.reserve(static_cast<std::size_t>(width_) * height_ * 3);
  const int n = samples_ * samples_;
  for (int y = 0; y < height_; ++y) {
    const auto background = static_cast<int>(std::lround(255 - 22.0 * y / height_));
    for (int x = 0; x < width_; ++x) {
      std::array<int, 3> sum{};
      for (int s = 0; s < n; ++s) {
        const std::size_t at =
            (static_cast<std::size_t>(y) * samples_ + s / samples_) * width_ * samples_ + x * samples_ + s % samples_;
        const bool empty = std::isinf(depth_[at]);
        for (std::size_t i = 0; i < 3; ++i) sum[i] += empty ? background : colour_[at][i];
      }
      for (const int total : sum) result.push_back(static_cast<std::uint8_t>((total + n / 2) / n));
    }
  }
  return result;
}

Status write_png(const std::string& path, const std::vector<std::uint8_t>& pixels, int width, int height) {
  const Error refused{ErrorCode::output_unwritable, path + " cannot be made into a PNG file"};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), 0, nullptr) == 0) return refused;
  std::string file(size, '\0');
  if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), 0, nullptr) == 0) return refused;
  file.resize(size);
  return write_file_atomically(path, file);
}

}  // namespace curvetet
