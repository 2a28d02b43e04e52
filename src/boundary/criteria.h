// The geometric decisions of a face mesh on plain values: when to flip, where to put a new point. No mesh in here, so
// that refinement (which keeps corners in flat arrays) and recovery (which asks through a FaceMesh) decide alike.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/ids.h"
#include "base/vec.h"
#include "geometry/surface.h"
#include "planar/face_mesh.h"

namespace curvetet {

/// A corner of a triangle of t_3d: its vertex and chart point, and the surface there.
struct Corner {
  VertexId vertex;
  Vec2 q;
  Vec3 position;
  Vec3 normal;  ///< unit du x dv; zero where the derivatives collapse (at a pole the limit depends on the direction)
  Vec3 dx, dy;  ///< derivatives in the chart
};
Corner make_corner(const FaceNode& node, Vec3 position, const SurfaceFirst& at, const Chart& chart);

/// A surface over a chart, asked where the corners alone may mislead: on a sharp bend within a smooth face.
struct ChartSurface {
  const Surface& surface;
  const Chart& chart;
  bool has_tip = false;  ///< of the face mesh on it
};

/// Mean of du x dv over a chart triangle, not of unit length: each part of the surface counts by its area in space.
Vec3 mean_normal(const ChartSurface& on, Vec2 a, Vec2 b, Vec2 c);

/// True when two corners are the same vertex: the triangle is degenerate in space, though valid in the chart.
bool degenerate(const Corner& a, const Corner& b, const Corner& c);

/// Cosine of the angle between the triangle's normal and the mean of its corners' normals, or where these disagree, the
/// surface's mean normal; 1 where one of them is undefined.
double alignment(const Corner& a, const Corner& b, const Corner& c, const ChartSurface& on);
/// The triangle is far from parallel to the surface at a corner, and to the surface's mean normal.
bool folded(const Corner& a, const Corner& b, const Corner& c, const ChartSurface& on);

/// Cosine of the angle to the surface's normal, 84 degrees, from which a facet counts as folded.
inline constexpr double kFolded = 0.1;

/// Length of the surface's curve over the chart segment ab, estimated from below by the derivatives at its ends.
double arc_estimate(const Corner& a, const Corner& b);
/// The derivatives collapse at a corner.
bool at_pole(const Corner& a);
/// The chord of ab is no picture of its curve on the surface: by the derivatives at the ends, the curve wraps around,
/// or its middle is far from the chord's. What lies left of the one may then lie right of the other.
bool bent(const Corner& a, const Corner& b);
/// Bent, and the surface between the ends confirms it: at a crease or a jump of speed the derivatives at the ends say
/// nothing about what is between them.
bool confirmed_bent(const Corner& a, const Corner& b, const ChartSurface& on);

/// On a face that tapers to a pole, where elements are longer than it is thick: the surface turns so far from a to b
/// that the chord, however steep, runs through the middle of what the surface lies around.
bool turns_about(const Corner& a, const Corner& b, const ChartSurface& on);

/// Whether a curve whose middle is at `offset` from the middle of its chord is far from being its picture.
bool off_chord(Vec3 offset, Vec3 chord);

/// What comes first where a flip cures the one and brings the other. While triangles are large, an edge that wraps
/// around the surface makes everything next to it upright, and only edges that do not wrap lead out of that. Once they
/// have their size, an upright triangle crosses its neighbours or other faces, and an edge that is bent in the chart
/// does no harm: close to a pole, where the chart turns, there is none that is not. Before both, on a face that wraps
/// around, positions in space say nothing at all: triangles are judged on the surface, by the first fundamental form.
enum class FlipOrder : std::uint8_t { on_surface, bends_first, upright_first };

/// Whether triangles (a,b,c) and (b,a,d) should become (a,d,c) and (d,b,c). In order: fewer flat
/// triangles, no bent edge and fewer upright triangles (in this or the other order), fewer degenerate ones, fewer that
/// oppose the surface's normal, then Delaunay in space (angles at c and d exceed two right ones, with a margin). In the
/// order on_surface: Delaunay in the mean first fundamental form of the corners, and nothing else.
bool flip_improves(const Corner& a, const Corner& b, const Corner& c, const Corner& d, FlipOrder order,
                   const ChartSurface& on);

/// Radius of the smallest sphere through three points; infinite for collinear ones.
double circumradius(Vec3 a, Vec3 b, Vec3 c);

/// A point of a face, evaluated once.
struct FacePoint {
  Vec2 q;           ///< chart point, on the grid
  SurfaceFirst at;  ///< the surface there
};

/// The point of the surface at the same distance from three points of it, by Newton's method from the chart image of
/// their circumcentre. Equal to 1 % of the radius. Empty if the iteration leaves the neighbourhood of the triangle.
std::optional<FacePoint> ball_centre(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q,
                                     const std::array<Vec3, 3>& p);

/// Centre of the ellipse through three chart points in the metric of the surface at their centroid (the paper's
/// choice).
std::optional<Vec2> metric_centre(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q);

/// Cosine of the angle between a triangle's normal and the mean normal, by area, of the surface over its chart
/// triangle: not that at some point, which next to a crease says nothing of the whole. 1 where one of them vanishes.
double facing(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q, const std::array<Vec3, 3>& p);

/// Unit normal du x dv from an evaluation, or zero where the derivatives collapse.
Vec3 unit_normal(const SurfaceFirst& at);

}  // namespace curvetet
