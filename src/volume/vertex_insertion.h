// A vertex for a bad tet: a cavity grown by quality rather than by spheres.
#pragma once

#include <vector>

#include "mesh/vertex_store.h"
#include "spatial/tetrahedralization.h"
#include "volume/shape.h"

namespace curvetet {

class VertexInsertion {
 public:
  VertexInsertion(Tetrahedralization& mesh, VertexStore& vertices)
      : mesh_(mesh), complex_(mesh.complex()), vertices_(vertices) {}

  /// Inserts a vertex so that the tet is replaced by tets all better than `at_least` and better than the tet. False,
  /// and the mesh unchanged, if no such vertex is found.
  bool mend(TetId t, double at_least);

 private:
  struct Candidate {
    Vec3 place;
    std::size_t tets = 0;  ///< of the growing cavity, in the order they were added
    double worst = 0;
  };
  bool try_seed(Vec3 place, double at_least);
  bool seed_edge(TetId t, int i, int j);
  void collect_boundary(std::size_t tets);
  bool add_worst_neighbour(Vec3 place);
  bool keeps_everything() const;
  bool commit(const Candidate& best);
  bool in_cavity(TetId t, std::size_t tets) const;

  Tetrahedralization& mesh_;
  TetComplex& complex_;
  VertexStore& vertices_;
  std::vector<TetId> tets_, ring_;
  std::vector<TetFacet> boundary_;
  StarFacets facets_;
  StarOptimiser optimiser_;
  VertexId spare_;
};

}  // namespace curvetet
