// Pictures show what the mesh has: something where the body is, nothing around it, and the inside where it is cut.
#include "io/picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <filesystem>
#include <vector>

#include "io/drawing.h"
#include "io/two_boxes.h"

namespace curvetet {
namespace {

struct Pixels {
  std::vector<std::uint8_t> rgb;
  int width = 0, height = 0;
  bool is_background(int x, int y) const {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * width + x);
    return rgb[at] == rgb[at + 1] && rgb[at + 1] == rgb[at + 2] && rgb[at] > 230;
  }
  std::size_t drawn() const {
    std::size_t n = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) n += is_background(x, y) ? 0 : 1;
    }
    return n;
  }
};

Pixels read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Pixels pixels;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return pixels;
  image.format = PNG_FORMAT_RGB;
  pixels.width = static_cast<int>(image.width);
  pixels.height = static_cast<int>(image.height);
  pixels.rgb.resize(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr);
  return pixels;
}

Pixels draw(const Mesh& mesh, const PictureOptions& options) {
  const std::string path = (std::filesystem::temp_directory_path() / "curvetet_picture_test.png").string();
  const Status drawn = write_picture(mesh, path, options);
  EXPECT_TRUE(drawn.ok());
  Pixels pixels = read_png(path);
  std::filesystem::remove(path);
  return pixels;
}

TEST(Picture, ShowsTheBodyWithAMargin) {
  const Pixels pixels = draw(test::TwoBoxes(2).mesh, {300, 200, {}});
  ASSERT_EQ(pixels.width, 300);
  ASSERT_EQ(pixels.height, 200);
  EXPECT_FALSE(pixels.is_background(150, 100));
  for (int x = 0; x < 300; ++x) EXPECT_TRUE(pixels.is_background(x, 0) && pixels.is_background(x, 199));
  for (int y = 0; y < 200; ++y) EXPECT_TRUE(pixels.is_background(0, y) && pixels.is_background(299, y));
}

TEST(Picture, ACutTakesMaterialAway) {
  const Mesh mesh = test::TwoBoxes(4).mesh;
  std::size_t last = 0;
  for (const double fraction : {0.25, 0.5, 0.75, 1.0}) {
    const std::size_t drawn = draw(mesh, {200, 150, PictureCut{0, fraction}}).drawn();
    EXPECT_GT(drawn, last);
    last = drawn;
  }
  EXPECT_EQ(last, draw(mesh, {200, 150, {}}).drawn());
}

TEST(Picture, NothingLeftIsAnError) {
  const std::string path = (std::filesystem::temp_directory_path() / "curvetet_picture_none.png").string();
  EXPECT_FALSE(write_picture(Mesh{}, path, {}).ok());
  EXPECT_FALSE(write_picture(test::TwoBoxes(1).mesh, path, {100, 100, PictureCut{0, 0.0}}).ok());
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Canvas, TheNearerTriangleHidesTheOther) {
  Canvas canvas(10, 10, 2);
  const auto square = [](double z, Rgb colour) {
    return DrawnTriangle{{Vec3{-10, -10, z}, Vec3{40, -10, z}, Vec3{-10, 40, z}}, colour, {}, {}};
  };
  canvas.draw(square(1, {1, 0, 0}));
  canvas.draw(square(0, {0, 1, 0}));
  canvas.draw(square(2, {0, 0, 1}));
  const std::vector<std::uint8_t> pixels = canvas.pixels();
  EXPECT_EQ(pixels[0], 0);
  EXPECT_EQ(pixels[1], 255);
}

TEST(Canvas, WhatIsOutsideOrDegenerateIsHarmless) {
  Canvas canvas(4, 4, 1);
  canvas.draw({{Vec3{100, 100, 0}, Vec3{200, 100, 0}, Vec3{100, 200, 0}}, {}, {}, {}});
  canvas.draw({{Vec3{1, 1, 0}, Vec3{2, 2, 0}, Vec3{3, 3, 0}}, {}, {}, {}});
  canvas.draw({{Vec3{HUGE_VAL, 1, 0}, Vec3{2, -HUGE_VAL, 0}, Vec3{3, 3, 0}}, {}, {}, {}});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(canvas.pixels()[i], 255);
}

}  // namespace
}  // namespace curvetet
