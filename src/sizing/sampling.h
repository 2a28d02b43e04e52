// Samples of the boundary: patches that cover each trimmed face, points along each edge, and the sizes their bending
// demands.
#pragma once

#include <vector>

#include "geometry/model.h"
#include "geometry/trimmed_domain.h"
#include "sizing/curvature.h"

namespace curvetet::sizing {

/// A cell of a face's (u,v) box that meets the trimmed domain.
struct Patch {
  FaceId face;
  Vec2 low, high;  ///< in (u,v)
  Vec3 point;      ///< of the middle
  Vec3 normal;     ///< unit, or zero
  double length_u = 0, length_v = 0;
  double curvature = 0;  ///< effective, at the middle
  double turning = 0;    ///< largest angle between the middle's normal and those around it
  Box3 box;              ///< holds the patch's surface, up to the accuracy of its curvature
  Vec2 middle() const { return 0.5 * (low + high); }
  double extent() const { return std::max(length_u, length_v); }
};

/// Spacing of sources over the demanded size, such that the field between them is at most 26 % larger than demanded, 10
/// % on average.
double spacing(const SizingOptions& options);

/// Measures the cell [low, high] of a face: one evaluation in the middle, eight around it.
Patch measure_patch(FaceId face, const FaceBending& bending, Vec2 low, Vec2 high, SurfaceBending* middle = nullptr);

/// Halves the cell across its longer side.
std::pair<std::pair<Vec2, Vec2>, std::pair<Vec2, Vec2>> halves(const Patch& patch);

struct FaceSamples {
  std::vector<Patch> patches;       ///< cover the trimmed domain
  std::vector<SizeSource> sources;  ///< sizes below the largest that bending demands
};

/// Splits the face's box until each patch is about as long as the size that its bending demands, at most twice the size
/// asked for the face, and turns little.
FaceSamples sample_face(const Model& model, FaceId face, const TrimmedDomain& domain, const SizingOptions& options,
                        double asked);

struct EdgeSample {
  double t = 0;
  Vec3 point;
  double curvature = 0;
  Vec3 towards;  ///< unit direction in which the curve bends (its principal normal), zero where straight
};

EdgeSample sample_curve(const Curve& curve, double t);

struct EdgeSamples {
  std::vector<EdgeSample> samples;  ///< in the order of the parameter, ends included
  double length = 0;
  std::vector<SizeSource> sources;
  std::vector<Box3> boxes;  ///< of each run of kSamplesPerBox stretches between samples
  static constexpr std::size_t kSamplesPerBox = 16;
  /// Is the polygon of the samples within this distance of the point?
  bool is_within(Vec3 point, double reach) const;
};

/// Samples the edge as densely as its bending and that of its faces demand. A degenerate edge has none.
EdgeSamples sample_edge(const Model& model, EdgeId edge, const SizingOptions& options, double asked);

}  // namespace curvetet::sizing
