// Faces without area between two edges that are one. Inside cad only.
#pragma once

#include "cad/body.h"

namespace curvetet {

/// Leaves out the faces of solids that are narrower than `width` (in the unit of the shape), and joins the faces around
/// them within as much. `body.suppressed` lists what went; whatever is left keeps its id. Returns whether there was a
/// face to leave out; whether the solids are closed still is for the caller to see.
bool drop_empty_faces(CadBody& body, double width);

}  // namespace curvetet
