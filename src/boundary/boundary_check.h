// What must hold of the surface meshes at every stage of the boundary.
#pragma once

#include <string>
#include <vector>

#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"

namespace curvetet {

/// What is broken and where; empty when all of these hold.
/// 1. Curve meshes: parameters strictly rise, ends are the CAD vertices', a closed curve has three segments or more.
/// 2. Face meshes: valid in the chart (FaceMesh::check), not empty.
/// 3. Each segment of a curve mesh is a constrained edge of each face that uses it.
/// 4. t_3d is simplicial over vertex ids (simplicial.h).
/// 5. Around each solid, every edge is run through as often in one direction as in the other, and the volume is
/// positive.
/// 6. No two vertices on the boundary of one solid are at one place. (Solids that touch without sharing entities are no
/// fault of
///    these meshes.)
/// 7. Around each vertex of a face its triangles are the fans that the face has there (vertex_fans.h).
std::vector<std::string> check_boundary(const Model& model, const BoundaryMesh& mesh, const VertexStore& vertices);

}  // namespace curvetet
