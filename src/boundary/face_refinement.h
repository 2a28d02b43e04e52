// Interior points of one face mesh, until its triangles follow the size field.
#pragma once

#include <vector>

#include "base/context.h"
#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"
#include "sizing/size_field.h"

namespace curvetet {

/// Vertices that a face makes while others are refined too; they join the store, and get their final ids, face by face.
inline constexpr std::uint32_t kLocalVertices = 0x80000000U;

struct AddedVertex {
  Vec3 position;  ///< on the grid
  Vec2 uv;
};

/// Refines one face mesh by points at a front that starts at the curves and, where there is none, at the centres of
/// surface Delaunay balls, worst triangle first, and flips in space. Curves are not split. `surface` is the caller's
/// own evaluator of the face's surface. New vertices have ids kLocalVertices + index. Terminates: no point is closer to
/// another than a share of the size field, which has a least value; or, in a fan around a pole, halves an angle of
/// which those above 100 degrees are few. With `smooth` they are then moved (smooth_face).
std::vector<AddedVertex> refine_face(FaceMesh& mesh, FaceId face, const Surface& surface, const SizeField& sizes,
                                     const VertexStore& vertices, bool smooth, const Context& context);

}  // namespace curvetet
