// The boundary of one face in its parameter plane: uses of edges put in order and on a common lift.
#pragma once

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <functional>
#include <vector>

#include "geometry/model.h"

namespace curvetet {

/// What tracing needs to know about the model under construction.
struct LoopContext {
  const Model* model = nullptr;
  std::function<EdgeId(const TopoDS_Edge&)> edge;
  /// Makes a degenerate edge at a vertex, with the parameter range [0, 1].
  std::function<EdgeId(CadVertexId)> add_pole;
};

/// Fills loops, internal edges and the domain's box of a face whose surface and tolerance are set. Wires with several
/// closed chains give several loops, slits go to the internal edges, and where the loop jumps in (u,v) at a point where
/// the surface collapses, a pole is put in. What does not join stays open.
/// Holes that run the wrong way round are turned; returns how many.
int trace_loops(const TopoDS_Face& face, const LoopContext& context, ModelFace& out);

}  // namespace curvetet
