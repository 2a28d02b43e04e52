// The cube around the body, so that no face of the body is a facet of the convex hull.
#pragma once

#include <vector>

#include "mesh/vertex_store.h"

namespace curvetet {

/// Adds the corners of the cube of all coordinates to the store and to the vertices of a body's tetrahedralization: the
/// hull of the body alone has the body's flat faces as facets that nothing lies beyond, and neither flips nor fillings
/// change how these are triangulated. Owned by no solid; only tets outside of the body have them.
void add_surrounding(VertexStore& store, std::vector<VertexId>& vertices);

}  // namespace curvetet
