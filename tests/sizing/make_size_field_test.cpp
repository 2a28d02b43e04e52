// Sizes of bodies: what bending, chord heights, gaps and short edges demand, and what they must not demand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sizing/patch_model.h"
#include "sizing/size_field.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

constexpr double kPi = std::numbers::pi;

/// Lengths of the tests are CAD units; the field works in working ones.
struct Sized {
  const Model& model;
  SizeField field;
  double at(Vec3 cad) const { return model.frame.length_to_cad(field.at(model.frame.to_working(cad))); }
};

SizingOptions plain(const Model& model, double size) {
  SizingOptions options;
  options.size = model.frame.length_to_working(size);
  options.min_size = options.size / 1000;
  options.gaps = false;
  return options;
}

Sized sized(const Model& model, const SizingOptions& options) {
  Context context;
  auto field = make_size_field(model, options, context);
  if (!field) throw std::runtime_error(field.error().message);
  return {model, std::move(field.value())};
}

Vec3 on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// What is wanted, up to the spacing of the sources.
void expect_size(double size, double wanted) {
  EXPECT_GE(size, 0.98 * wanted);
  EXPECT_LE(size, 1.26 * wanted);
}

TEST(BendingSizes, BallHasTheElementsPerTurnThatWereAsked) {
  const Model model = test::make_ball(10);
  const Sized ball = sized(model, plain(model, 30));
  for (int i = 0; i < 40; ++i)
    for (int j = -10; j <= 10; ++j) {
      const double u = 2 * kPi * i / 40, v = 0.5 * kPi * j / 10;
      expect_size(ball.at({10 * std::cos(v) * std::cos(u), 10 * std::cos(v) * std::sin(u), 10 * std::sin(v)}),
                  2 * kPi * 10 / 12);
    }
}

TEST(BendingSizes, CylinderAndItsCaps) {
  const Model model = test::make_cylinder(5, 40);
  const Sized body = sized(model, plain(model, 20));
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j <= 20; ++j) expect_size(body.at(on_circle(5, 2 * kPi * i / 40, 2.0 * j)), 2 * kPi * 5 / 12);
}

TEST(BendingSizes, TorusFollowsItsTube) {
  const Model model = test::make_torus(20, 4);
  const Sized torus = sized(model, plain(model, 20));
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 20; ++j) {
      const double u = 2 * kPi * i / 60, v = 2 * kPi * j / 20;
      expect_size(torus.at(on_circle(20 + 4 * std::cos(v), u, 4 * std::sin(v))), 2 * kPi * 4 / 12);
    }
}

TEST(BendingSizes, ChordHeight) {
  const Model model = test::make_ball(10);
  SizingOptions options = plain(model, 30);
  options.curvature = 0;
  options.chord_height = model.frame.length_to_working(0.1);
  expect_size(sized(model, options).at({0, 10, 0}), std::sqrt(6 * 0.1 * 10));
}

TEST(BendingSizes, ApexIsNoReasonToRefineWithoutEnd) {
  const Model model = test::make_cone(10, 0, 20);
  const SizingOptions options = plain(model, 4);
  const Sized cone = sized(model, options);
  EXPECT_LT(cone.field.smallest(), options.size);
  EXPECT_GT(cone.at({0, 0, 20}), 0.5);
  expect_size(cone.at(on_circle(5, 1, 10)), 2 * kPi * 5 * std::sqrt(1.25) / 12);
}

TEST(BendingSizes, FlatBodiesAreAsCoarseAsAsked) {
  const Model model = test::make_box(10, 10, 10);
  SizingOptions options = plain(model, 2);
  options.gaps = true;
  const Sized box = sized(model, options);
  EXPECT_EQ(box.field.smallest(), options.size);
  EXPECT_TRUE(box.field.reductions(model).empty());
}

