// Decisions in space for triangulations in the plane. The tetrahedralization that follows is Delaunay in space, so t_ps
// is made to agree with it: flips by angles in space, new points at centres of surface Delaunay balls. The anisotropic
// incircle test of the literature (one metric per test, interpolated in the plane) was rejected: it answers a different
// question where the metric varies within a triangle, that is near poles and on coarse meshes of strongly curved faces.

#include "boundary/criteria.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "boundary/boundary_mesh.h"

namespace curvetet {

namespace {

/// Sum of cotangents below which an edge is not Delaunay; away from zero, so that cocircular corners never flip back
/// and forth.
constexpr double kFlipMargin = 1e-6;
/// Height over length below which a triangle is flat.
constexpr double kFlat = 1e-6;
/// Largest number of Newton steps; from a good start two are enough, a bad start never converges.
constexpr int kNewtonSteps = 8;
/// Distances to the three corners agree to this share of the radius.
constexpr double kBallTolerance = 0.01;

/// Arc over chord from which an edge wraps around: that of half a circle.
constexpr double kWrap = std::numbers::pi / 2;
/// Distance of an arc's middle from the chord over the chord: on a circle the angle over eight, here of 80 degrees.
constexpr double kBend = 0.175;
/// Component of a pole's edge around the pole over its length: an angle of about 55 degrees around the pole.
constexpr double kSlant = 1;
/// Cosine of the angle to the surface's normal below which a triangle stands upright: 60 degrees.
constexpr double kUpright = 0.5;
/// Cosine of the largest angle of a triangle to the surface at its corners.
constexpr double kAligned = 0.7071;
/// Cosine of the angle between normals at corners from which they disagree.
constexpr double kAgree = 0.7071;
/// Cosine of the angle between the normals at an edge's ends, 130 degrees: three elements around have 120.
constexpr double kTurnsAbout = -0.643;
/// Working length below which an arc is a point.
constexpr double kNoLength = 1e-9;

double cotangent(Vec3 apex, Vec3 a, Vec3 b) {
  const Vec3 x = a - apex, y = b - apex;
  const double sine = norm(cross(x, y));
  const double cosine = dot(x, y);
  if (sine > 0) return cosine / sine;
  return cosine < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

/// Normals at the corners that disagree: there is a bend within the triangle, which need not be where a corner is.
bool disagree(Vec3 a, Vec3 b, Vec3 c) {
  return std::min({dot(a, b), dot(b, c), dot(c, a)}) < kAgree && norm2(a) > 0 && norm2(b) > 0 && norm2(c) > 0;
}

/// The surface's normal over a triangle, of any length: by its corners or, where these disagree, by its mean.
Vec3 surface_normal(const Corner& a, const Corner& b, const Corner& c, const ChartSurface& on) {
  return disagree(a.normal, b.normal, c.normal) ? mean_normal(on, a.q, b.q, c.q) : a.normal + b.normal + c.normal;
}

/// Of the angle between two vectors; 1 where one vanishes.
double cosine(Vec3 a, Vec3 b) {
  const double lengths = norm(a) * norm(b);
  return lengths > 0 ? dot(a, b) / lengths : 1;
}

/// Whether a length, given squared, exceeds a multiple of a vector's; the root only where it is not clear without.
bool longer(double length2, double factor, Vec3 v) {
  if (length2 <= factor * factor * norm2(v)) return false;
  return std::sqrt(length2) > factor * norm(v) + kNoLength;
}

/// Radon's rule of degree five on a triangle: barycentric points and weights.
struct RulePoint {
  double a, b, c, weight;
};
const std::array<RulePoint, 7> kRadon = [] {
  const double root = std::sqrt(15.0), near = (6 - root) / 21, far = (6 + root) / 21;
  const double light = (155 - root) / 1200, heavy = (155 + root) / 1200;
  return std::array<RulePoint, 7>{{{1.0 / 3, 1.0 / 3, 1.0 / 3, 9.0 / 40},
                                   {1 - 2 * near, near, near, light},
                                   {near, 1 - 2 * near, near, light},
                                   {near, near, 1 - 2 * near, light},
                                   {1 - 2 * far, far, far, heavy},
                                   {far, 1 - 2 * far, far, heavy},
                                   {far, far, 1 - 2 * far, heavy}}};
}();

/// A triangle that a flip is judged by.
struct Facet {
  const Corner &a, &b, &c;
  bool degenerate = false;
  Vec3 normal;  ///< of twice its area's length
};

Facet facet(const Corner& a, const Corner& b, const Corner& c) {
  return {a, b, c, degenerate(a, b, c), cross(b.position - a.position, c.position - a.position)};
}

/// So flat, in space or in the chart, that its angles are rounding errors: the middle of a chart edge, rounded to the
/// grid, is not on the edge.
bool flat(const Facet& f) {
  if (f.degenerate) return false;
  const Vec3 u = f.b.position - f.a.position, v = f.c.position - f.a.position;
  const double longest = std::max({norm2(u), norm2(v), norm2(v - u)});
  if (norm2(f.normal) <= kFlat * kFlat * longest * longest) return true;
  const Vec2 r = f.b.q - f.a.q, s = f.c.q - f.a.q;
  return std::abs(cross(r, s)) <= kFlat * std::max({norm2(r), norm2(s), norm2(s - r)});
}

/// Not parallel to a normal, up to sixty degrees.
bool upright(Vec3 facet_normal, Vec3 normal) {
  const double along = dot(facet_normal, normal), lengths2 = norm2(facet_normal) * norm2(normal);
  return (along < 0 || along * along < kUpright * kUpright * lengths2) && lengths2 > 0;
}

bool inside_chart(Vec2 q) { return std::abs(q.x) <= 1 && std::abs(q.y) <= 1; }

Vec2 centroid(const std::array<Vec2, 3>& q) { return (1.0 / 3) * (q[0] + q[1] + q[2]); }

double diameter(const std::array<Vec2, 3>& q) {
  return std::max({distance(q[0], q[1]), distance(q[1], q[2]), distance(q[2], q[0])});
}

/// Solves the 2 by 2 system with rows r0, r1; empty when it is singular beyond use.
std::optional<Vec2> solve(Vec2 r0, Vec2 r1, double b0, double b1) {
  const double determinant = cross(r0, r1);
  if (std::abs(determinant) <= 1e-12 * norm(r0) * norm(r1)) return std::nullopt;
  return Vec2{(b0 * r1.y - b1 * r0.y) / determinant, (r0.x * b1 - r1.x * b0) / determinant};
}

/// Chart image of the circumcentre under the affine map that takes the chart triangle to the one in space.
std::optional<Vec2> affine_centre(const std::array<Vec2, 3>& q, const std::array<Vec3, 3>& p) {
  const double a2 = norm2(p[2] - p[1]), b2 = norm2(p[0] - p[2]), c2 = norm2(p[1] - p[0]);
  const double wa = a2 * (b2 + c2 - a2), wb = b2 * (c2 + a2 - b2), wc = c2 * (a2 + b2 - c2);
  const double sum = wa + wb + wc;
  if (!(sum > 1e-12 * (a2 + b2 + c2) * (a2 + b2 + c2))) return std::nullopt;
  return (wa / sum) * q[0] + (wb / sum) * q[1] + (wc / sum) * q[2];
}

/// Of two triangles of which one is degenerate before and after: whether its apex comes closer to the middle of its
/// edge along the pole, so that edges to the pole leave it in their own direction.
bool apex_improves(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  const auto offset = [](const Corner& p, const Corner& r, const Corner& apex) {
    return std::abs(dot(apex.q - 0.5 * (p.q + r.q), r.q - p.q));
  };
  const auto closer = [&](const Corner& p, const Corner& r, const Corner& now, const Corner& then) {
    return offset(p, r, then) < (1 - kFlipMargin) * offset(p, r, now);
  };
  if (a.vertex == c.vertex) return closer(a, c, b, d);
  if (b.vertex == c.vertex) return closer(b, c, a, d);
  if (a.vertex == d.vertex) return closer(a, d, b, c);
  if (b.vertex == d.vertex) return closer(b, d, a, c);
  return false;
}

/// As bent, for edges around a pole, where the chart turns: a chart edge goes around it in an arc while the chord does
/// not, and with few nodes around the pole none is straight. So what the middle is off along the surface does not
/// count.
bool bent_beside_pole(const Corner& a, const Corner& b, const ChartSurface& on) {
  if (at_pole(a) || at_pole(b)) return bent(a, b);
  if (turns_about(a, b, on)) return true;
  const Vec3 chord = b.position - a.position;
  if (arc_estimate(a, b) > kWrap * norm(chord) + kNoLength) return true;
  const Vec3 middle = on.surface.value(on.chart.to_uv(0.5 * (a.q + b.q)));
  const Vec3 normal = normalized(a.normal + b.normal);
  return off_chord(dot(middle - a.position - 0.5 * chord, normal) * normal, chord);
}

}  // namespace

bool degenerate(const Corner& a, const Corner& b, const Corner& c) {
  return a.vertex == b.vertex || b.vertex == c.vertex || c.vertex == a.vertex;
}

Vec3 mean_normal(const ChartSurface& on, Vec2 a, Vec2 b, Vec2 c) {
  Vec3 mean{};
  for (const RulePoint& at : kRadon) {
    const SurfaceFirst s = on.surface.first(on.chart.to_uv(at.a * a + at.b * b + at.c * c));
    mean = mean + at.weight * cross(s.du, s.dv);
  }
  return mean;
}

bool folded(const Corner& a, const Corner& b, const Corner& c, const ChartSurface& on) {
  const Vec3 normal = normalized(cross(b.position - a.position, c.position - a.position));
  const auto off = [&](const Corner& k) { return norm2(k.normal) > 0 && dot(normal, k.normal) < kAligned; };
  if (!off(a) && !off(b) && !off(c)) return false;
  if (!disagree(a.normal, b.normal, c.normal)) return true;
  const Vec3 mean = mean_normal(on, a.q, b.q, c.q);
  return dot(normal, mean) < kAligned * norm(mean);
}

double alignment(const Corner& a, const Corner& b, const Corner& c, const ChartSurface& on) {
  const Vec3 normal = cross(b.position - a.position, c.position - a.position);
  return cosine(normal, surface_normal(a, b, c, on));
}

Corner make_corner(const FaceNode& node, Vec3 position, const SurfaceFirst& at, const Chart& chart) {
  return {node.vertex, node.q, position, unit_normal(at), (1 / chart.scale_u) * at.du, (1 / chart.scale_v) * at.dv};
}

double arc_estimate(const Corner& a, const Corner& b) {
  const Vec2 d = b.q - a.q;
  return std::min(norm(d.x * a.dx + d.y * a.dy), norm(d.x * b.dx + d.y * b.dy));
}

bool at_pole(const Corner& a) { return norm2(a.normal) == 0; }

bool turns_about(const Corner& a, const Corner& b, const ChartSurface& on) {
  return on.has_tip && dot(a.normal, b.normal) < kTurnsAbout;
}

bool bent(const Corner& a, const Corner& b) {
  const Vec3 chord = b.position - a.position;
  const Vec2 d = b.q - a.q;
  const Vec3 from_a = d.x * a.dx + d.y * a.dy, from_b = d.x * b.dx + d.y * b.dy;
  if (longer(std::min(norm2(from_a), norm2(from_b)), kWrap, chord)) return true;
  if (at_pole(a) || at_pole(b)) {
    // There the derivative says nothing; an edge that leaves the other end askew circles around the pole.
    if (at_pole(a) && at_pole(b)) return false;
    return longer(norm2((at_pole(a) ? from_b : from_a) - chord), kSlant, chord);
  }
  // Where the middle of Hermite's cubic is, seen from the chord's.
  return off_chord(0.125 * (from_a - from_b), chord);
}

bool confirmed_bent(const Corner& a, const Corner& b, const ChartSurface& on) {
  if (turns_about(a, b, on)) return true;
  if (!bent(a, b)) return false;
  if (at_pole(a) || at_pole(b)) return true;
  const Vec3 chord = b.position - a.position;
  const auto off = [&](double share) {
    const Vec2 q = a.q + share * (b.q - a.q);
    return off_chord(on.surface.value(on.chart.to_uv(q)) - (a.position + share * chord), chord);
  };
  return off(0.5) || off(0.25) || off(0.75);
}

bool off_chord(Vec3 offset, Vec3 chord) {
  static_assert(kBend < 0.5, "what is nearer to the chord's middle is off in neither way");
  if (norm2(offset) <= kBend * kBend * norm2(chord)) return false;
  const double length = norm(chord);
  if (norm(cross(offset, chord)) > kBend * length * length + kNoLength * length) return true;
  // Along the chord only speed is told, unless the middle lies beyond an end.
  return std::abs(dot(offset, chord)) > 0.5 * length * length + kNoLength * length;
}

namespace {

/// The two triangles before or after a flip.
struct FacetPair {
  Facet first, second;
};

int count_flat(const FacetPair& pair) { return (flat(pair.first) ? 1 : 0) + (flat(pair.second) ? 1 : 0); }

int count_degenerate(const FacetPair& pair) {
  return (pair.first.degenerate ? 1 : 0) + (pair.second.degenerate ? 1 : 0);
}

int count_upright(const FacetPair& pair, const ChartSurface& on) {
  const auto stands = [&on](const Facet& f) {
    return !f.degenerate && upright(f.normal, surface_normal(f.a, f.b, f.c, on));
  };
  return (stands(pair.first) ? 1 : 0) + (stands(pair.second) ? 1 : 0);
}

double least_alignment(const FacetPair& pair, const ChartSurface& on) {
  const auto of = [&on](const Facet& f) { return alignment(f.a, f.b, f.c, on); };
  return std::min(of(pair.first), of(pair.second));
}

/// Whether all is excluded at once that may be wrong with a triangle before or after the flip of ab to cd, as nearly
/// always: with normals within 12 degrees of one, and triangles within 37 degrees of it, none stands upright.
bool is_plain(const FacetPair& now, const FacetPair& then) {
  constexpr double kAlike = 0.98, kAlong = 0.8;  // the sines are below 0.2 and 0.6
  static_assert(kAlike * kAlong - 0.2 * 0.6 > kUpright, "no triangle stands upright on a mean of the normals");
  const Corner &a = now.first.a, &b = now.first.b, &c = now.first.c, &d = now.second.c;
  if (std::min({dot(a.normal, b.normal), dot(a.normal, c.normal), dot(a.normal, d.normal)}) < kAlike) return false;
  const auto longest_of = [](const auto& p, const auto& q, const auto& r, const auto& s) {
    return std::max({norm2(q - p), norm2(r - p), norm2(s - p), norm2(r - q), norm2(s - q), norm2(s - r)});
  };
  const double longest = longest_of(a.position, b.position, c.position, d.position);
  const double longest_in_chart = longest_of(a.q, b.q, c.q, d.q);
  const auto plain = [&](const Facet& f) {
    const double along = dot(f.normal, a.normal), size = norm2(f.normal);
    return !f.degenerate && along > 0 && along * along > kAlong * kAlong * size &&
           size > kFlat * kFlat * longest * longest &&
           std::abs(cross(f.b.q - f.a.q, f.c.q - f.a.q)) > kFlat * longest_in_chart;
  };
  return plain(now.first) && plain(now.second) && plain(then.first) && plain(then.second);
}

/// Whether the angles opposite ab are too large together.
bool angles_improve(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  return cotangent(c.position, a.position, b.position) + cotangent(d.position, a.position, b.position) < -kFlipMargin;
}

/// Delaunay in the mean of the corners' first fundamental forms.
bool flip_improves_on_surface(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  double e = 0, f = 0, g = 0;
  for (const Corner* corner : {&a, &b, &c, &d}) {
    e += dot(corner->dx, corner->dx);
    f += dot(corner->dx, corner->dy);
    g += dot(corner->dy, corner->dy);
  }
  const double determinant = e * g - f * f;
  if (!(determinant > 0)) return false;
  const auto cotangent_at = [&](Vec2 apex, Vec2 p, Vec2 q) {
    const Vec2 u = p - apex, v = q - apex;
    const double inner = e * u.x * v.x + f * (u.x * v.y + u.y * v.x) + g * u.y * v.y;
    return inner / (std::sqrt(determinant) * std::abs(cross(u, v)));
  };
  return cotangent_at(c.q, a.q, b.q) + cotangent_at(d.q, a.q, b.q) < -kFlipMargin;
}

}  // namespace

bool flip_improves(const Corner& a, const Corner& b, const Corner& c, const Corner& d, FlipOrder order,
                   const ChartSurface& on) {
  if (order == FlipOrder::on_surface) return flip_improves_on_surface(a, b, c, d);
  if (c.vertex == d.vertex) return false;
  const FacetPair now{facet(a, b, c), facet(b, a, d)}, then{facet(a, d, c), facet(d, b, c)};
  if (is_plain(now, then) && !bent(a, b) && !bent(c, d)) return angles_improve(a, b, c, d);
  const int flat_now = count_flat(now), flat_then = count_flat(then);
  if (flat_then != flat_now) return flat_then < flat_now;
  // Four corners in a line: no angle says anything, but with the shorter edge each is nearer to a neighbour.
  if (flat_now == 2) return distance(c.q, d.q) < (1 - kFlipMargin) * distance(a.q, b.q);
  const int upright_now = count_upright(now, on), upright_then = count_upright(then, on);
  if (order == FlipOrder::upright_first && upright_then != upright_now) return upright_then < upright_now;
  const bool pole = at_pole(a) || at_pole(b) || at_pole(c) || at_pole(d);
  const auto bends = [&](const Corner& p, const Corner& q) {
    return pole ? bent_beside_pole(p, q, on) : confirmed_bent(p, q, on);
  };
  const bool bent_then = bends(c, d), bent_now = bends(a, b);
  if (bent_then && bent_now) return arc_estimate(c, d) < (1 - kFlipMargin) * arc_estimate(a, b);
  if (bent_then != bent_now) return bent_now;
  const int degenerate_now = count_degenerate(now), degenerate_then = count_degenerate(then);
  if (degenerate_then != degenerate_now) return degenerate_then < degenerate_now;
  if (degenerate_now > 0) return apex_improves(a, b, c, d);
  // A fin stands upright on the surface: thin in the chart, where a point was put on a long edge, but not in space.
  if (upright_now + upright_then > 0) return least_alignment(then, on) > least_alignment(now, on) + kFlipMargin;
  return angles_improve(a, b, c, d);
}

double circumradius(Vec3 a, Vec3 b, Vec3 c) {
  const double twice_area = norm(cross(b - a, c - a));
  if (!(twice_area > 0)) return std::numeric_limits<double>::infinity();
  return distance(a, b) * distance(b, c) * distance(c, a) / (2 * twice_area);
}

std::optional<FacePoint> ball_centre(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q,
                                     const std::array<Vec3, 3>& p) {
  const auto start = affine_centre(q, p);
  if (!start) return std::nullopt;
  const double radius = circumradius(p[0], p[1], p[2]);
  const double reach = 2 * (diameter(q) + distance(*start, centroid(q)));
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  const Vec3 m1 = 0.5 * (p[0] + p[1]), m2 = 0.5 * (p[0] + p[2]);
  const double tolerance1 = kBallTolerance * radius * norm(e1), tolerance2 = kBallTolerance * radius * norm(e2);
  Vec2 x = *start;
  for (int step = 0; step < kNewtonSteps; ++step) {
    if (!inside_chart(x) || distance(x, *start) > reach) return std::nullopt;
    const Vec2 on_grid{snap(x.x), snap(x.y)};
    const SurfaceFirst at = surface.first(chart.to_uv(on_grid));
    const double f1 = dot(e1, at.value - m1), f2 = dot(e2, at.value - m2);
    if (std::abs(f1) <= tolerance1 && std::abs(f2) <= tolerance2) {
      if (distance(at.value, p[0]) > 1.5 * radius) return std::nullopt;
      return FacePoint{on_grid, at};
    }
    const Vec3 dx = (1 / chart.scale_u) * at.du, dy = (1 / chart.scale_v) * at.dv;
    const auto move = solve({dot(e1, dx), dot(e1, dy)}, {dot(e2, dx), dot(e2, dy)}, -f1, -f2);
    if (!move) return std::nullopt;
    x = x + *move;
  }
  return std::nullopt;
}

std::optional<Vec2> metric_centre(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q) {
  const SurfaceFirst at = surface.first(chart.to_uv(centroid(q)));
  const Vec3 dx = (1 / chart.scale_u) * at.du, dy = (1 / chart.scale_v) * at.dv;
  // A share of the trace on the diagonal bounds the condition number where a derivative collapses.
  const double floor = 1e-6 * (norm2(dx) + norm2(dy));
  const double e = norm2(dx) + floor, f = dot(dx, dy), g = norm2(dy) + floor;
  const auto apply = [&](Vec2 v) { return Vec2{e * v.x + f * v.y, f * v.x + g * v.y}; };
  const Vec2 r0 = apply(q[1] - q[0]), r1 = apply(q[2] - q[0]);
  const auto offset = solve(r0, r1, 0.5 * dot(q[1] - q[0], r0), 0.5 * dot(q[2] - q[0], r1));
  if (!offset) return std::nullopt;
  const Vec2 centre = q[0] + *offset;
  if (!inside_chart(centre)) return std::nullopt;
  return Vec2{snap(centre.x), snap(centre.y)};
}

double facing(const Surface& surface, const Chart& chart, const std::array<Vec2, 3>& q, const std::array<Vec3, 3>& p) {
  const Vec3 mean = mean_normal({surface, chart}, q[0], q[1], q[2]);
  const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
  return cosine(normal, mean);
}

Vec3 unit_normal(const SurfaceFirst& at) {
  const Vec3 normal = cross(at.du, at.dv);
  const double length = norm(normal);
  return length > 1e-9 * (norm2(at.du) + norm2(at.dv)) ? (1 / length) * normal : Vec3{};
}

FaceMesh::FlipWanted spatial_criterion(const FaceMesh& mesh, const VertexStore& vertices, const ModelFace& face) {
  const auto known = std::make_shared<std::vector<std::optional<Corner>>>();
  const auto corner = [&mesh, &vertices, &face, known](NodeId n) -> const Corner& {
    if (n.value() >= known->size()) known->resize(std::max(mesh.node_count(), std::size_t{n.value()} + 1));
    std::optional<Corner>& slot = (*known)[n.value()];
    const FaceNode& node = mesh.node(n);
    // A rebuilt mesh numbers its nodes anew; a node that does not match is looked up again.
    if (!slot || slot->vertex != node.vertex || !(slot->q == node.q)) {
      const SurfaceFirst at = face.surface->first(mesh.chart.to_uv(node.q));
      slot = make_corner(node, vertices.position(node.vertex), at, mesh.chart);
    }
    return *slot;
  };
  return [corner, &mesh, &face](NodeId a, NodeId b, NodeId c, NodeId d) {
    corner(NodeId(std::max({a.value(), b.value(), c.value(), d.value()})));  // no resizing below: references stay good
    return flip_improves(corner(a), corner(b), corner(c), corner(d), FlipOrder::upright_first,
                         {*face.surface, mesh.chart, mesh.has_tip()});
  };
}

std::optional<Vec2> surface_ball_centre(const FaceMesh& mesh, TriangleId t, const VertexStore& vertices,
                                        const ModelFace& face) {
  std::array<Vec2, 3> q;
  std::array<Vec3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    const FaceNode& node = mesh.node(mesh.triangle(t).node[i]);
    q[i] = node.q;
    p[i] = vertices.position(node.vertex);
  }
  if (const auto centre = ball_centre(*face.surface, mesh.chart, q, p)) return centre->q;
  return ellipse_centre(mesh, t, face);
}

std::optional<Vec2> ellipse_centre(const FaceMesh& mesh, TriangleId t, const ModelFace& face) {
  std::array<Vec2, 3> q;
  for (std::size_t i = 0; i < 3; ++i) q[i] = mesh.node(mesh.triangle(t).node[i]).q;
  return metric_centre(*face.surface, mesh.chart, q);
}

}  // namespace curvetet
