// Exact geometric predicates on grid points (geometry/frame.h): signs only, by a ladder of filter,
// doubles that were not rounded, fixed width; and the perturbed family, which is never zero.
//
// orient3d(a,b,c,d) is the sign of det[b-a, c-a, d-a]: (0,0,0), (1,0,0), (0,1,0), (0,0,1) is positive.
//   1. An even permutation of the arguments keeps the sign, an odd one negates it.
//   2. Zero exactly when the four points are coplanar.
// insphere(a,b,c,d,e) for orient3d(a,b,c,d) > 0: positive exactly when e lies strictly inside the sphere through
// a,b,c,d; an odd permutation of the first four negates it; zero exactly when the five are cospherical (or coplanar).
// REQUIRED for all: every coordinate is a multiple of 2^-42 with absolute value at most 1.
#pragma once

#include <array>
#include <cstdint>

#include "base/ids.h"
#include "base/vec.h"

namespace curvetet {

/// Sign of det[b-a, c-a, d-a]: -1, 0, +1. Exact.
int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
/// Exact; see the theorem above.
int insphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);
/// As insphere of five points a..e, ties broken by vertex id (symbolic perturbation of the lifted height by id); never
/// zero unless the four points a..d are coplanar. The result is that of infinitesimally perturbed points: consistent
/// over all calls.
int insphere_perturbed(const std::array<Vec3, 5>& points, const std::array<VertexId, 5>& ids);

/// Points of a face mesh's chart (planar/chart): every coordinate a multiple of 2^-42, absolute value at most 1.
/// Sign of cross(b-a, c-a): +1 when a,b,c turn left. Exact.
int orient2d(Vec2 a, Vec2 b, Vec2 c);
/// Positive exactly when d lies strictly inside the circle through a,b,c (which turn left). Exact.
int incircle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);
/// Sign of orientation of three points in space after dropping coordinate `axis` (0,1,2). Exact.
int orient2d_dropped(Vec3 a, Vec3 b, Vec3 c, int axis);
/// True when the three points are exactly collinear.
bool collinear(Vec3 a, Vec3 b, Vec3 c);

/// True if the open segments pq and ab meet in one point. Exact.
bool segments_cross(Vec3 p, Vec3 q, Vec3 a, Vec3 b);

/// How a closed triangle abc and a closed segment pq meet, exactly.
enum class SegmentTriangle { disjoint, touches, crosses };
/// `crosses`: the segment's interior passes through the triangle's interior, from one side to the other; `touches`: any
/// other common point, also of a segment in the triangle's plane. A degenerate triangle is only ever touched.
SegmentTriangle segment_triangle(Vec3 p, Vec3 q, Vec3 a, Vec3 b, Vec3 c);

/// Counts of decisions per rung on this thread, for tests and benchmarks.
struct PredicateCounts {
  std::uint64_t filter = 0, extended = 0, exact = 0;
};
PredicateCounts& predicate_counts();

/// Each rung by itself, for the tests: 2 means "cannot decide".
namespace rungs {
int orient3d_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
int orient3d_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
int insphere_filter(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);
int insphere_extended(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);
int insphere_exact(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e);
}  // namespace rungs

}  // namespace curvetet
