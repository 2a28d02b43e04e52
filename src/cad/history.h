// The kernel's general fuse on a body with labels. Inside cad only.
#pragma once

#include <BOPAlgo_Builder.hxx>
#include <BRepTools_Modifier.hxx>
#include <vector>

#include "cad/body.h"

namespace curvetet {

/// What became of the parts of a body: first swept lines become cylinders and cones (see elementary.h), then one fuse
/// after the other changes them.
class FuseHistory {
 public:
  explicit FuseHistory(const CadBody& body);
  /// A builder has run, on parts of the body or on what the builders before made of them. It must outlive this object.
  void add(BOPAlgo_Builder& builder) { builders_.push_back(&builder); }
  /// The part as the builder should get it.
  TopoDS_Shape elementary(const TopoDS_Shape& part) { return modified_ ? modifier_.ModifiedShape(part) : part; }
  /// After the builders ran: the part itself, or what it was split into or replaced by; empty if nothing is left.
  TopTools_ListOfShape images(const TopoDS_Shape& part);
  /// The same as a compound.
  TopoDS_Shape image(const TopoDS_Shape& part);
  /// Did a builder change the part?
  bool is_changed(const TopoDS_Shape& part);
  /// Notes which faces were split, and which coincide with others.
  void note_faces(CadBody& body);

 private:
  std::vector<BOPAlgo_Builder*> builders_;
  BRepTools_Modifier modifier_;
  bool modified_ = false;
};

}  // namespace curvetet
