#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "geometry/check.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

struct Named {
  const char* name;
  Model model;
};

std::vector<Named> all_bodies() {
  std::vector<Named> bodies;
  bodies.push_back({"box", test::make_box(3, 2, 1)});
  bodies.push_back({"boxes", test::make_boxes({1, 2, 0.5}, 2, 1)});
  bodies.push_back({"ball", test::make_ball(10)});
  bodies.push_back({"shell", test::make_shell(10, 9.8)});
  bodies.push_back({"nested", test::make_nested_balls(10, 5)});
  bodies.push_back({"cylinder", test::make_cylinder(2, 5)});
  bodies.push_back({"cone", test::make_cone(2, 0, 5)});
  bodies.push_back({"funnel", test::make_cone(0, 2, 5)});
  bodies.push_back({"frustum", test::make_cone(2, 1, 5)});
  bodies.push_back({"torus", test::make_torus(10, 3)});
  bodies.push_back({"tube", test::make_tube(3, 2.5, 8)});
  bodies.push_back({"lens", test::make_lens(5, 0.5)});
  bodies.push_back({"half_ellipsoid", test::make_half_ellipsoid(5, 1)});
  return bodies;
}

TEST(Bodies, AreSound) {
  for (const Named& body : all_bodies()) {
    for (const ModelFault& fault : check_model(body.model)) {
      ADD_FAILURE() << body.name << ": " << name(fault.kind) << ", " << fault.entity << " " << fault.what << " "
                    << fault.amount;
    }
  }
}

/// A line in the parameter plane, stretched along u.
class Stretched final : public ParameterCurve {
 public:
  Stretched(std::shared_ptr<const ParameterCurve> curve, double factor) : curve_(std::move(curve)), factor_(factor) {}
  Vec2 value(double t) const override { return {factor_ * curve_->value(t).x, curve_->value(t).y}; }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<Stretched>(curve_, factor_); }

 private:
  std::shared_ptr<const ParameterCurve> curve_;
  double factor_;
};

bool covers_twice(const Model& model) {
  const std::vector<ModelFault> faults = check_model(model);
  return std::any_of(faults.begin(), faults.end(),
                     [](const ModelFault& f) { return f.kind == ModelFault::Kind::crosses_itself && f.where; });
}

TEST(Bodies, AFaceBeyondAFullTurnCoversItselfTwice) {
  for (const double turns : {0.8, 1.0, 1.2}) {
    Model model = test::make_cylinder(2, 5);
    for (ModelFace& face : model.faces) {
      if (face.surface->kind() != SurfaceKind::cylinder) continue;
      for (Loop& loop : face.loops)
        for (EdgeUse& use : loop.uses) use.curve = std::make_shared<Stretched>(use.curve, turns);
      face.high.x *= turns;
    }
    EXPECT_EQ(covers_twice(model), turns > 1) << turns;
  }
}

/// Flux of the position through the boundary of a solid, by the midpoint rule over the boxes of the faces' domains;
/// only for bodies whose faces fill their boxes.
double flux_volume(const Model& model, SolidId solid) {
  constexpr int kCells = 200;
  double sum = 0;
  for (const FaceId f : model.solids[solid].faces) {
    const ModelFace& face = model.faces[f];
    const double sign = (face.back == solid ? 1 : -1) * (face.reversed ? -1 : 1);
    const Vec2 cell{(face.high.x - face.low.x) / kCells, (face.high.y - face.low.y) / kCells};
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const Vec2 uv{face.low.x + (i + 0.5) * cell.x, face.low.y + (j + 0.5) * cell.y};
        const SurfaceFirst s = face.surface->first(uv);
        sum += sign * dot(s.value, cross(s.du, s.dv)) * cell.x * cell.y / 3;
      }
    }
  }
  return sum;
}

TEST(Bodies, OutwardNormalsGiveTheVolume) {
  std::vector<Named> bodies;
  bodies.push_back({"box", test::make_box(3, 2, 1)});
  bodies.push_back({"boxes", test::make_boxes({1, 2, 0.5}, 2, 1)});
  bodies.push_back({"ball", test::make_ball(10)});
  bodies.push_back({"shell", test::make_shell(10, 8)});
  bodies.push_back({"nested", test::make_nested_balls(10, 5)});
  bodies.push_back({"torus", test::make_torus(10, 3)});
  bodies.push_back({"lens", test::make_lens(5, 0.5)});
  for (const Named& body : bodies) {
    for (std::size_t s = 0; s < body.model.solids.size(); ++s) {
      const double volume = body.model.solids[SolidId(s)].volume;
      EXPECT_NEAR(flux_volume(body.model, SolidId(s)), volume, 1e-3 * volume) << body.name;
    }
  }
}

TEST(Bodies, FitTheWorkingBox) {
  for (const Named& body : all_bodies()) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(body.model.box.low[i], -0.5) << body.name;
      EXPECT_LE(body.model.box.high[i], 0.5) << body.name;
    }
    EXPECT_GE(body.model.diagonal(), 0.25) << body.name;
  }
}

TEST(Bodies, AreasAreTheSurfacesOwn) {
  constexpr int kCells = 100;
  for (const Named& body : all_bodies()) {
    for (const ModelFace& face : body.model.faces) {
      if (face.surface->kind() == SurfaceKind::plane && face.low.x < 0) continue;  // a disc does not fill its box
      double area = 0;
      const Vec2 cell{(face.high.x - face.low.x) / kCells, (face.high.y - face.low.y) / kCells};
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          const SurfaceFirst s =
              face.surface->first({face.low.x + (i + 0.5) * cell.x, face.low.y + (j + 0.5) * cell.y});
          area += norm(cross(s.du, s.dv)) * cell.x * cell.y;
        }
      }
      EXPECT_NEAR(area, face.area, 1e-3 * face.area) << body.name;
    }
  }
}

}  // namespace
}  // namespace curvetet
