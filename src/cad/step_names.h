// Names that a STEP file gives to single solids, faces and edges.
#pragma once

#include <XSControl_WorkSession.hxx>

#include "cad/body.h"

namespace curvetet {

/// Puts the names of the file's entities on the labels of the parts made from them, every instance alike. A solid's own
/// name replaces its product's only where the product has several solids.
void add_step_names(const Handle(XSControl_WorkSession) & session, CadBody& body);

}  // namespace curvetet
