// Sampling of faces by bisection of their (u,v) boxes, of edges by bisection of their ranges.
//
// Spacing: a field of cones of slope g sampled at spacing s overestimates by at most about 0.7 g s between the samples.
// With s = 0.36 / g of the demanded size, and no more than 0.8, that is at most 26 %, and 10 % on average. Where
// nothing is demanded a patch may be as large as its box stays a fair bound of its surface, which the search for gaps
// relies on: it turns by at most half a radian. Splines are cut into at least 8 x 8 first so that local features are
// met.
//
// Rejected: a tensor grid of u- and v-lines (one sharp bend makes whole rows dense); samples of an isotropic
// triangulation (needs the mesher that needs the size).

#include "sizing/sampling.h"

#include <array>
#include <cmath>

namespace curvetet::sizing {

namespace {

constexpr double kLargestTurning = 0.5;                ///< radians from the middle of a patch
constexpr double kAskedSpacing = 2;                    ///< of a size asked for the face or edge
constexpr std::size_t kMostPatches = 20000;            ///< of a face
constexpr std::size_t kMostPatchesOfBody = 2'000'000;  ///< shared evenly
constexpr std::size_t kLeastBudget = 1000;             ///< of a face, however many there are
constexpr std::size_t kMostEdgeSamples = 4096;

int first_cells(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::plane:
      return 4;
    case SurfaceKind::cylinder:
    case SurfaceKind::cone:
    case SurfaceKind::sphere:
    case SurfaceKind::torus:
      return 2;
    default:
      return 8;
  }
}

double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 d = b - a;
  const double length2 = norm2(d);
  const double t = length2 > 0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0;
  return distance(p, a + t * d);
}

bool box_within(Vec3 p, const Box3& box, double reach) {
  for (int i = 0; i < 3; ++i)
    if (p[i] < box.low[i] - reach || p[i] > box.high[i] + reach) return false;
  return true;
}

/// Bisection of one face, breadth first, so that a face that meets its budget is covered evenly.
class FaceSampler {
 public:
  FaceSampler(const Model& model, FaceId face, const TrimmedDomain& domain, const SizingOptions& options, double asked)
      : face_(face), domain_(domain), options_(options), asked_(asked), bending_(model, face, options) {
    budget_ = std::clamp(kMostPatchesOfBody / std::max<std::size_t>(1, model.faces.size()), kLeastBudget, kMostPatches);
  }

  FaceSamples run() {
    queue_first_cells();
    for (std::size_t next = 0; next < cells_.size(); ++next) {
      const auto [low, high] = cells_[next];
      if (!domain_.meets(low, high)) continue;
      SurfaceBending middle;
      const Patch patch = measure_patch(face_, bending_, low, high, &middle);
      if (!finite(patch.point)) continue;
      const Demand demand = bending_.demand(patch.middle(), middle);
      if (wants_split(patch, demand) && result_.patches.size() + cells_.size() - next < budget_) {
        const auto [one, two] = halves(patch);
        cells_.push_back(one);
        cells_.push_back(two);
      } else {
        keep(patch, demand);
      }
    }
    return std::move(result_);
  }

 private:
  void queue_first_cells() {
    const int n = first_cells(bending_.surface().kind());
    const Vec2 low = domain_.low(), extent = domain_.high() - domain_.low();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        cells_.push_back({low + Vec2{extent.x * i / n, extent.y * j / n},
                          low + Vec2{extent.x * (i + 1) / n, extent.y * (j + 1) / n}});
  }

  bool wants_split(const Patch& patch, const Demand& demand) const {
    const double smallest = std::max(options_.min_size, 1e-6 * options_.size);
    if (patch.extent() <= spacing(options_) * smallest) return false;
    if (demand.size < options_.size && patch.extent() > spacing(options_) * std::max(demand.size, smallest))
      return true;
    return patch.turning > kLargestTurning || patch.extent() > kAskedSpacing * asked_;
  }

  void keep(const Patch& patch, const Demand& demand) {
    result_.patches.push_back(patch);
    if (demand.size < options_.size && domain_.inside(patch.middle()))
      result_.sources.push_back({patch.point, demand.size, demand.reason, face_, FaceId(), 0});
  }

