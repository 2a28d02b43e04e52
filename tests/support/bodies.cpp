// Bodies of revolution come from profiles in the half-plane (rho, z), walked with the material to the left: each
// straight piece or arc is a face, each of its ends a circle or a pole. Boxes are written out corner by corner.
#include "support/bodies.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "geometry/analytic.h"

namespace curvetet::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTolerance = 1e-7;

class Builder {
 public:
  explicit Builder(const Box3& box) {
    model_.frame = Frame::of(box);
    model_.box.extend(model_.frame.to_working(box.low));
    model_.box.extend(model_.frame.to_working(box.high));
  }

  double length(double cad) const { return model_.frame.length_to_working(cad); }

  Placement placement(Vec3 origin) const {
    Placement at;
    at.origin = model_.frame.to_working(origin);
    at.unit = model_.frame.scale;
    return at;
  }

  CadVertexId vertex(Vec3 point) {
    ModelVertex v;
    v.label.cad_id = static_cast<std::uint32_t>(model_.vertices.size() + 1);
    v.point = snap(model_.frame.to_working(point));
    v.tolerance = length(kTolerance);
    return model_.vertices.push_back(v);
  }

  EdgeId edge(std::shared_ptr<const Curve> curve, double low, double high, CadVertexId start, CadVertexId end) {
    ModelEdge e;
    e.label.cad_id = static_cast<std::uint32_t>(model_.edges.size() + 1);
    e.degenerate = curve == nullptr;
    e.curve = std::move(curve);
    e.low = low;
    e.high = high;
    e.start = start;
    e.end = end;
    e.tolerance = length(kTolerance);
    return model_.edges.push_back(std::move(e));
  }

  FaceId face(std::unique_ptr<Surface> surface, bool reversed, Vec2 low, Vec2 high, double area) {
    ModelFace f;
    f.label.cad_id = static_cast<std::uint32_t>(model_.faces.size() + 1);
    surface->set_domain(low, high);
    f.surface = std::move(surface);
    f.reversed = reversed;
    f.low = low;
    f.high = high;
    f.tolerance = length(kTolerance);
    f.area = area * model_.frame.scale * model_.frame.scale;
    return model_.faces.push_back(std::move(f));
  }

  void loop(FaceId face, std::vector<EdgeUse> uses) {
    for (const EdgeUse& use : uses) {
      auto& faces = model_.edges[use.edge].faces;
      if (faces.empty() || faces.back() != face) faces.push_back(face);
    }
    model_.faces[face].loops.push_back({std::move(uses)});
  }

  SolidId solid(double volume) {
    ModelSolid s;
    s.label.cad_id = static_cast<std::uint32_t>(model_.solids.size() + 1);
    s.volume = volume * std::pow(model_.frame.scale, 3);
    return model_.solids.push_back(std::move(s));
  }

  /// Puts solids on the two sides of a face: behind its outward normal, and in front of it.
  void sides(FaceId face, SolidId back, SolidId front) {
    model_.faces[face].back = back;
    model_.faces[face].front = front;
    if (back.valid()) model_.solids[back].faces.push_back(face);
    if (front.valid()) model_.solids[front].faces.push_back(face);
  }

  Model take() { return std::move(model_); }

 private:
  Model model_;
};

EdgeUse use(EdgeId edge, bool reversed, Vec2 origin, Vec2 direction, bool seam = false) {
  EdgeUse u;
  u.edge = edge;
  u.reversed = reversed;
  u.seam = seam;
  u.curve = make_parameter_line(origin, direction);
  return u;
}

// --- half ellipsoid ---

