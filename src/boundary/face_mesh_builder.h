// Face meshes before refinement: the curve meshes carried into each face's chart, and triangulated once they are simple
// and nested there.
#pragma once

#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "boundary/boundary_mesh.h"
#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"

namespace curvetet {

/// The chart of a face: its parameter curves fit into [-1/2, 1/2]^2, the scales are the mean lengths of the derivatives
/// over the trimmed domain.
struct ScaledChart {
  Chart chart;
  double per_length = 0;  ///< mean length in the chart of a unit of working length
};
ScaledChart make_chart(const ModelFace& face, const Model& model);

/// Builds all face meshes on the curve meshes, splitting segments whose chords cross or are not nested in some chart
/// (and those whose region between chord and arc holds something else), in rounds over all faces. Terminates: each
/// round splits a segment, no segment below the floor is split, and there are at most `options.loop_rounds` rounds.
/// After: mesh.uses, and mesh.faces[f] for every face that is not in `failures`.
Status build_face_meshes(const Model& model, const BoundaryOptions& options, VertexStore& vertices, BoundaryMesh& mesh,
                         std::vector<FaceFailure>& failures, Context& context);

}  // namespace curvetet
