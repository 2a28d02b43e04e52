// Vertices that lie beside the ends of their edges.
#pragma once

#include "geometry/model.h"

namespace curvetet {

/// Some bodies have vertices with tolerances larger than details: an edge's curve ends far from its vertex, seen from
/// the edge's length. Such a vertex is moved, within its tolerance and within what tolerances may explain at all
/// (CheckOptions::largest), to the end of an edge where fewer edges end beside it. Adds a healing note for each.
/// Before: vertices, edges and the faces' loops are set.
void settle_vertices(Model& model);

}  // namespace curvetet
