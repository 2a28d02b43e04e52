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

struct SewingResult {
  bool any = false;                     ///< at least one shell closed
  std::size_t open_shells = 0;          ///< that did not close, or cannot be turned to face outward
  std::vector<TopoDS_Edge> open_edges;  ///< free edges of those that did not close
};

/// Sews all faces with growing tolerances, orients each closed shell and makes solids of them: a shell inside another
/// one is a void of it, one inside a void a solid again. When there is at least one the body is replaced, and notes say
/// what was done.
SewingResult sew(CadBody& body);

}  // namespace curvetet
