// The march of the paper's second stage (section 3.2): from the triangles of t_3d that are facets already, over the
// facets of the tetrahedralization, to a set T_Γ that satisfies requirements I-VI, under conditions 1-4.
#pragma once

#include <array>
#include <vector>

#include "boundary/surface_triangles.h"
#include "conjoint/conjoint.h"

namespace curvetet {

using NodeTriple = std::array<NodeId, 3>;

/// An edge through which no neighbour was found; `apex` is the third node of the marked triangle.
struct StuckEdge {
  NodeId a, b, apex;
};

struct MarchResult {
  bool complete = false;  ///< T_Γ found, requirements I-VI hold
  std::size_t seeds = 0;  ///< triangles of t_ps that are facets
  std::size_t total = 0;  ///< triangles of t_ps with three different vertices
  /// Of the face, over nodes: T_Γ if complete, else t_ps with the holes that closed replaced. Empty if nothing was
  /// missing.
  std::vector<NodeTriple> triangles;
  std::vector<TriangleId> missing;  ///< triangles of t_ps that are no facets (before anything is replaced)
  std::vector<StuckEdge> stuck;
};

/// Marches over one face. Facets locked for other faces are no candidates. Reads only.
/// Each step marks one more facet, so the march ends; O(facets of the face times the size of their rings).
MarchResult march_face(const Conjoint& conjoint, FaceId face);

}  // namespace curvetet