/// centre + a cos u cos v x + b sin u cos v y + c sin v z.
class Ellipsoid : public Surface {
 public:
  Ellipsoid(Vec3 centre, double a, double b, double c) : centre_(centre), a_(a), b_(b), c_(c) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return centre_ + at(std::cos(uv.x), std::sin(uv.x), uv.y); }
  SurfaceFirst first(Vec2 uv) const override {
    const SurfaceSecond s = second(uv);
    return {s.value, s.du, s.dv};
  }
  SurfaceSecond second(Vec2 uv) const override {
    const double cu = std::cos(uv.x), su = std::sin(uv.x), cv = std::cos(uv.y), sv = std::sin(uv.y);
    const Vec3 around{-a_ * su, b_ * cu, 0}, outwards{a_ * cu, b_ * su, 0};
    return {value(uv),      cv * around,  Vec3{-sv * outwards.x, -sv * outwards.y, c_ * cv},
            -cv * outwards, -sv * around, -1.0 * at(cu, su, uv.y)};
  }
  double period_u() const override { return 2 * kPi; }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Ellipsoid>(*this); }

 private:
  Vec3 at(double cu, double su, double v) const {
    return {a_ * cu * std::cos(v), b_ * su * std::cos(v), c_ * std::sin(v)};
  }
  Vec3 centre_;
  double a_, b_, c_;
};

Box3 half_ellipsoid_box(double a, double b, double c) {
  Box3 box;
  box.extend({-a, 0, -c});
  box.extend({a, b, c});
  return box;
}

// --- boxes ---

/// A grid of corners with `cells` cells along x.
class Boxes {
 public:
  Boxes(std::vector<double> cuts, double y, double z)
      : cuts_(std::move(cuts)), y_(y), z_(z), builder_(bounds(cuts_, y, z)) {}

  Model make() {
    make_corners();
    make_edges();
    const std::size_t cells = cuts_.size() - 1;
    for (std::size_t i = 0; i < cells; ++i) solids_.push_back(builder_.solid((cuts_[i + 1] - cuts_[i]) * y_ * z_));
    for (std::size_t i = 0; i <= cells; ++i) make_cross_face(i);
    for (std::size_t i = 0; i < cells; ++i) make_side_faces(i);
    return builder_.take();
  }

 private:
  static Box3 bounds(const std::vector<double>& cuts, double y, double z) {
    Box3 box;
    box.extend({cuts.front(), 0, 0});
    box.extend({cuts.back(), y, z});
    return box;
  }

  Vec3 corner(std::size_t i, int k) const {
    // Counter-clockwise in (y, z).
    return {cuts_[i], k == 1 || k == 2 ? y_ : 0, k >= 2 ? z_ : 0};
  }

