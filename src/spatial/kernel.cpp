// A star is glued along the edges of the cavity's boundary. Its vertices are numbered as they come, and each new tet
// entered under its directed edges, in a square table or, where the numbers are too large for that, a hash table; the
// neighbour is under the reversed edge. The old tets are not looked at, so that stars of disjoint cavities can be made
// at the same time.
#include "spatial/kernel.h"

namespace curvetet::kernel {

TetId add_first_tet(TetComplex& complex, VertexId a, VertexId b, VertexId c, VertexId d) {
  const TetId t = complex.add({a, b, c, d});
  std::array<TetId, 4> ghost;
  for (int i = 0; i < 4; ++i) {
    const std::array<VertexId, 3> f = complex.facet_vertices({t, i});
    ghost[static_cast<std::size_t>(i)] = complex.add({f[1], f[0], f[2], kInfinite});
    complex.glue({t, i}, {ghost[static_cast<std::size_t>(i)], 3});
  }
  // Ghosts i and j share the edge without vertices i and j: in ghost i it is opposite vertex j.
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      const TetId gi = ghost[static_cast<std::size_t>(i)];
      const TetId gj = ghost[static_cast<std::size_t>(j)];
      complex.glue({gi, complex.local(gi, complex.vertex(t, j))}, {gj, complex.local(gj, complex.vertex(t, i))});
    }
  }
  return t;
}

void collect_walls(const TetComplex& complex, std::span<const TetFacet> boundary, std::vector<Wall>& walls) {
  walls.clear();
  for (const TetFacet& f : boundary) {
    const TetFacet outer = complex.mirror(f);
    const std::uint32_t lock = complex.is_locked(f) ? 1U << 3U : 0;
    walls.push_back({outer.tet, outer.local, complex.facet_vertices(f), complex.region(f.tet) << 8U | lock});
  }
}

void StarBuilder::replace(TetComplex& complex, VertexId v, std::span<const TetId> tets,
                          std::span<const TetFacet> boundary, std::vector<TetId>& star) {
  collect_walls(complex, boundary, walls_);
  star.assign(tets.begin(), tets.end());
  while (star.size() < walls_.size()) star.push_back(complex.add({}));
  vertex_numbers_.start();
  wall_numbers_.resize(walls_.size());
  for (std::size_t k = 0; k < walls_.size(); ++k)
    for (std::size_t j = 0; j < 3; ++j) wall_numbers_[k][j] = vertex_numbers_.number_of(walls_[k].vertices[j].value());
  fill(complex, v, walls_, star, wall_numbers_, vertex_numbers_.count());
  for (std::size_t k = walls_.size(); k < star.size(); ++k) complex.remove(star[k]);
  star.resize(walls_.size());
}

}  // namespace curvetet::kernel
