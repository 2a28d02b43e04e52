// A tet with its four vertices on one CAD face is as flat as the face's curvature makes it, on whichever side of the
// face it happens to lie. Its two locked facets and the other two are equally good for the face: locking the others
// moves the flat tet across. Outside of the solids it is then gone; in a neighbouring solid it is no better, but there
// the old diagonal is free to be removed. If it cannot be, the exchange is taken back.
#include "volume/relock.h"

#include <algorithm>
#include <array>
#include <vector>

#include "spatial/flips.h"
#include "volume/shape.h"

namespace curvetet {

namespace {

/// The locked facets i, j and the others k, l of a tet.
struct Quad {
  int i = -1, j = -1, k = -1, l = -1;
  FaceId face;
  std::uint32_t behind = 0;  ///< region
};

std::optional<Quad> quad_of(const TetComplex& complex, TetId t) {
  Quad q;
  for (int f = 0; f < 4; ++f) {
    int& slot = complex.is_locked({t, f}) ? (q.i < 0 ? q.i : q.j) : (q.k < 0 ? q.k : q.l);
    if (slot >= 0) return std::nullopt;
    slot = f;
  }
  if (q.j < 0 || q.l < 0) return std::nullopt;
  q.face = complex.locked_face({t, q.i});
  if (complex.locked_face({t, q.j}) != q.face) return std::nullopt;
  q.behind = complex.region(complex.neighbour(t, q.i));
  if (complex.region(complex.neighbour(t, q.j)) != q.behind) return std::nullopt;
  return q;
}

Vec3 normal_into(const Tetrahedralization& mesh, TetFacet f) {
  const auto v = mesh.complex().facet_vertices(f);
  const Vec3 a = mesh.position(v[0]);
  return cross(mesh.position(v[1]) - a, mesh.position(v[2]) - a);
}

/// Facets i and j look into the tet, k and l after the exchange out of it.
bool looks_the_same_way(const Tetrahedralization& mesh, TetId t, const Quad& q) {
  const Vec3 old_normal = normal_into(mesh, {t, q.i}) + normal_into(mesh, {t, q.j});
  return dot(old_normal, normal_into(mesh, {t, q.k})) < 0 && dot(old_normal, normal_into(mesh, {t, q.l})) < 0;
}

bool is_on_locked_facet(const Tetrahedralization& mesh, TetId t, int i, int j) {
  const TetComplex& complex = mesh.complex();
  std::vector<TetId> ring;
  mesh.ring({t, i, j}, ring);
  const VertexId p = complex.vertex(t, i), q = complex.vertex(t, j);
  for (TetId r : ring) {
    for (int f = 0; f < 4; ++f) {
      const VertexId v = complex.vertex(r, f);
      if (v != p && v != q && complex.is_locked({r, f})) return true;
    }
  }
  return false;
}

void swap_locks(TetComplex& complex, TetId t, const Quad& q, std::uint32_t region) {
  complex.unlock({t, q.i});
  complex.unlock({t, q.j});
  complex.lock({t, q.k}, q.face);
  complex.lock({t, q.l}, q.face);
  complex.set_region(t, region);
}

}  // namespace

bool exchange_lock(Tetrahedralization& mesh, TetId t, const FacetAllowed& facet_allowed) {
  TetComplex& complex = mesh.complex();
  const auto q = quad_of(complex, t);
  if (!q || mesh.is_kept(complex.vertex(t, q->k), complex.vertex(t, q->l))) return false;
  if (!looks_the_same_way(mesh, t, *q) || is_on_locked_facet(mesh, t, q->i, q->j)) return false;
  for (int f : {q->k, q->l}) {
    const auto v = complex.facet_vertices({t, f});
    if (!facet_allowed(v[0], v[1], v[2], q->face)) return false;
  }
  const std::uint32_t region = complex.region(t);
  const auto v = complex.vertices(t);
  const auto corner = [&](int i) { return mesh.position(v[static_cast<std::size_t>(i)]); };
  const double shape = least_sine(corner(0), corner(1), corner(2), corner(3));
  swap_locks(complex, t, *q, q->behind);
  if (q->behind == 0 || remove_edge(mesh, {t, q->k, q->l}, least_sine, shape)) return true;
  swap_locks(complex, t, {q->k, q->l, q->i, q->j, q->face, region}, region);
  return false;
}

}  // namespace curvetet