  void make_corners() {
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
      for (int k = 0; k < 4; ++k) corners_.push_back(builder_.vertex(corner(i, k)));
    }
  }

  EdgeId line(Vec3 a, Vec3 b, CadVertexId start, CadVertexId end) {
    const Placement at = builder_.placement(a);
    return builder_.edge(make_line(at.origin, normalized(b - a), at.unit), 0, distance(a, b), start, end);
  }

  void make_edges() {
    for (std::size_t i = 0; i < cuts_.size(); ++i) {
      for (int k = 0; k < 4; ++k) {
        const int l = (k + 1) % 4;
        ring_.push_back(line(corner(i, k), corner(i, l), corners_[4 * i + k], corners_[4 * i + l]));
      }
    }
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      for (int k = 0; k < 4; ++k) {
        along_.push_back(line(corner(i, k), corner(i + 1, k), corners_[4 * i + k], corners_[4 * (i + 1) + k]));
      }
    }
  }

  /// Use of the straight edge from a to b on a plane at `origin` with axes x and y, walked backwards if reversed.
  static EdgeUse straight(EdgeId edge, bool reversed, Vec3 a, Vec3 b, Vec3 origin, Vec3 x, Vec3 y) {
    const Vec3 d = normalized(b - a);
    return use(edge, reversed, {dot(a - origin, x), dot(a - origin, y)}, {dot(d, x), dot(d, y)});
  }

  /// The face at cut i, normal +x; it looks out of the solid before it, except for the first one.
  void make_cross_face(std::size_t i) {
    Placement at = builder_.placement(corner(i, 0));
    at.x = {0, 1, 0}, at.y = {0, 0, 1}, at.z = {1, 0, 0};
    const bool first = i == 0;
    const FaceId face = builder_.face(make_plane(at), first, {0, 0}, {y_, z_}, y_ * z_);
    std::vector<EdgeUse> uses;
    for (int k = 0; k < 4; ++k) {
      uses.push_back(straight(ring_[4 * i + k], false, corner(i, k), corner(i, (k + 1) % 4), corner(i, 0), at.x, at.y));
    }
    builder_.loop(face, std::move(uses));
    const SolidId next = i < solids_.size() ? solids_[i] : SolidId();
    builder_.sides(face, first ? next : solids_[i - 1], first ? SolidId() : next);
  }

  /// The four faces around cell i. Each has u along x and v along its ring edge; the normal x cross v points outward.
  void make_side_faces(std::size_t i) {
    for (int k = 0; k < 4; ++k) {
      const int l = (k + 1) % 4;
      const Vec3 a = corner(i, k), b = corner(i, l), c = corner(i + 1, k), d = corner(i + 1, l);
      Placement at = builder_.placement(a);
      at.x = {1, 0, 0}, at.y = normalized(b - a), at.z = cross(at.x, at.y);
      const double width = distance(a, c), height = distance(a, b);
      // x cross the ring's direction points inwards or outwards by where the middle of the body lies.
      const Vec3 middle{a.x, y_ / 2, z_ / 2};
      const bool reversed = dot(middle - a, at.z) > 0;
      const FaceId face = builder_.face(make_plane(at), reversed, {0, 0}, {width, height}, width * height);
      std::vector<EdgeUse> uses;
      uses.push_back(straight(along_[4 * i + k], false, a, c, a, at.x, at.y));
      uses.push_back(straight(ring_[4 * (i + 1) + k], false, c, d, a, at.x, at.y));
      uses.push_back(straight(along_[4 * i + l], true, b, d, a, at.x, at.y));
      uses.push_back(straight(ring_[4 * i + k], true, a, b, a, at.x, at.y));
      builder_.loop(face, std::move(uses));
      builder_.sides(face, solids_[i], SolidId());
    }
  }

  std::vector<double> cuts_;
  double y_, z_;
  Builder builder_;
  std::vector<CadVertexId> corners_;
  std::vector<EdgeId> ring_, along_;
  std::vector<SolidId> solids_;
};

// --- bodies of revolution ---

/// One piece of a profile: straight, or an arc about (centre_rho, centre_z) between two angles.
struct Piece {
  Vec2 from, to;
  bool arc = false;
  Vec2 centre{};
  double radius = 0, from_angle = 0, to_angle = 0;
};

Piece straight_piece(Vec2 from, Vec2 to) { return {from, to}; }

Piece arc_piece(Vec2 centre, double radius, double from_angle, double to_angle) {
  const auto at = [&](double a) {
    // A pole lies on the axis exactly.
    const double c = std::abs(std::abs(a) - kPi / 2) < 1e-12 ? 0 : std::cos(a);
    return Vec2{centre.x + radius * c, centre.y + radius * std::sin(a)};
  };
  return {at(from_angle), at(to_angle), true, centre, radius, from_angle, to_angle};
}

/// A connected chain of pieces, with the solids to its left (material) and to its right.
struct Profile {
  std::vector<Piece> pieces;
  SolidId left, right;
  bool closed = false;
};

/// One end of a piece, turned around the axis.
struct Ring {
  CadVertexId vertex;
  EdgeId edge;  ///< the circle, or the pole
  bool pole = false;
  Vec2 at;
};

class Revolution {
 public:
  Revolution(double radius, double z_low, double z_high) : builder_(bounds(radius, z_low, z_high)) {}

  SolidId solid(double volume) { return builder_.solid(volume); }

  void add(const Profile& profile) {
    std::vector<Ring> rings;
    for (const Piece& piece : profile.pieces) rings.push_back(ring(piece.from));
    rings.push_back(profile.closed ? rings.front() : ring(profile.pieces.back().to));
    for (std::size_t i = 0; i < profile.pieces.size(); ++i) {
      const FaceId face = add_face(profile.pieces[i], rings[i], rings[i + 1]);
      builder_.sides(face, profile.left, profile.right);
    }
  }

