// Edges that end beside their vertices.
#pragma once

#include <cstdint>

#include "geometry/model.h"

namespace curvetet {

/// Some bodies have vertices with tolerances larger than details: an edge's curve ends far from its vertex, seen from
/// the edge's length. A vertex is moved, within its tolerance, to where most of its edges end. An edge that still ends
/// beside it gets a vertex of its own there, and a short straight edge leads on to the old one, in place of the point
/// edges that bridged the gap in the (u,v) of its faces. Left alone: edges that end beyond their vertex, closed ones,
/// and those of a face without such a bridge. Adds a healing note for each. Before: all but the edges' faces is set.
/// `edge_label` and `vertex_label` are the largest cad ids so far, and are counted up.
void mend_loose_ends(Model& model, std::uint32_t& edge_label, std::uint32_t& vertex_label);

}  // namespace curvetet