TEST(BendingSizes, TrimmedAwayPartsDoNotCount) {
  // A quarter of a torus, its outside: no sharper than the tube, and nothing beyond its quarter.
  Model model;
  Placement at;
  test::add_piece(model, make_torus(at, 0.2, 0.02), {0, 0}, {0.5 * kPi, 0.5 * kPi});
  SizingOptions options;
  options.size = 0.2;
  const Sized piece = sized(model, options);
  EXPECT_GT(piece.field.at({-0.2, 0, 0}), 0.05);
  expect_size(piece.field.at({0.22 / std::sqrt(2.0), 0.22 / std::sqrt(2.0), 0}), 2 * kPi * 0.02 / 12);
}

TEST(BendingSizes, GradedFromSmallFeatures) {
  const Model model = test::make_torus(20, 1);
  const SizingOptions options = plain(model, 10);
  const Sized torus = sized(model, options);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.5, 0.5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
    const Vec3 q{coordinate(random), coordinate(random), coordinate(random)};
    ASSERT_LE(std::abs(torus.field.at(p) - torus.field.at(q)), options.grading * distance(p, q) + 1e-14);
  }
}

class Walls : public testing::TestWithParam<double> {};

TEST_P(Walls, ShellIsOnlyAsFineAsItsWallDemands) {
  const double wall = GetParam();
  const Model model = test::make_shell(10, 10 - wall);
  SizingOptions options = plain(model, 10);
  options.curvature = 0;
  options.gaps = true;
  const Sized shell = sized(model, options);
  const double wanted = std::sqrt(2 * wall * 10);
  for (int i = 0; i < 20; ++i)
    for (int j = -9; j <= 9; ++j) {
      const double u = 2 * kPi * i / 20, v = 0.5 * kPi * j / 10;
      const double size = shell.at({10 * std::cos(v) * std::cos(u), 10 * std::cos(v) * std::sin(u), 10 * std::sin(v)});
      EXPECT_GT(size, 0.85 * wanted);
      EXPECT_LT(size, 1.26 * wanted);
    }
}

TEST_P(Walls, TubeIsOnlyAsFineAsItsWallDemands) {
  const double wall = GetParam();
  const Model model = test::make_tube(10, 10 - wall, 30);
  SizingOptions options = plain(model, 10);
  options.curvature = 0;
  options.gaps = true;
  const Sized tube = sized(model, options);
  const double wanted = std::sqrt(2 * wall * 10);
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j <= 10; ++j) {
      const double size = tube.at(on_circle(10, 2 * kPi * i / 20, 3.0 * j));
      EXPECT_GT(size, 0.85 * wanted);
      EXPECT_LT(size, 1.26 * wanted);
    }
}

INSTANTIATE_TEST_SUITE_P(Thickness, Walls, testing::Values(1.0, 0.5, 0.2, 0.02));

TEST(Gaps, PlateOfAnyThinnessDemandsNothing) {
  for (const double thickness : {1.0, 0.01, 0.0001}) {
    const Model model = test::make_box(10, 10, thickness);
    SizingOptions options = plain(model, 2);
    options.gaps = true;
    const Sized plate = sized(model, options);
    // Its short edges may grade from their own length and its sides be strips, but nothing is due to a gap.
    for (const SizeSource& source : plate.field.sources()) EXPECT_NE(source.reason, SizeReason::gap);
    EXPECT_EQ(plate.at({5, 5, 0}), 2);
  }
}

TEST(Gaps, EccentricBoreIsFineOnlyAtItsThinSide) {
  Model model;
  test::add_pipe(model, {0, 0, -0.2}, 0.2, 0.4);
  test::add_pipe(model, {0.0198, 0, -0.2}, 0.18, 0.4);  // walls from 0.0002 to 0.0398
  SizingOptions options;
  options.size = 0.2;
  const Sized pipe = sized(model, options);
  for (int i = -9; i <= 9; ++i) {
    const double thin = pipe.field.at({0.2, 0, 0.02 * i});
    EXPECT_GT(thin, 0.8 * std::sqrt(2 * 0.0002 * 0.18));
    EXPECT_LT(thin, 1.25 * std::sqrt(2 * 0.0002 * 0.2));
    EXPECT_GT(pipe.field.at({-0.2, 0, 0.02 * i}), 0.08);
  }
}