  Model take() { return builder_.take(); }

 private:
  static Box3 bounds(double radius, double z_low, double z_high) {
    Box3 box;
    box.extend({-radius, -radius, z_low});
    box.extend({radius, radius, z_high});
    return box;
  }

  Ring ring(Vec2 at) {
    Ring r;
    r.at = at;
    r.pole = at.x == 0;
    if (r.pole) return r;  // a disc has nothing there; a face that has a pole makes its vertex and edge
    const double radius = builder_.length(at.x);
    r.vertex = builder_.vertex({at.x, 0, at.y});
    r.edge =
        builder_.edge(make_ellipse(builder_.placement({0, 0, at.y}), radius, radius), 0, 2 * kPi, r.vertex, r.vertex);
    return r;
  }

  FaceId add_face(const Piece& piece, const Ring& from, const Ring& to) {
    if (piece.arc) return add_arc(piece, from, to);
    return piece.from.y == piece.to.y ? add_flat(from, to) : add_slope(from, to);
  }

  /// A disc or an annulus. The profile runs outwards under the material, inwards above it.
  FaceId add_flat(const Ring& from, const Ring& to) {
    const bool outwards = to.at.x > from.at.x;
    const Ring& outer = outwards ? to : from;
    const Ring& inner = outwards ? from : to;
    const double r = outer.at.x;
    const double area = kPi * (r * r - inner.at.x * inner.at.x);
    const FaceId face =
        builder_.face(make_plane(builder_.placement({0, 0, from.at.y})), outwards, {-r, -r}, {r, r}, area);
    for (const Ring* ring : {&outer, &inner}) {
      if (ring->pole) continue;
      EdgeUse u;
      u.edge = ring->edge;
      u.reversed = ring == &inner;
      u.curve = make_parameter_ellipse({}, {ring->at.x, 0}, {0, ring->at.x});
      builder_.loop(face, {u});
    }
    return face;
  }

  FaceId add_slope(const Ring& from, const Ring& to) {
    const bool up = to.at.y > from.at.y;
    const Ring& low = up ? from : to;
    const Ring& high = up ? to : from;
    const Vec2 d = high.at - low.at;
    const double slant = norm(d);
    const Placement at = builder_.placement({0, 0, low.at.y});
    auto surface = d.x == 0 ? make_cylinder(at, builder_.length(low.at.x))
                            : make_cone(at, builder_.length(low.at.x), std::atan2(d.x, d.y));
    const Vec3 a{low.at.x, 0, low.at.y}, b{high.at.x, 0, high.at.y};
    auto seam = make_line(builder_.placement(a).origin, normalized(b - a), at.unit);
    const double area = kPi * (low.at.x + high.at.x) * slant;
    return add_periodic(std::move(surface), std::move(seam), !up, low, high, 0, slant, area);
  }

  FaceId add_arc(const Piece& piece, const Ring& from, const Ring& to) {
    const bool up = piece.to_angle > piece.from_angle;
    const double low = std::min(piece.from_angle, piece.to_angle), high = std::max(piece.from_angle, piece.to_angle);
    const Placement at = builder_.placement({0, 0, piece.centre.y});
    const double minor = builder_.length(piece.radius);
    auto surface =
        piece.centre.x == 0 ? make_sphere(at, minor) : make_torus(at, builder_.length(piece.centre.x), minor);
    Placement upright = builder_.placement({piece.centre.x, 0, piece.centre.y});
    upright.y = {0, 0, 1}, upright.z = {0, -1, 0};
    auto seam = make_ellipse(upright, minor, minor);
    const double area =
        2 * kPi * piece.radius * (piece.centre.x * (high - low) + piece.radius * (std::sin(high) - std::sin(low)));
    return add_periodic(std::move(surface), std::move(seam), !up, up ? from : to, up ? to : from, low, high, area);
  }

