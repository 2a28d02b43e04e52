// The surface meshes around the place of a failure, and how close two faces come there.
#pragma once

#include <optional>

#include "curvetet/mesh.h"
#include "pipeline/body_mesher.h"

namespace curvetet {

/// The triangles and segments of the failure's faces as far as they got, and of all others those that come within
/// `reach` (working units) of its place. Without points if there are none.
Mesh spot_of(const Model& model, const Settings& settings, const BodyMesh& body, const RecoveryFailure& failure,
             double reach);

struct FaceGap {
  double length = 0;
  Vec3 where;  ///< midway; working coordinates, as the length
};

/// How close the two faces of a failure come to one another within `reach` of its place, measured between their
/// surfaces from vertices of their triangles on: the triangles themselves may cross. Empty if they are not two, have a
/// vertex in common, touch or cross, or if the pair is outside of them.
std::optional<FaceGap> gap_between(const Model& model, const BodyMesh& body, const RecoveryFailure& failure,
                                   double reach);

}  // namespace curvetet