TEST(Gaps, BallNearAPlaneIsFineOnlyThere) {
  Model model;
  Placement at;
  test::add_piece(model, make_sphere(at, 0.2), {0, -0.5 * kPi}, {2 * kPi, 0.5 * kPi});
  at.origin = {0.2001, 0, 0};
  at.z = {1, 0, 0};
  at.x = {0, 1, 0};
  at.y = {0, 0, 1};
  test::add_piece(model, make_plane(at), {-0.4, -0.4}, {0.4, 0.4});
  SizingOptions options;
  options.size = 0.2;
  const Sized body = sized(model, options);
  const double there = std::sqrt(2 * 0.0001 * 0.2);
  EXPECT_GT(body.field.at({0.2, 0, 0}), 0.9 * there);
  EXPECT_LT(body.field.at({0.2, 0, 0}), 1.25 * there);
  EXPECT_GT(body.field.at({-0.2, 0, 0}), 0.09);
}

TEST(Gaps, BoresThatNearlyTouch) {
  Model model;
  test::add_pipe(model, {0, 0, -0.2}, 0.1, 0.4);
  test::add_pipe(model, {0.2005, 0, -0.2}, 0.1, 0.4);
  SizingOptions options;
  options.size = 0.1;
  const Sized body = sized(model, options);
  const double there = std::sqrt(2 * 0.0005 * 0.1);
  for (int i = -9; i <= 9; ++i) {
    EXPECT_GT(body.field.at({0.1, 0, 0.02 * i}), 0.9 * there);
    EXPECT_LT(body.field.at({0.1, 0, 0.02 * i}), 1.25 * there);
    EXPECT_GT(body.field.at({-0.1, 0, 0.02 * i}), 0.9 * 2 * kPi * 0.1 / 12);
  }
}

TEST(Gaps, ContactIsNoGap) {
  Model model;
  test::add_pipe(model, {0, 0, -0.2}, 0.1, 0.4);
  test::add_pipe(model, {0, 0, -0.2}, 0.1, 0.4);
  SizingOptions options;
  options.size = 0.1;
  const Sized body = sized(model, options);
  for (const SizeSource& source : body.field.sources()) EXPECT_NE(source.reason, SizeReason::gap);
}

TEST(Gaps, SharpRimIsNoGapWithoutEnd) {
  const Model model = test::make_lens(10, 2);
  SizingOptions options = plain(model, 4);
  options.gaps = true;
  const Sized lens = sized(model, options);
  EXPECT_GT(lens.field.smallest(), 0.25 * options.size);
}

TEST(Gaps, SwitchedOffDemandNothing) {
  const Model model = test::make_shell(10, 9.8);
  SizingOptions options = plain(model, 30);
  const Sized shell = sized(model, options);
  expect_size(shell.at({0, 0, 9.8}), 2 * kPi * 9.8 / 12);
}

TEST(Gaps, SaysWhichFacesAndHowWide) {
  const Model model = test::make_shell(10, 9.8);
  SizingOptions options = plain(model, 10);
  options.gaps = true;
  const Sized shell = sized(model, options);
  const auto reductions = shell.field.reductions(model);
  ASSERT_EQ(reductions.size(), 2u);
  for (const SizeReduction& reduction : reductions) {
    EXPECT_EQ(reduction.reason, SizeReason::gap);
    EXPECT_NE(reduction.face, reduction.other);
    EXPECT_NEAR(model.frame.length_to_cad(reduction.gap), 0.2, 1e-6);
  }
}

// Chord heights allow sqrt(2 * 0.03 * 9.97), as they do where there is no solid between the sheets.
TEST(Gaps, AThinWallIsMeshedForTheAnglesThroughIt) {
  Model model = test::make_shell(10, 9.97);
  SizingOptions options = plain(model, 2);
  options.gaps = true;
  const Sized shell = sized(model, options);
  expect_size(shell.at({0, 0, 9.97}), 0.4);  // a fifth of the size asked
  options.size *= 0.5;
  expect_size(sized(model, options).at({0, 0, 9.97}), 0.3);  // ten walls
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    std::swap(model.faces[FaceId(f)].front, model.faces[FaceId(f)].back);
  expect_size(sized(model, options).at({0, 0, 9.97}), std::sqrt(2 * 0.03 * 9.97));
}

