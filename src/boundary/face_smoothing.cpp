// The middle of the neighbours is taken in the chart, whose scales make it about isotropic, and judged in space: where
// the chart misleads, the step is halved once and then left. Where triangles lie folded, the mesh in space is not yet
// that of the chart, and a better shape there may be farther from what recovery can have.
//
// Where a front has left a mesh near equilateral, most nodes are told to stay by a look at their triangles, so that
// more than one evaluation of the surface is seldom made. Descent along the energy's gradient was not tried.
#include "boundary/face_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/frame.h"

namespace curvetet {

namespace {

constexpr int kSweeps = 3;
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kGood = 1.04;  ///< inverse mean ratio of a triangle, 1 at best, up to which a node is left alone
constexpr double kGain = 1e-3;  ///< least relative gain
constexpr double kLeastHeight = 0.75;  ///< over a segment, that a node keeps, over its length; equilateral: 0.87
constexpr double kUpright = 0.8;       ///< cosine of a triangle to the surface below which no node is moved to

class FaceSmoothing {
 public:
  FaceSmoothing(FaceMesh& mesh, NodeId first, std::vector<Corner>& corners, const ChartSurface& on,
                const FaceMesh::FlipWanted& wanted)
      : mesh_(mesh), first_(first), corners_(corners), on_(on), wanted_(wanted) {}

  void run(const Context& context) {
    if (is_folded()) return;
    asleep_.assign(corners_.size(), 0);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      touched_.clear();
      for (std::uint32_t n = first_.value(); n < corners_.size(); ++n) {
        if (n % 256 == 0 && context.should_stop()) return;
        if (asleep_[n] != 0 || !mesh_.triangle_at(NodeId(n)).valid()) continue;
        asleep_[n] = 1;
        improve(NodeId(n));
      }
      if (touched_.empty()) return;
      std::sort(touched_.begin(), touched_.end());
      touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
      mesh_.restore(touched_, wanted_, changed_);
      wake_corners(changed_);
    }
  }

 private:
  bool is_folded() const {
    for (std::size_t k = 0; k < mesh_.triangle_slots(); ++k) {
      const FaceTriangle& t = mesh_.triangle(TriangleId(k));
      if (!t.alive()) continue;
      const Corner &a = corners_[t.node[0].value()], &b = corners_[t.node[1].value()], &c = corners_[t.node[2].value()];
      if (!degenerate(a, b, c) && alignment(a, b, c, on_) < 0) return true;
    }
    return false;
  }

  void improve(NodeId n) {
    mesh_.star(n, star_);
    const Energy now = energy_around(n, corners_[n.value()]);
    if (now.worst <= kGood || !std::isfinite(now.sum)) return;
    const Vec2 here = corners_[n.value()].q, middle = middle_of_neighbours(n);
    for (const double step : {1.0, 0.5}) {
      const Vec2 q{snap(here.x + step * (middle.x - here.x)), snap(here.y + step * (middle.y - here.y))};
      const SurfaceFirst at = on_.surface.first(on_.chart.to_uv(q));
      if (!finite(at.value)) return;
      const Corner there = make_corner({corners_[n.value()].vertex, q}, snap(at.value), at, on_.chart);
      if (!(energy_around(n, there).sum < (1 - kGain) * now.sum)) continue;
      if (nears_curve(n, corners_[n.value()].position, there.position) || !mesh_.move_node(n, q)) continue;
      corners_[n.value()] = there;
      touched_.insert(touched_.end(), star_.begin(), star_.end());
      wake_corners(star_);
      return;
    }
  }

  void wake_corners(const std::vector<TriangleId>& triangles) {
    for (const TriangleId t : triangles)
      for (const NodeId n : mesh_.triangle(t).node) asleep_[n.value()] = 0;
  }

  Vec2 middle_of_neighbours(NodeId n) const {
    Vec2 sum{};
    for (const TriangleId t : star_) {
      const auto& nodes = mesh_.triangle(t).node;
      for (std::size_t i = 0; i < 3; ++i)
        if (nodes[i] == n) sum = sum + corners_[nodes[(i + 1) % 3].value()].q;
    }
    return (1.0 / static_cast<double>(star_.size())) * sum;
  }

  struct Energy {
    double sum = 0, worst = 0;
  };

  /// Of the star with its node at `centre`; infinite where a triangle has no area or stands upright.
  Energy energy_around(NodeId n, const Corner& centre) const {
    Energy energy;
    for (const TriangleId t : star_) {
      const auto& nodes = mesh_.triangle(t).node;
      const auto corner = [&](std::size_t i) -> const Corner& {
        return nodes[i] == n ? centre : corners_[nodes[i].value()];
      };
      const double one = inverse_mean_ratio(corner(0), corner(1), corner(2));
      energy.sum += one;
      energy.worst = std::max(energy.worst, one);
    }
    return energy;
  }

  /// Nearer to a segment of a triangle around than it is, and than a front would have it. Between the chord and the arc
  /// of a segment there may be no face below.
  bool nears_curve(NodeId n, Vec3 here, Vec3 there) const {
    for (const TriangleId t : star_) {
      const FaceTriangle& f = mesh_.triangle(t);
      for (std::size_t i = 0; i < 3; ++i) {
        if (f.node[i] != n || f.use[i] == -1) continue;
        const Vec3 a = corners_[f.node[(i + 1) % 3].value()].position,
                   b = corners_[f.node[(i + 2) % 3].value()].position;
        const double then = norm(cross(a - there, b - there));  // distance times length
        if (then < kLeastHeight * norm2(b - a) && then < norm(cross(a - here, b - here))) return true;
      }
    }
    return false;
  }

  static double inverse_mean_ratio(const Corner& a, const Corner& b, const Corner& c) {
    const Vec3 ab = b.position - a.position, ac = c.position - a.position, normal = cross(ab, ac);
    const double twice_area = norm(normal);
    const Vec3 outward = a.normal + b.normal + c.normal;
    if (!(twice_area > 0) || degenerate(a, b, c) || dot(normal, outward) < kUpright * twice_area * norm(outward))
      return kInfinite;
    return (norm2(ab) + norm2(ac) + norm2(ac - ab)) / (2 * std::sqrt(3.0) * twice_area);
  }

  FaceMesh& mesh_;
  NodeId first_;
  std::vector<Corner>& corners_;
  ChartSurface on_;
  const FaceMesh::FlipWanted& wanted_;
  std::vector<TriangleId> star_, touched_, changed_;
  std::vector<char> asleep_;  ///< nodes around which nothing has changed since they were looked at
};

}  // namespace

void smooth_face(FaceMesh& mesh, NodeId first, std::vector<Corner>& corners, const ChartSurface& on,
                 const FaceMesh::FlipWanted& wanted, const Context& context) {
  FaceSmoothing(mesh, first, corners, on, wanted).run(context);
}

}  // namespace curvetet
