// The curve meshes and face meshes of a body, over one VertexStore: what the first boundary stages make and recovery
// refines.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"
#include "sizing/size_field.h"

namespace curvetet {

/// Why a face could not be meshed in its parameter plane.
struct FaceFailure {
  FaceId face;
  std::string cause;  ///< short, for counting: "loops cross", "no loops", "not nested", ...
  std::string detail;
  Vec3 where;  ///< working coordinates
};

struct BoundaryOptions {
  int loop_rounds = 12;      ///< splits of segments at fault before a face is given up
  bool smooth_faces = true;  ///< points inside moved to better places; off: meshes that ask more of recovery
};

struct BoundaryResult {
  BoundaryMesh mesh;
  std::vector<FaceFailure> failures;  ///< empty when complete
};

/// Stages "curve meshes" and "face meshes" (the paper's section 2). Before: a model and a size field. After: for every
/// face a valid t_ps whose boundary is the curve meshes', and t_3d simplicial over vertex ids within each face and over
/// all. Faces in parallel; vertex ids do not depend on the number of threads.
Result<BoundaryResult> mesh_boundary(const Model& model, const SizeField& sizes, VertexStore& vertices,
                                     const BoundaryOptions& options, Context& context);

/// The criterion for flips in a face mesh, in space: the sum of the angles opposite to the edge exceeds two right ones
/// (with a margin, so that ties are stable), and the flipped triangles do not oppose the surface's normal.
FaceMesh::FlipWanted spatial_criterion(const FaceMesh& mesh, const VertexStore& vertices, const ModelFace& face);

/// Centre of the surface Delaunay ball of a triangle (same distance in space to its three vertices, on the surface),
/// else the centre of the circumscribed ellipse in the metric at the triangle's centroid, as a chart point. Empty if
/// neither is found within reach.
std::optional<Vec2> surface_ball_centre(const FaceMesh& mesh, TriangleId t, const VertexStore& vertices,
                                        const ModelFace& face);
std::optional<Vec2> ellipse_centre(const FaceMesh& mesh, TriangleId t, const ModelFace& face);

}  // namespace curvetet
