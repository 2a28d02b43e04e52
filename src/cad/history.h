// The kernel's general fuse on a body with labels. Inside cad only.
#pragma once

#include <BOPAlgo_Builder.hxx>
#include <BRepTools_Modifier.hxx>

#include "cad/body.h"

namespace curvetet {

/// What became of the parts of a body: first swept lines become cylinders and cones (see elementary.h), then the fuse
/// changes them.
class FuseHistory {
 public:
  FuseHistory(const CadBody& body, BOPAlgo_Builder& builder);
  /// The part as the builder should get it.
  TopoDS_Shape elementary(const TopoDS_Shape& part) { return modified_ ? modifier_.ModifiedShape(part) : part; }
  /// After the builder ran: the part itself, or what it was split into or replaced by; empty if nothing is left.
  TopTools_ListOfShape images(const TopoDS_Shape& part);
  /// The same as a compound.
  TopoDS_Shape image(const TopoDS_Shape& part);
  /// Notes which faces were split, and which coincide with others.
  void note_faces(CadBody& body);

 private:
  BOPAlgo_Builder& builder_;
  BRepTools_Modifier modifier_;
  bool modified_ = false;
};

}  // namespace curvetet
