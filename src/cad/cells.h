// Loose faces of several solids that touch. Inside cad only.
#pragma once

#include "cad/body.h"

namespace curvetet {

/// Makes solids of loose faces that no sewing can tell apart, since faces and edges of several solids coincide: all
/// faces are imprinted on each other and the cells they enclose are found (OpenCASCADE's volume maker). Of the cells
/// those are solids that a face of their own parts from what is outside; two faces that coincide part two solids, which
/// share the place. True, and the body is replaced, when every face bounds a solid.
bool enclose_solids(CadBody& body);

}  // namespace curvetet