  FaceId face_;
  const TrimmedDomain& domain_;
  const SizingOptions& options_;
  double asked_;
  FaceBending bending_;
  std::size_t budget_ = 0;
  std::vector<std::pair<Vec2, Vec2>> cells_;
  FaceSamples result_;
};

/// One face's bending at an edge, through the edge's parameter curve.
struct Side {
  FaceId face;
  std::unique_ptr<ParameterCurve> curve;
  std::unique_ptr<FaceBending> bending;
};

class EdgeSampler {
 public:
  EdgeSampler(const Model& model, EdgeId id, const SizingOptions& options, double asked)
      : edge_(model.edges[id]), options_(options), asked_(asked), curve_(edge_.curve->clone()) {
    for (const FaceId face : edge_.faces) add_sides(model, id, face);
  }

  EdgeSamples run() {
    const bool line = curve_->kind() == CurveKind::line;
    const int pieces = line ? 2 : 8;
    append(edge_.low);
    for (int i = 1; i <= pieces; ++i) {
      const double t = i == pieces ? edge_.high : edge_.low + (edge_.high - edge_.low) * i / pieces;
      bisect(result_.samples.back(), sample_curve(*curve_, t), 12);
    }
    // An edge no longer than its tolerance is a point: what its curve does there means nothing.
    if (result_.length <= std::max(2 * edge_.tolerance, 64 * kGrid)) return {};
    for (std::size_t i = 0; i + 1 < result_.samples.size(); ++i) {
      if (i % EdgeSamples::kSamplesPerBox == 0) result_.boxes.emplace_back();
      result_.boxes.back().extend(result_.samples[i].point);
      result_.boxes.back().extend(result_.samples[i + 1].point);
    }
    return std::move(result_);
  }

 private:
  void add_sides(const Model& model, EdgeId id, FaceId face) {
    if (model.faces[face].surface->kind() == SurfaceKind::plane) return;
    const auto add = [&](const EdgeUse& use) {
      if (use.edge != id || !use.curve) return false;
      sides_.push_back({face, use.curve->clone(), std::make_unique<FaceBending>(model, face, options_)});
      return true;
    };
    // One use will do: the two of a seam are the same points of the surface.
    for (const Loop& loop : model.faces[face].loops)
      for (const EdgeUse& use : loop.uses)
        if (add(use)) return;
    for (const EdgeUse& use : model.faces[face].internal_edges)
      if (add(use)) return;
  }

  struct Wanted {
    Demand demand;
    FaceId face;
  };

  Wanted wanted(double t) const {
    Wanted result;
    result.demand = curve_demand(edge_, *curve_, t, options_);
    if (!edge_.faces.empty()) result.face = edge_.faces.front();
    for (const Side& side : sides_) {
      const Vec2 uv = side.curve->value(t);
      const Demand demand = side.bending->demand(uv, bending(side.bending->surface(), uv));
      if (demand.size < result.demand.size) result = {demand, side.face};
    }
    return result;
  }

  void bisect(EdgeSample from, EdgeSample to, int depth) {
    const double middle = 0.5 * (from.t + to.t);
    const EdgeSample between = sample_curve(*curve_, middle);
    const double length = distance(from.point, between.point) + distance(between.point, to.point);
    const double want =
        std::max({spacing(options_) * wanted(middle).demand.size, options_.min_size, 1e-6 * options_.size});
    const bool bent = length > 1.03 * distance(from.point, to.point);
    const bool split = (want < options_.size && length > want) || length > kAskedSpacing * asked_ || bent;
    if (depth > 0 && split && result_.samples.size() < kMostEdgeSamples) {
      bisect(from, between, depth - 1);
      bisect(between, to, depth - 1);
    } else {
      result_.length += length;
      append(to.t);
    }
  }

  void append(double t) {
    const EdgeSample at = sample_curve(*curve_, t);
    if (!finite(at.point)) return;
    result_.samples.push_back(at);
    const Wanted want = wanted(t);
    if (want.demand.size < options_.size)
      result_.sources.push_back({at.point, want.demand.size, want.demand.reason, want.face, FaceId(), 0});
  }

