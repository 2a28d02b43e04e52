// A CAD kernel's own box either encloses control points (several times too large) or minimizes distances per face,
// which took a thousand times longer than everything else at load. Samples inside the trimmed domain are both quick and
// tight.
#include "geometry/bounds.h"

#include <vector>

namespace curvetet {
namespace {

constexpr int kEdgeSteps = 16, kFaceSteps = 12;

std::vector<Vec2> polygon(const Model& model, const Loop& loop) {
  std::vector<Vec2> points;
  for (const EdgeUse& use : loop.uses) {
    if (use.curve == nullptr) continue;
    const ModelEdge& edge = model.edges[use.edge];
    for (int i = 0; i < kEdgeSteps; ++i) {
      const double s = static_cast<double>(use.reversed ? kEdgeSteps - i : i) / kEdgeSteps;
      points.push_back(use.curve->value(edge.low + s * (edge.high - edge.low)));
    }
  }
  return points;
}

bool odd_crossings(const std::vector<Vec2>& points, Vec2 p) {
  bool odd = false;
  for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
    const Vec2 a = points[i], b = points[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) odd = !odd;
  }
  return odd;
}

void extend_by_face(const Model& model, const ModelFace& face, Box3& box) {
  if (face.surface == nullptr || face.surface->kind() == SurfaceKind::plane) return;
  std::vector<std::vector<Vec2>> loops;
  for (const Loop& loop : face.loops) loops.push_back(polygon(model, loop));
  for (int i = 0; i <= kFaceSteps; ++i) {
    for (int j = 0; j <= kFaceSteps; ++j) {
      const Vec2 uv{face.low.x + (face.high.x - face.low.x) * i / kFaceSteps,
                    face.low.y + (face.high.y - face.low.y) * j / kFaceSteps};
      bool inside = false;
      for (const auto& loop : loops) inside = inside != odd_crossings(loop, uv);
      if (!inside) continue;
      const Vec3 p = face.surface->value(uv);
      if (finite(p)) box.extend(p);
    }
  }
}

}  // namespace

Box3 sampled_box(const Model& model) {
  Box3 box;
  for (const ModelVertex& vertex : model.vertices) box.extend(vertex.point);
  for (const ModelEdge& edge : model.edges) {
    if (edge.curve == nullptr) continue;
    for (int i = 0; i <= kEdgeSteps; ++i) {
      const Vec3 p = edge.curve->value(edge.low + (edge.high - edge.low) * i / kEdgeSteps);
      if (finite(p)) box.extend(p);
    }
  }
  for (const ModelFace& face : model.faces) extend_by_face(model, face, box);
  return box;
}

}  // namespace curvetet
