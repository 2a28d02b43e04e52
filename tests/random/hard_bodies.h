// Bodies with what is hard to mesh: details far below the body's size.
#pragma once

#include <TopoDS_Shape.hxx>

#include "random/draw.h"

namespace curvetet::test {

/// Blocks that are flush but for a step or gap of a tenth to a millionth.
TopoDS_Shape near_faces(Draw& draw);
/// A primitive with slits of a tenth to a ten-thousandth.
TopoDS_Shape slits(Draw& draw);
/// Edges with angles from thirty degrees to a fifth of a degree.
TopoDS_Shape knife(Draw& draw);
/// Cylinders and balls that touch the faces of a block, or nearly.
TopoDS_Shape tangent(Draw& draw);
/// A block with up to twenty small primitives on and in it.
TopoDS_Shape many_features(Draw& draw);
/// A wire along a helix.
TopoDS_Shape coil(Draw& draw);

}  // namespace curvetet::test
