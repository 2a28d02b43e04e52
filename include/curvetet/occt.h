// Meshing of an OpenCASCADE shape in memory, as FreeCAD, CadQuery, build123d and other programs hold it. The only
// header of the library that names an OpenCASCADE type; with CMake: find_package(curvetet COMPONENTS occt) and
// curvetet::occt. The program must use the OpenCASCADE that curvetet was built with.
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "curvetet/curvetet.h"

namespace curvetet {

/// A name or a colour for one solid, face, edge or vertex of the shape, located as TopExp::MapShapes finds it there.
struct PartLabel {
  TopoDS_Shape part;
  std::string name;
  std::optional<std::array<double, 3>> colour{};  ///< red, green, blue in [0,1]
};

/// What a shape does not say about itself.
struct ShapeLabels {
  std::string name = "shape";  ///< what messages and the report call the shape
  std::vector<PartLabel> parts;
};

/// Meshes a shape as mesh(Input) does a file: same stages, same promises. The ids are those of TopExp::MapShapes on the
/// shape. Its unit is `options.input_unit`, by default mm. A copy is read and repaired, so the shape stays as it is;
/// this happens in the caller's process (`options.isolate_cad` means files only). Further errors: bad_option for a
/// label whose part is not in the shape.
Result<MeshOutput> mesh(const TopoDS_Shape& shape, const Options& options, Context& context,
                        Report* report_on_failure = nullptr);
Result<MeshOutput> mesh(const TopoDS_Shape& shape, const ShapeLabels& labels, const Options& options, Context& context,
                        Report* report_on_failure = nullptr);

}  // namespace curvetet
