// Curve meshes: the first step of the boundary. Each CAD edge becomes a chain of segments that follow the size field.
#pragma once

#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"
#include "sizing/size_field.h"

namespace curvetet {

/// Parameters of the points on one edge, ends included, strictly rising: equal shares of the integral of ds / h, at
/// least three segments on a closed edge, no segment that turns by more than about 60 degrees or whose arc is 1.4 times
/// its chord. Before: the edge is not degenerate.
std::vector<double> curve_parameters(const ModelEdge& edge, EdgeId id, const SizeField& sizes);

/// Meshes all curves that some face uses. After: vertices of the store are the CAD vertices in use in CAD order, then
/// the points of the edges in the order of edges and parameters; no two edges with the same ends are both a single
/// segment.
Status mesh_curves(const Model& model, const SizeField& sizes, VertexStore& vertices, BoundaryMesh& mesh,
                   Context& context);

/// Number of a segment: the one between points `segment` and `segment + 1` of an edge's curve mesh.
struct SegmentRef {
  EdgeId edge;
  std::size_t segment = 0;
  friend auto operator<=>(const SegmentRef&, const SegmentRef&) = default;
};

/// Splits segments at their middle parameter (every one at most once, in the order of edges and parameters, whatever
/// the order given). A segment shorter than `floor` is left alone. Returns those that were split.
std::vector<SegmentRef> split_segments(const Model& model, std::vector<SegmentRef> segments, double floor,
                                       VertexStore& vertices, BoundaryMesh& mesh);

}  // namespace curvetet