TEST(AskedSizes, GrowFromTheirEntities) {
  const Model model = test::make_box(10, 10, 10);
  SizingOptions options = plain(model, 4);
  options.face_size[0] = options.size / 8;
  const Sized box = sized(model, options);
  const ModelFace& face = model.faces[FaceId(0)];
  const Vec3 middle = face.surface->value(0.5 * (face.low + face.high));
  EXPECT_EQ(box.field.at_face(FaceId(0), middle), options.size / 8);
  EXPECT_LE(box.field.at(middle), 1.5 * options.size / 8);
  EXPECT_EQ(box.field.at_edge(face.loops[0].uses[0].edge, middle), options.size / 8);
  EXPECT_GT(box.field.at(model.box.centre()), options.size / 4);
}

TEST(MakeSizeField, SameForAnyNumberOfThreads) {
  const Model model = test::make_tube(10, 9.7, 30);
  SizingOptions options = plain(model, 3);
  options.gaps = true;
  Context one, many;
  one.threads = 1;
  many.threads = 4;
  const auto a = make_size_field(model, options, one), b = make_size_field(model, options, many);
  ASSERT_TRUE(a.ok() && b.ok());
  ASSERT_EQ(a.value().sources().size(), b.value().sources().size());
  for (std::size_t i = 0; i < a.value().sources().size(); ++i) {
    EXPECT_EQ(a.value().sources()[i].where, b.value().sources()[i].where);
    EXPECT_EQ(a.value().sources()[i].size, b.value().sources()[i].size);
  }
}

TEST(MakeSizeField, RefusesOptionsThatMakeNoSense) {
  const Model model = test::make_ball(1);
  Context context;
  SizingOptions options;
  EXPECT_EQ(make_size_field(model, options, context).error().code, ErrorCode::bad_option);
  options.size = 0.1;
  options.grading = 0;
  EXPECT_EQ(make_size_field(model, options, context).error().code, ErrorCode::bad_option);
}

TEST(MakeSizeField, StopsWhenCancelled) {
  const Model model = test::make_ball(1);
  Context context;
  context.cancel();
  SizingOptions options;
  options.size = 0.1;
  EXPECT_EQ(make_size_field(model, options, context).error().code, ErrorCode::cancelled);
}

/// A plate's size, without what its curvature and gaps ask for. Its sides are strips.
Sized plate(const Model& model) {
  SizingOptions options = plain(model, 5);
  options.curvature = 0;
  return sized(model, options);
}

bool any_narrow_face(const Sized& body) {
  return std::any_of(body.field.sources().begin(), body.field.sources().end(),
                     [](const SizeSource& source) { return source.reason == SizeReason::narrow_face; });
}

TEST(StripSizes, BesideANarrowFaceElementsAreOfFiftyWidths) {
  const Model model = test::make_box(40, 40, 0.05);
  const Sized box = plate(model);
  for (int i = 10; i <= 30; ++i)  // away from the short edges at the corners
    for (double z : {0.0, 0.05}) expect_size(box.at({1.0 * i, 0, z}), 2.5);
  EXPECT_DOUBLE_EQ(box.at({20, 20, 0}), 5);
  EXPECT_TRUE(any_narrow_face(box));
}

TEST(StripSizes, NeitherAWideFaceNorASliverDemandsAnything) {
  for (double thickness : {0.2, 0.01}) {
    const Model model = test::make_box(40, 40, thickness);
    const Sized box = plate(model);
    EXPECT_DOUBLE_EQ(box.at({20, 0, 0}), 5) << "thickness " << thickness;
    EXPECT_FALSE(any_narrow_face(box)) << "thickness " << thickness;
  }
}

}  // namespace
}  // namespace curvetet
