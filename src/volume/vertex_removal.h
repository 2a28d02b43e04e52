// Merging an interior vertex into a neighbour, where that makes better tets.
#pragma once

#include <vector>

#include "spatial/tetrahedralization.h"
#include "volume/shape.h"

namespace curvetet {

class VertexRemoval {
 public:
  explicit VertexRemoval(Tetrahedralization& mesh) : mesh_(mesh), complex_(mesh.complex()) {}

  /// Takes the vertex out and joins a neighbour to all that it leaves: the neighbour whose worst tet is best. Done only
  /// if that tet is better than `at_least` (a least sine), all new tets are exactly positive and no edge becomes much
  /// longer than those that are there. Before: the vertex is inside a solid, on no locked facet and no kept segment.
  /// After: true, and the vertex is in the store but not in the mesh; or false, and nothing has changed. O(n^2) in the
  /// tets around it.
  bool remove(VertexId v, double at_least);
  /// The vertices around the one that was removed last.
  const std::vector<VertexId>& around() const { return link_; }

 private:
  bool collect_star(VertexId v);
  double worst_from(VertexId apex, double at_least) const;
  void commit(VertexId v, VertexId apex);

  Tetrahedralization& mesh_;
  TetComplex& complex_;
  std::vector<TetId> star_;
  std::vector<std::array<VertexId, 3>> facets_;  ///< opposite the vertex, which they see as the positive side
  std::vector<VertexId> link_;
  double longest_ = 0;  ///< squared, of the edges that are there
};

}  // namespace curvetet
