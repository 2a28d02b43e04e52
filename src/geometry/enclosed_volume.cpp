// By Green's theorem the integral of f over a domain is that of F dv around its loops, where F is the integral of f
// along u up to the loop. The inner one is taken by Gauss's rule on panels, the outer one along chords of the loop,
// which is of second order, so that two steps give the limit (Richardson) and what is left of the error; both are
// halved until that is little. An integral over triangles of the domain was rejected: it would take the mesh's own word
// for where the domain is.
#include "geometry/enclosed_volume.h"

#include <array>
#include <cmath>

namespace curvetet {
namespace {

constexpr int kChords = 64;    ///< along a use, in the first step
constexpr int kPanels = 4;     ///< along u, in the first step
constexpr int kMostSteps = 5;  ///< halvings of both: an outline may have many waves on one edge
/// Of the volume of the body's box: an error that is not worth another step.
constexpr double kLittle = 1e-6;

/// Gauss's rule with five points on [0,1].
struct GaussPoint {
  double at, weight;
};
const std::array<GaussPoint, 5> kGauss = [] {
  const double near = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3, far = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
  const double heavy = (322 + 13 * std::sqrt(70.0)) / 1800, light = (322 - 13 * std::sqrt(70.0)) / 1800;
  return std::array<GaussPoint, 5>{{{0.5 - 0.5 * far, light},
                                    {0.5 - 0.5 * near, heavy},
                                    {0.5, 64.0 / 225},
                                    {0.5 + 0.5 * near, heavy},
                                    {0.5 + 0.5 * far, light}}};
}();

/// Of one face, after so many halvings.
class FaceIntegral {
 public:
  FaceIntegral(const Model& model, const ModelFace& face, int step)
      : model_(model),
        face_(face),
        centre_(0.5 * (model.box.low + model.box.high)),
        chords_(kChords << step),
        panels_(kPanels << step) {}

  double over_domain() const {
    double sum = 0;
    for (const Loop& loop : face_.loops) {
      for (const EdgeUse& use : loop.uses) sum += along(use);
    }
    return sum;
  }

 private:
  double along(const EdgeUse& use) const {
    const ModelEdge& edge = model_.edges[use.edge];
    double sum = 0;
    Vec2 previous = use.curve->value(edge.low);
    for (int i = 1; i <= chords_; ++i) {
      const Vec2 next = use.curve->value(edge.low + (edge.high - edge.low) * i / chords_);
      if (next.y != previous.y) sum += (next.y - previous.y) * up_to(0.5 * (previous + next));
      previous = next;
    }
    return use.reversed ? -sum : sum;
  }

  /// From the domain's lowest u to a point.
  double up_to(Vec2 uv) const {
    const double width = (uv.x - face_.low.x) / panels_;
    double sum = 0;
    for (int panel = 0; panel < panels_; ++panel) {
      for (const GaussPoint& g : kGauss) {
        const SurfaceFirst at = face_.surface->first({face_.low.x + (panel + g.at) * width, uv.y});
        sum += g.weight * dot(at.value - centre_, cross(at.du, at.dv));
      }
    }
    return sum * width / 3;
  }

  const Model& model_;
  const ModelFace& face_;
  Vec3 centre_;
  int chords_, panels_;
};

/// Over the domain of a face, to an error that is little, if that can be had.
EnclosedVolume of_face(const Model& model, const ModelFace& face) {
  const Vec3 sides = model.box.high - model.box.low;
  const double little = kLittle * sides.x * sides.y * sides.z;
  EnclosedVolume result;
  double before = FaceIntegral(model, face, 0).over_domain();
  for (int step = 1; step <= kMostSteps; ++step) {
    const double now = FaceIntegral(model, face, step).over_domain();
    result = {now + (now - before) / 3, std::abs(now - before) / 3};
    if (result.error <= little) break;
    before = now;
  }
  return result;
}

}  // namespace

EnclosedVolume enclosed_volume(const Model& model, SolidId solid) {
  EnclosedVolume result;
  for (const FaceId f : model.solids[solid].faces) {
    const ModelFace& face = model.faces[f];
    if (face.front == face.back) continue;
    const EnclosedVolume of = of_face(model, face);
    const bool outward = (face.back == solid) != face.reversed;
    result.volume += outward ? of.volume : -of.volume;
    result.error += of.error;
  }
  return result;
}

}  // namespace curvetet
