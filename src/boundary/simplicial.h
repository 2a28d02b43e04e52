// t_3d over vertex ids: is it a simplicial complex, within each face and over all, and what to do where it is not.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "conjoint/conjoint.h"
#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"

namespace curvetet {

/// A place where the triangles in space are not those of a surface over vertex ids (the paper's Fig. 12).
struct Offence {
  enum class Kind : std::uint8_t {
    self_edge,           ///< an edge from a vertex to itself that is not at a pole
    duplicate_triangle,  ///< two triangles over the same three vertices
    edge_count,          ///< an edge with more or fewer triangles than its face or its curve declares
  };
  Kind kind = Kind::edge_count;
  FaceId face;
  TriangleId triangle;
  int local = 0;     ///< the edge, for self_edge and edge_count
  VertexId a, b, c;  ///< c only for duplicate_triangle
  std::size_t found = 0, expected = 0;
};

/// All offences, in the order of faces and triangles. Curves on a face without a mesh are not counted.
std::vector<Offence> find_offences(const Model& model, const BoundaryMesh& mesh);
std::string describe(const Offence& offence, const Model& model);

/// Inserts points at offending interior edges and triangles, else splits their segments, until there is no offence or
/// no progress within ten rounds. Returns what is left.
std::vector<Offence> make_simplicial(Conjoint& conjoint, const Context& context);

}  // namespace curvetet
