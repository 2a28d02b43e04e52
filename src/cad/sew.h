// Faces into closed shells, and closed shells into solids. Inside cad only.
#pragma once

#include <TopoDS_Edge.hxx>
#include <vector>

#include "cad/body.h"

namespace curvetet {

/// Diagonal of the kernel's box, 1 where there is none.
double diagonal_of(const TopoDS_Shape& shape);

/// Edges that the faces of a shape use once in all; faces embedded in a solid do not count.
std::vector<TopoDS_Edge> free_edges(const TopoDS_Shape& shape);

/// Sews all faces with growing tolerances, orients each closed shell and makes solids of them: a shell inside another
/// one is a void of it, one inside a void a solid again. True when there is at least one; the body is then replaced,
/// and notes say what was done. `left_open`: the free edges of shells that did not close.
bool sew(CadBody& body, std::vector<TopoDS_Edge>& left_open);

}  // namespace curvetet
