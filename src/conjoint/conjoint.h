// One vertex into all the triangulations it belongs to, or into none (the paper's section 3.1 and 3.4: "insertion of a
// new vertex both into t_ps and into the tetrahedralization").
//
// Before: every vertex of the surface meshes is in the tetrahedralization (if one is attached). After: the same; a
// refused insertion has changed nothing but the append-only vertex store.
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "conjoint/surface_meshes.h"
#include "geometry/model.h"
#include "mesh/vertex_store.h"
#include "spatial/tetrahedralization.h"

namespace curvetet {

enum class ConjointRefusal : std::uint8_t {
  none,
  outside_domain,  ///< the point leaves the face's domain, or lies on its boundary
  curved_segment,  ///< the region between a chord and its arc would hold a node, or the arc leaves the face
  coincident,      ///< a vertex is already at this place in space
  locked_cavity,   ///< the tetrahedralization has no legal cavity (locks, kept segments)
  folded,          ///< a triangle would turn its back on the surface
  too_small,       ///< the segment or triangle is at the floor of spacing
  no_segment,      ///< the segment is not part of the curve mesh (any more)
};
const char* name(ConjointRefusal refusal);

struct ConjointResult {
  ConjointRefusal refusal = ConjointRefusal::none;
  VertexId vertex;
  bool ok() const { return refusal == ConjointRefusal::none; }
};

/// Unordered pair of vertices as one key.
inline std::uint64_t edge_key(VertexId a, VertexId b) {
  const std::uint64_t low = a < b ? a.value() : b.value(), high = a < b ? b.value() : a.value();
  return (low << 32U) | high;
}

class Conjoint {
 public:
  using Criterion = std::function<FaceMesh::FlipWanted(FaceId)>;

  /// All references must outlive this object. The criterion decides the flips of each face mesh.
  Conjoint(const Model& model, VertexStore& vertices, BoundaryMesh& boundary, const Criterion& criterion);

  /// From now on insertions go into the tetrahedralization too; null detaches.
  void attach(Tetrahedralization* tets) { tets_ = tets; }
  Tetrahedralization* tets() const { return tets_; }

  /// A vertex on a face at chart point q, which lies in `triangle`.
  ConjointResult insert_on_face(FaceId face, Vec2 q, TriangleId triangle, Origin origin);
  /// Splits the segment of a curve that joins a and b at its middle parameter.
  ConjointResult split_segment(EdgeId edge, VertexId a, VertexId b, Origin origin);

  /// The CAD edge whose curve mesh has the segment ab; invalid if none.
  EdgeId segment_edge(VertexId a, VertexId b) const;
  /// All segments, in the order of edges and parameters.
  struct Segment {
    EdgeId edge;
    VertexId a, b;
  };
  std::vector<Segment> segments() const;
  /// The CAD faces a vertex lies on, ascending.
  const std::vector<FaceId>& faces_of(VertexId v) const;
  /// Triangles of the face mesh that the last successful insertion touched, by face.
  const std::vector<std::pair<FaceId, std::vector<TriangleId>>>& touched() const { return touched_; }

  const Model& model() const { return *model_; }
  VertexStore& vertices() { return *vertices_; }
  const VertexStore& vertices() const { return *vertices_; }
  BoundaryMesh& boundary() { return *boundary_; }
  const BoundaryMesh& boundary() const { return *boundary_; }
  const FaceMesh::FlipWanted& criterion(FaceId face) const { return criteria_[face]; }

 private:
  struct Use {
    FaceId face;
    std::int32_t number;
    const ParameterCurve* curve;
  };
  std::vector<FaceEdge> chart_edges(const Use& use, VertexId a, VertexId b) const;
  ConjointRefusal judge_uses(EdgeId edge, VertexId a, VertexId b, double t) const;
  void split_uses(EdgeId edge, VertexId a, VertexId b, VertexId middle, double t);

  const Model* model_;
  VertexStore* vertices_;
  BoundaryMesh* boundary_;
  Tetrahedralization* tets_ = nullptr;
  IndexedVector<FaceId, FaceMesh::FlipWanted> criteria_;
  IndexedVector<EdgeId, std::vector<Use>> uses_;
  IndexedVector<CadVertexId, std::vector<FaceId>> faces_at_vertex_;
  IndexedVector<FaceId, std::vector<FaceId>> self_;  // {face}, so that faces_of can return a reference
  std::vector<FaceId> none_;
  std::unordered_map<std::uint64_t, EdgeId> segment_edge_;  // looked up, never iterated
  std::vector<std::pair<FaceId, std::vector<TriangleId>>> touched_;
};

}  // namespace curvetet
