// Shapes drawn at random, as a designer might come by them.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "random/draw.h"

namespace curvetet::test {

/// A way to draw a shape. It may throw Standard_Failure, or give a shape that is not sound.
struct ShapeKind {
  std::string name;
  TopoDS_Shape (*draw)(Draw&);
};

/// Solids to combine: blocks, cylinders, balls, cones, tori, prisms, lofts, pipes, revolutions.
const std::vector<ShapeKind>& primitive_kinds();
/// Whole bodies: combinations of primitives, plates, shells, tips, stacks and assemblies.
const std::vector<ShapeKind>& body_kinds();

/// At least one solid, valid by BRepCheck_Analyzer, with some volume, without faces that cross by
/// BOPAlgo_ArgumentAnalyzer.
bool is_sound(const TopoDS_Shape& shape);

}  // namespace curvetet::test
