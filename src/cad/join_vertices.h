// Vertices that the CAD's own tolerances cannot tell apart. Inside cad only.
#pragma once

#include <TopTools_IndexedMapOfShape.hxx>
#include <vector>

namespace curvetet {

/// Arrays by number in the maps, from 1.
struct JoinedVertices {
  std::vector<int> vertex;        ///< the vertex that stands for each one: itself, where nothing was joined
  std::vector<double> tolerance;  ///< of each vertex, the distance to those it stands for included
  std::vector<char> point;        ///< per edge: it is one point now, as its two ends are one vertex
};

/// Joins the two ends of each edge that is asked for (by number; none if empty), chains of them into one vertex: the
/// one that most edges meet in. Then joins the two ends of a degenerate edge, which is one point by definition, and
/// those of an edge that lies wholly within the tolerance of its ends. Last, vertices of one solid that are in one
/// place, where it touches itself. The vertex with the tightest tolerance stands for all, and lies within the own
/// tolerance of each. No two that are farther apart than a part of `diagonal` are joined unasked.
JoinedVertices join_vertices(const TopTools_IndexedMapOfShape& vertices, const TopTools_IndexedMapOfShape& edges,
                             const TopTools_IndexedMapOfShape& solids, double diagonal,
                             const std::vector<char>& asked = {});

}  // namespace curvetet
