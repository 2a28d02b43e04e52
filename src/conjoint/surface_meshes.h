// The curve meshes and face meshes of a body, over one VertexStore: what is refined together with the
// tetrahedralization.
#pragma once

#include <vector>

#include "base/ids.h"
#include "geometry/model.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// Ordered points on one CAD edge, by rising parameter; the ends are the CAD vertices'. Empty for a degenerate edge,
/// whose one vertex is the CAD vertex's.
struct CurveMesh {
  std::vector<VertexId> vertices;
  std::vector<double> parameters;
};

/// A use of an edge by a face, in the numbering that FaceTriangle::use speaks of: loops in order, then internal edges.
struct UseRef {
  const EdgeUse* use = nullptr;
  EdgeId edge;
};

struct BoundaryMesh {
  IndexedVector<CadVertexId, VertexId> cad_vertices;
  IndexedVector<EdgeId, CurveMesh> curves;
  IndexedVector<FaceId, FaceMesh> faces;
  IndexedVector<FaceId, std::vector<UseRef>> uses;  ///< per face, by use number
};

}  // namespace curvetet
