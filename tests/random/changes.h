// Changes of a shape that are tried: where the CAD kernel fails, or leaves no solid, the shape stays as it was.
#pragma once

#include <Standard_Failure.hxx>
#include <TopoDS_Shape.hxx>

#include "random/shapes.h"

namespace curvetet::test {

/// At least one solid, valid by BRepCheck_Analyzer, with some volume.
bool has_volume(const TopoDS_Shape& shape);

template <typename Change>
TopoDS_Shape try_change(const TopoDS_Shape& shape, Change change) {
  try {
    const TopoDS_Shape changed = change();
    return has_volume(changed) ? changed : shape;
  } catch (const Standard_Failure&) {
    return shape;
  }
}

TopoDS_Shape primitive(Draw& draw);
TopoDS_Shape fuse(const TopoDS_Shape& shape, const TopoDS_Shape& tool);
TopoDS_Shape cut(const TopoDS_Shape& shape, const TopoDS_Shape& tool);
/// The union, the difference or what both have in common.
TopoDS_Shape join(Draw& draw, const TopoDS_Shape& shape, const TopoDS_Shape& tool);
/// With some fillets, chamfers, a hollow, a draft, mirrored, as B-splines, or as it is.
TopoDS_Shape dress(Draw& draw, const TopoDS_Shape& shape);

}  // namespace curvetet::test
