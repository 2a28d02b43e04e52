// Validity of a tetrahedralization, judged by the definition and slowly; and point sets for the tests of flips.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "geometry/frame.h"
#include "predicates/predicates.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::test {

/// A facet by its sorted vertices.
using FacetVertices = std::array<VertexId, 3>;

inline FacetVertices sorted_facet(const TetComplex& complex, TetFacet f) {
  FacetVertices v = complex.facet_vertices(f);
  std::sort(v.begin(), v.end());
  return v;
}

inline std::string describe(TetFacet f) {
  return "tet " + std::to_string(f.tet.value()) + " facet " + std::to_string(f.local);
}

/// What is wrong; empty if nothing: links reciprocal, finite tets positive, no facet in three tets, locks on both
/// sides, regions change only across locks where there are regions, tet_of right.
inline std::string defects(const Tetrahedralization& mesh) {
  const TetComplex& complex = mesh.complex();
  std::map<FacetVertices, int> uses;
  std::size_t locked_sides = 0;
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    const TetId t(k);
    if (!complex.is_alive(t)) continue;
    const auto v = complex.vertices(t);
    if (!complex.is_ghost(t) &&
        orient3d(mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2]), mesh.position(v[3])) <= 0) {
      return "not positive: tet " + std::to_string(k);
    }
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{t, i};
      if (++uses[sorted_facet(complex, f)] > 2) return "facet in three tets: " + describe(f);
      const TetId n = complex.neighbour(t, i);
      if (!n.valid() || !complex.is_alive(n)) return "no neighbour: " + describe(f);
      const TetFacet m = complex.mirror(f);
      if (m.tet != n || complex.neighbour(n, m.local) != t) return "link not reciprocal: " + describe(f);
      if (sorted_facet(complex, f) != sorted_facet(complex, m)) return "neighbours share no facet: " + describe(f);
      if (complex.is_locked(f) != complex.is_locked(m)) return "lock on one side: " + describe(f);
      if (complex.is_locked(f) != complex.locked_face(f).valid()) return "lock bit without face: " + describe(f);
      locked_sides += complex.is_locked(f);
      if (!complex.is_locked(f) && complex.region(t) != complex.region(n)) return "region leaks: " + describe(f);
      const VertexId w = complex.vertex(t, i);
      if (w == kInfinite) continue;
      if (!mesh.contains(w) || !complex.is_alive(mesh.tet_of(w)) || complex.local(mesh.tet_of(w), w) < 0) {
        return "tet_of wrong: vertex " + std::to_string(w.value());
      }
    }
  }
  if (locked_sides != 2 * complex.locked_count()) return "a locked facet is gone";
  return {};
}

/// Locked facets with their faces, sorted.
inline std::vector<std::pair<FacetVertices, FaceId>> locked_facets(const TetComplex& complex) {
  std::vector<std::pair<FacetVertices, FaceId>> result;
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    if (!complex.is_alive(TetId(k))) continue;
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{TetId(k), i};
      if (complex.is_locked(f)) result.emplace_back(sorted_facet(complex, f), complex.locked_face(f));
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Six times the volume of all finite tets.
inline double sixfold_volume(const Tetrahedralization& mesh) {
  double sum = 0;
  const TetComplex& complex = mesh.complex();
  for (std::size_t k = 0; k < complex.slots(); ++k) {
    if (!complex.is_alive(TetId(k)) || complex.is_ghost(TetId(k))) continue;
    const auto v = complex.vertices(TetId(k));
    const Vec3 a = mesh.position(v[0]);
    sum += dot(cross(mesh.position(v[1]) - a, mesh.position(v[2]) - a), mesh.position(v[3]) - a);
  }
  return sum;
}

/// Random grid points in a cube; with `layers` on few planes, so that many are coplanar.
inline VertexStore random_points(std::size_t n, std::uint64_t seed, int layers = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-0.4, 0.4);
  VertexStore store;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3 p{unit(random), unit(random), unit(random)};
    if (layers > 0) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * layers) / layers;
    }
    p = snap(p);
    bool again = false;
    for (std::size_t k = 0; k < store.size(); ++k) again = again || store.position(VertexId(k)) == p;
    if (!again) store.add(p, Owner{}, {}, Origin::interior);
  }
  return store;
}

inline std::vector<VertexId> all_ids(const VertexStore& store) {
  std::vector<VertexId> ids;
  for (std::size_t i = 0; i < store.size(); ++i) ids.push_back(VertexId(i));
  return ids;
}

/// Points and their Delaunay tetrahedralization.
struct Cloud {
  VertexStore store;
  Tetrahedralization mesh;
  explicit Cloud(VertexStore points) : store(std::move(points)), mesh(store, 7) {
    Context context;
    EXPECT_TRUE(mesh.build(all_ids(store), context).ok());
  }
};

}  // namespace curvetet::test
