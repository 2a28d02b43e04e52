// Solids of an assembly that claim the same space. Inside cad only.
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// What two solids of a body (by their places in sub_shapes, from 1) have in common.
struct Overlap {
  int one = 0, two = 0;
  double volume = 0;
  Vec3 place;
};

/// Is the point inside, by the parity of the shells around it? Those of voids need not be turned the right way.
bool is_inside(const TopoDS_Shape& solid, Vec3 point);

/// Solids that overlap by less only touch, as far as their tolerances tell.
double overlap_depth(const CadBody& body);

/// Names the pair, the volume and the place.
Error overlap_error(const CadBody& body, const Overlap& overlap, const std::string& source);

/// Looks for a vertex or a point on an edge of one solid that lies clearly inside of another one; the error names both
/// solids and the point. Not finding one proves nothing: faces may cross without it, and are left to the mesher.
std::optional<Error> find_overlap(const CadBody& body, const std::string& source);

}  // namespace curvetet
