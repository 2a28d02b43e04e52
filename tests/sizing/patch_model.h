// Models out of rectangular pieces of analytic surfaces, for tests of sizes: no topology beyond each piece's own
// border.
#pragma once

#include "geometry/analytic.h"
#include "geometry/model.h"

namespace curvetet::test {

/// The image in space of a straight line in the parameter plane of a surface.
class IsoCurve final : public Curve {
 public:
  IsoCurve(std::shared_ptr<const Surface> surface, Vec2 origin, Vec2 direction)
      : surface_(std::move(surface)), origin_(origin), direction_(direction) {}
  CurveKind kind() const override { return CurveKind::other; }
  Vec3 value(double t) const override { return surface_->value(origin_ + t * direction_); }
  CurveSecond second(double t) const override {
    const SurfaceSecond s = surface_->second(origin_ + t * direction_);
    const double a = direction_.x, b = direction_.y;
    return {s.value, a * s.du + b * s.dv, a * a * s.duu + 2 * a * b * s.duv + b * b * s.dvv};
  }
  std::unique_ptr<Curve> clone() const override { return std::make_unique<IsoCurve>(surface_, origin_, direction_); }

 private:
  std::shared_ptr<const Surface> surface_;
  Vec2 origin_, direction_;
};

/// Adds the piece [low, high] of the surface as a face with four edges of its own.
inline FaceId add_piece(Model& model, std::shared_ptr<const Surface> surface, Vec2 low, Vec2 high) {
  const FaceId id(model.faces.size());
  ModelFace face;
  face.surface = surface;
  face.low = low;
  face.high = high;
  const Vec2 corners[4] = {low, {high.x, low.y}, high, {low.x, high.y}};
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  Loop loop;
  for (std::uint32_t i = 0; i < 4; ++i) {
    ModelVertex vertex;
    vertex.point = surface->value(corners[i]);
    model.vertices.push_back(vertex);
    const Vec2 along = corners[(i + 1) % 4] - corners[i];
    ModelEdge edge;
    edge.curve = std::make_shared<IsoCurve>(surface, corners[i], along);
    edge.high = 1;
    edge.start = CadVertexId(first + i);
    edge.end = CadVertexId(first + (i + 1) % 4);
    edge.faces = {id};
    EdgeUse use;
    use.edge = model.edges.push_back(edge);
    use.curve = make_parameter_line(corners[i], along);
    loop.uses.push_back(use);
  }
  face.loops.push_back(loop);
  return model.faces.push_back(face);
}

/// A full cylinder around an axis parallel to z.
inline FaceId add_pipe(Model& model, Vec3 foot, double radius, double height) {
  Placement at;
  at.origin = foot;
  return add_piece(model, make_cylinder(at, radius), {0, 0}, {6.283185307179586, height});
}

}  // namespace curvetet::test
