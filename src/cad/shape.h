// A shape in memory as a Model, for programs that hold OpenCASCADE shapes themselves.
#pragma once

#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/units.h"
#include "cad/joining.h"
#include "cad/load.h"
#include "curvetet/occt.h"
#include "geometry/model.h"

namespace curvetet {

struct ShapeOptions {
  std::string unit = "mm";  ///< of the shape's coordinates
  ShapeLabels labels;
  Joining joining;
  Length min_feature;                     ///< as LoadOptions::min_feature
  std::vector<std::uint32_t> suspects{};  ///< as LoadOptions::suspects
};

/// Ids are those of TopExp::MapShapes on the shape. Repairs, where the shape needs any, run in this process, on a copy:
/// the shape is not changed. `kept`, if given, receives the healed copy.
Result<Model> model_from_shape(const TopoDS_Shape& shape, const ShapeOptions& options, Context& context,
                               KeptBody* kept = nullptr);

/// As brep_of_parts of a file (cad/kept_body.h), for a shape.
Result<std::string> brep_of_parts(const TopoDS_Shape& shape, const std::vector<std::string>& parts,
                                  const std::string& name);

}  // namespace curvetet