  const ModelEdge& edge_;
  const SizingOptions& options_;
  double asked_;
  std::unique_ptr<Curve> curve_;
  std::vector<Side> sides_;
  EdgeSamples result_;
};

}  // namespace

bool EdgeSamples::is_within(Vec3 point, double reach) const {
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    if (!box_within(point, boxes[b], reach)) continue;
    const std::size_t end = std::min((b + 1) * kSamplesPerBox, samples.size() - 1);
    for (std::size_t i = b * kSamplesPerBox; i < end; ++i)
      if (distance_to_segment(point, samples[i].point, samples[i + 1].point) < reach) return true;
  }
  return false;
}

double spacing(const SizingOptions& options) { return std::min(0.8, 0.36 / options.grading); }

EdgeSample sample_curve(const Curve& curve, double t) {
  const CurveSecond c = curve.second(t);
  EdgeSample result;
  result.t = t;
  result.point = c.value;
  const Vec3 tangent = normalized(c.dt);
  const Vec3 across = c.dtt - dot(c.dtt, tangent) * tangent;
  result.towards = normalized(across);
  result.curvature = norm2(c.dt) > 0 ? norm(across) / norm2(c.dt) : 0;
  return result;
}

Patch measure_patch(FaceId face, const FaceBending& bend, Vec2 low, Vec2 high, SurfaceBending* middle) {
  Patch patch;
  patch.face = face;
  patch.low = low;
  patch.high = high;
  const Surface& surface = bend.surface();
  const SurfaceBending at = bending(surface, patch.middle());
  if (middle) *middle = at;
  patch.point = at.point;
  patch.normal = at.normal;
  patch.curvature = bend.effective_curvature(at);
  const Vec2 m = patch.middle();
  const std::array<Vec2, 4> sides{Vec2{low.x, m.y}, Vec2{high.x, m.y}, Vec2{m.x, low.y}, Vec2{m.x, high.y}};
  std::array<double, 4> reach{};
  patch.box.extend(at.point);
  for (std::size_t i = 0; i < 4; ++i) {
    const SurfaceFirst s = surface.first(sides[i]);
    patch.box.extend(s.value);
    reach[i] = distance(s.value, at.point);
    const Vec3 normal = cross(s.du, s.dv);
    if (norm2(normal) > 0 && norm2(at.normal) > 0)
      patch.turning = std::max(patch.turning, angle_between(normal, at.normal));
  }
  for (const Vec2 corner : {low, high, Vec2{low.x, high.y}, Vec2{high.x, low.y}})
    patch.box.extend(surface.value(corner));
  patch.length_u = reach[0] + reach[1];
  patch.length_v = reach[2] + reach[3];
  // The surface bulges out of the box of these nine points by about the height of a chord of half the patch.
  const double bulge = 0.125 * patch.turning * 0.5 * patch.extent();
  patch.box.low = patch.box.low - Vec3{bulge, bulge, bulge};
  patch.box.high = patch.box.high + Vec3{bulge, bulge, bulge};
  return patch;
}

std::pair<std::pair<Vec2, Vec2>, std::pair<Vec2, Vec2>> halves(const Patch& patch) {
  const Vec2 m = patch.middle();
  if (patch.length_u >= patch.length_v) return {{patch.low, {m.x, patch.high.y}}, {{m.x, patch.low.y}, patch.high}};
  return {{patch.low, {patch.high.x, m.y}}, {{patch.low.x, m.y}, patch.high}};
}

FaceSamples sample_face(const Model& model, FaceId face, const TrimmedDomain& domain, const SizingOptions& options,
                        double asked) {
  return FaceSampler(model, face, domain, options, asked).run();
}

EdgeSamples sample_edge(const Model& model, EdgeId edge, const SizingOptions& options, double asked) {
  if (model.edges[edge].degenerate || !model.edges[edge].curve) return {};
  return EdgeSampler(model, edge, options, asked).run();
}

}  // namespace curvetet::sizing