  /// A face periodic in u: bottom ring, seam, top ring, seam.
  FaceId add_periodic(std::unique_ptr<Surface> surface, std::unique_ptr<Curve> seam_curve, bool reversed, Ring low,
                      Ring high, double v_low, double v_high, double area) {
    const FaceId face = builder_.face(std::move(surface), reversed, {0, v_low}, {2 * kPi, v_high}, area);
    for (Ring* ring : {&low, &high}) {
      if (!ring->pole) continue;
      ring->vertex = builder_.vertex({0, 0, ring->at.y});
      ring->edge = builder_.edge(nullptr, 0, 2 * kPi, ring->vertex, ring->vertex);
    }
    const EdgeId seam = builder_.edge(std::move(seam_curve), v_low, v_high, low.vertex, high.vertex);
    const bool closed = low.edge == high.edge;
    builder_.loop(face, {use(low.edge, false, {0, v_low}, {1, 0}, closed), use(seam, false, {2 * kPi, 0}, {0, 1}, true),
                         use(high.edge, true, {0, v_high}, {1, 0}, closed), use(seam, true, {0, 0}, {0, 1}, true)});
    return face;
  }

  Builder builder_;
};

double ball_volume(double radius) { return 4.0 / 3.0 * kPi * radius * radius * radius; }

Piece half_circle(double radius, bool upwards) {
  return upwards ? arc_piece({}, radius, -kPi / 2, kPi / 2) : arc_piece({}, radius, kPi / 2, -kPi / 2);
}

}  // namespace

Model make_box(double x, double y, double z) { return make_boxes({x}, y, z); }

Model make_boxes(const std::vector<double>& lengths, double y, double z) {
  std::vector<double> cuts{0};
  for (const double length : lengths) cuts.push_back(cuts.back() + length);
  return Boxes(cuts, y, z).make();
}

Model make_ball(double radius) {
  Revolution body(radius, -radius, radius);
  body.add({{half_circle(radius, true)}, body.solid(ball_volume(radius)), SolidId()});
  return body.take();
}

Model make_shell(double outer, double inner) {
  Revolution body(outer, -outer, outer);
  const SolidId solid = body.solid(ball_volume(outer) - ball_volume(inner));
  body.add({{half_circle(outer, true)}, solid, SolidId()});
  body.add({{half_circle(inner, false)}, solid, SolidId()});
  return body.take();
}

Model make_nested_balls(double outer, double inner) {
  Revolution body(outer, -outer, outer);
  const SolidId solid = body.solid(ball_volume(outer) - ball_volume(inner));
  const SolidId core = body.solid(ball_volume(inner));
  body.add({{half_circle(outer, true)}, solid, SolidId()});
  body.add({{half_circle(inner, true)}, core, solid});
  return body.take();
}

Model make_cylinder(double radius, double height) { return make_cone(radius, radius, height); }

Model make_cone(double bottom, double top, double height) {
  Revolution body(std::max(bottom, top), 0, height);
  const SolidId solid = body.solid(kPi * height * (bottom * bottom + bottom * top + top * top) / 3);
  Profile profile;
  profile.left = solid;
  if (bottom > 0) profile.pieces.push_back(straight_piece({0, 0}, {bottom, 0}));
  profile.pieces.push_back(straight_piece({bottom, 0}, {top, height}));
  if (top > 0) profile.pieces.push_back(straight_piece({top, height}, {0, height}));
  body.add(profile);
  return body.take();
}

Model make_pierced_ball(double ball, double radius, double height, double outer, double wall) {
  const double extent = std::max(outer, 0.5 * height);
  Revolution body(std::max(outer, ball), -extent, extent);
  const SolidId solid = body.solid(ball_volume(ball));
  body.add({{half_circle(ball, true)}, solid, SolidId()});
  Profile hole;
  hole.left = solid;
  const double h = 0.5 * height;
  hole.pieces = {straight_piece({0, h}, {radius, h}), straight_piece({radius, h}, {radius, -h}),
                 straight_piece({radius, -h}, {0, -h})};
  body.add(hole);
  if (outer > 0) {
    const double z = 0.8 * outer, r = std::sqrt(std::pow(outer - wall, 2) - z * z);
    const SolidId shell = body.solid(ball_volume(outer) - 2 * kPi * r * r * z);
    body.add({{half_circle(outer, true)}, shell, SolidId()});
    Profile cavity;
    cavity.left = shell;
    cavity.pieces = {straight_piece({0, z}, {r, z}), straight_piece({r, z}, {r, -z}), straight_piece({r, -z}, {0, -z})};
    body.add(cavity);
  }
  return body.take();
}

