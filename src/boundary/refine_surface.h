// One refinement of the surface meshes and, once attached, of the tetrahedralization: the ladder of points to try.
#pragma once

#include <functional>
#include <optional>

#include "boundary/surface_triangles.h"
#include "conjoint/conjoint.h"

namespace curvetet {

struct SurfaceRefinement {
  double floor = 0;  ///< never refine below this spacing (working units)
  Origin origin = Origin::stage_two;
  std::function<bool(EdgeId)> may_split;     ///< curves that may be split where a point would encroach them; empty: all
  std::function<void(EdgeId)> before_split;  ///< called before a curve is split (to unlock the faces on it)
};

/// Refines at a triangle of a face mesh: centre of the surface Delaunay ball, centre of the circumscribed ellipse,
/// centroid, middle of the longest edge, split of a curve; the first that no triangulation refuses. A point inside the
/// diametral sphere of a segment of the triangle it falls into splits that segment instead (Ruppert).
ConjointResult refine_triangle(Conjoint& conjoint, FaceId face, TriangleId triangle, const SurfaceRefinement& options);

/// Splits the segment ab of a curve, unless it is at the floor already.
ConjointResult refine_segment(Conjoint& conjoint, EdgeId edge, VertexId a, VertexId b,
                              const SurfaceRefinement& options);

double longest_edge(const VertexStore& vertices, const std::array<VertexId, 3>& triangle);

/// Distance from the centroid of a triangle of t_3d to the point of the surface at the same place of the chart: how far
/// the facet is from its face.
double deviation(const Conjoint& conjoint, FaceId face, TriangleId triangle);
/// As facing in boundary/criteria.h, of a triangle of t_3d. A fold has it at or below zero.
double facing(const Conjoint& conjoint, FaceId face, TriangleId triangle);
struct SurfaceFoot {
  Vec2 uv;  ///< within the box of the face's domain
  double distance = 0;
};
/// Where the face is nearest to a triangle's centroid, searched from the same place of the chart and from the corners;
/// empty if no such place is found.
std::optional<SurfaceFoot> foot_of(const Conjoint& conjoint, FaceId face, const std::array<NodeId, 3>& nodes);
/// Cosine of the angle between a triangle's normal and the surface's at its foot; 1 without a foot.
double facing_at_foot(const Conjoint& conjoint, FaceId face, const std::array<NodeId, 3>& nodes);
/// The triangles of t_3d that look away from their face where it is closest to them, as the final check sees it. Time:
/// three normals for each triangle, and feet for those that lean away from their face at a corner.
std::vector<SurfaceTriangle> facets_turned_away(const Conjoint& conjoint);
/// The surface below the middle of a triangle in the chart: its place, and the radius that it is bent by there,
/// infinite where it is flat.
struct Bend {
  Vec3 where;
  double radius = 0;
};
Bend bend_below(const FaceMesh& mesh, TriangleId triangle, const Surface& surface);
/// Distance from the middle of a segment to the curve at the middle parameter.
double segment_deviation(const Conjoint& conjoint, EdgeId edge, VertexId a, VertexId b);

}  // namespace curvetet
