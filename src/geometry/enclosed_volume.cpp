// By Green's theorem the integral of f over a domain is that of F dv around its loops, where F is the integral of f
// along u up to the loop. The inner one is taken by Gauss's rule on panels, the outer one along chords of the loop,
// which is of second order, so that two steps give the limit (Richardson) and what is left of the error. An integral
// over triangles of the domain was rejected: it would take the mesh's own word for where the domain is.
#include "geometry/enclosed_volume.h"

#include <array>
#include <cmath>

namespace curvetet {
namespace {

constexpr int kChords = 64;  ///< along a use, in the first step
constexpr int kPanels = 4;   ///< along u, in the first step

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

/// Of one face, at one step.
class FaceIntegral {
 public:
  FaceIntegral(const Model& model, const ModelFace& face, int step)
      : model_(model), face_(face), centre_(0.5 * (model.box.low + model.box.high)), step_(step) {}

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
    const int chords = kChords * step_;
    double sum = 0;
    Vec2 previous = use.curve->value(edge.low);
    for (int i = 1; i <= chords; ++i) {
      const Vec2 next = use.curve->value(edge.low + (edge.high - edge.low) * i / chords);
      if (next.y != previous.y) sum += (next.y - previous.y) * up_to(0.5 * (previous + next));
      previous = next;
    }
    return use.reversed ? -sum : sum;
  }

  /// From the domain's lowest u to a point.
  double up_to(Vec2 uv) const {
    const double width = (uv.x - face_.low.x) / (kPanels * step_);
    double sum = 0;
    for (int panel = 0; panel < kPanels * step_; ++panel) {
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
  int step_;
};

}  // namespace

EnclosedVolume enclosed_volume(const Model& model, SolidId solid) {
  EnclosedVolume result;
  for (const FaceId f : model.solids[solid].faces) {
    const ModelFace& face = model.faces[f];
    if (face.front == face.back) continue;
    const double once = FaceIntegral(model, face, 1).over_domain(), twice = FaceIntegral(model, face, 2).over_domain();
    const double value = twice + (twice - once) / 3;
    const bool outward = (face.back == solid) != face.reversed;
    result.volume += outward ? value : -value;
    result.error += std::abs(twice - once) / 3;
  }
  return result;
}

}  // namespace curvetet