Model make_torus(double major, double minor) {
  Revolution body(major + minor, -minor, minor);
  const SolidId solid = body.solid(2 * kPi * kPi * major * minor * minor);
  body.add({{arc_piece({major, 0}, minor, 0, 2 * kPi)}, solid, SolidId(), true});
  return body.take();
}

Model make_tube(double outer, double inner, double height) {
  Revolution body(outer, 0, height);
  const SolidId solid = body.solid(kPi * (outer * outer - inner * inner) * height);
  body.add({{straight_piece({inner, 0}, {outer, 0}), straight_piece({outer, 0}, {outer, height}),
             straight_piece({outer, height}, {inner, height}), straight_piece({inner, height}, {inner, 0})},
            solid,
            SolidId(),
            true});
  return body.take();
}

Model make_half_ellipsoid(double a, double b) {
  Builder body(half_ellipsoid_box(a, b, b));
  const SolidId solid = body.solid(ball_volume(1) * a * b * b / 2);
  const CadVertexId bottom = body.vertex({0, 0, -b}), top = body.vertex({0, 0, b});
  const EdgeId low = body.edge(nullptr, 0, kPi, bottom, bottom), high = body.edge(nullptr, 0, kPi, top, top);
  Placement upright = body.placement({});
  upright.y = {0, 0, 1}, upright.z = {0, -1, 0};
  Placement mirrored = upright;
  mirrored.x = {-1, 0, 0}, mirrored.z = {0, 1, 0};
  const EdgeId right = body.edge(make_ellipse(upright, body.length(a), body.length(b)), -kPi / 2, kPi / 2, bottom, top);
  const EdgeId left = body.edge(make_ellipse(mirrored, body.length(a), body.length(b)), -kPi / 2, kPi / 2, bottom, top);

  const double eccentricity = std::sqrt(1 - b * b / (a * a));
  const double area = kPi * b * (b + a / eccentricity * std::asin(eccentricity));
  auto surface = std::make_unique<Ellipsoid>(upright.origin, body.length(a), body.length(b), body.length(b));
  const FaceId dome = body.face(std::move(surface), false, {0, -kPi / 2}, {kPi, kPi / 2}, area);
  body.loop(dome, {use(low, false, {0, -kPi / 2}, {1, 0}), use(left, false, {kPi, 0}, {0, 1}),
                   use(high, true, {0, kPi / 2}, {1, 0}), use(right, true, {0, 0}, {0, 1})});
  const FaceId disc = body.face(make_plane(upright), false, {-a, -b}, {a, b}, kPi * a * b);
  EdgeUse up = use(right, false, {}, {}), down = use(left, true, {}, {});
  up.curve = make_parameter_ellipse({}, {a, 0}, {0, b});
  down.curve = make_parameter_ellipse({}, {-a, 0}, {0, b});
  body.loop(disc, {up, down});
  body.sides(dome, solid, SolidId());
  body.sides(disc, solid, SolidId());
  return body.take();
}

Model make_lens(double rim, double half_thickness) {
  const double radius = (rim * rim + half_thickness * half_thickness) / (2 * half_thickness);
  const double off = radius - half_thickness;  // the caps' centres lie this far from the plane of the rim
  const double angle = std::atan2(off, rim);
  Revolution body(rim, -half_thickness, half_thickness);
  const double cap = kPi * half_thickness * half_thickness * (3 * radius - half_thickness) / 3;
  Piece lower = arc_piece({0, off}, radius, -kPi / 2, -angle), upper = arc_piece({0, -off}, radius, angle, kPi / 2);
  lower.to = upper.from = {rim, 0};
  body.add({{lower, upper}, body.solid(2 * cap), SolidId()});
  return body.take();
}

}  // namespace curvetet::test
