// Small dihedral angles that no mesh of the body can avoid. Two faces of a solid that meet in a thin wedge force one on
// every tet in the wedge: the angles of the tets around a segment sum up to that of the wedge. Two curves that meet at
// a small angle on a face force a triangle as sharp, and with it tets that are hardly better. A face much narrower than
// the elements beside it forces an edge across it that is as short, and seen from the other end of its tet under as
// small an angle. Only few tets are small, so everything is gathered around those few.
//
// The angle between the facets of a coarse mesh is not that of the faces, so where the CAD is at hand, it has the last
// word: a wedge counts only if the faces themselves meet in a small angle somewhere along the segment.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "mesh/tet_complex.h"
#include "quality/checks.h"
#include "quality/measures.h"

namespace curvetet::checks {
namespace {

constexpr double kSmall = 5;  ///< degrees
constexpr double kHalf = 0.5;

using Index = std::uint32_t;
using Pair = std::array<Index, 2>;
using Triple = std::array<Index, 3>;

Pair ordered(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

Triple ordered(Triple t) {
  std::sort(t.begin(), t.end());
  return t;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// A boundary triangle over an edge: its face and its third vertex.
struct Over {
  Index face, third;
};

/// A tet at a segment: between the half planes to two vertices.
struct Sector {
  Index tet, solid;
  Pair sides;
  double angle;
};

class ForcedAngles {
 public:
  ForcedAngles(const Mesh& mesh, const Model* model, double unit_scale, QualitySummary& summary)
      : mesh_(mesh), model_(model), unit_scale_(unit_scale), summary_(summary) {}

  void run() {
    collect_small();
    if (small_.empty()) return;
    collect_segments();
    collect_surroundings();
    for (const auto& [tet, angles] : small_) judge(tet, angles);
  }

 private:
  struct Small {
    Index tet;
    std::array<double, 6> angles;
  };

  Vec3 at(Index v) const { return vec(mesh_.points[v]); }

  Pair edge(Index tet, std::size_t e) const {
    const auto& t = mesh_.tets[tet];
    return ordered(t[static_cast<std::size_t>(kEdge[e][0])], t[static_cast<std::size_t>(kEdge[e][1])]);
  }

  void collect_small() {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto& v = mesh_.tets[t];
      if (smallest_dihedral(at(v[0]), at(v[1]), at(v[2]), at(v[3])) >= kSmall) continue;
      small_.push_back({static_cast<Index>(t), dihedral_angles(at(v[0]), at(v[1]), at(v[2]), at(v[3]))});
    }
  }

  /// The segments at which a tet is small, and all on its sides, with their CAD edges.
  void collect_segments() {
    std::set<Pair> wanted;
    for (const Small& s : small_) {
      for (std::size_t e = 0; e < 6; ++e) {
        wanted.insert(edge(s.tet, e));
        if (s.angles[e] >= kSmall) continue;
        const Pair across = edge(s.tet, 5 - e);
        if (between_curves(across)) across_[across] = {};
      }
      for (std::size_t i = 0; i < 4; ++i) facets_[facet(s.tet, i)] = kOutside;
    }
    for (std::size_t s = 0; s < mesh_.segments.size(); ++s) {
      const Pair key = ordered(mesh_.segments[s][0], mesh_.segments[s][1]);
      if (wanted.count(key)) segments_[key] = mesh_.segment_edge[s];
    }
  }

  /// Joins vertices on two different CAD edges (or CAD vertices).
  bool between_curves(const Pair& e) const {
    const NodeOnCad &a = mesh_.nodes[e[0]], &b = mesh_.nodes[e[1]];
    return a.dimension <= 1 && b.dimension <= 1 && (a.dimension != b.dimension || a.entity != b.entity);
  }

  Triple facet(Index tet, std::size_t i) const {
    const auto& t = mesh_.tets[tet];
    return ordered(Triple{t[static_cast<std::size_t>(kFacet[i][0])], t[static_cast<std::size_t>(kFacet[i][1])],
                          t[static_cast<std::size_t>(kFacet[i][2])]});
  }

  /// The tets around the segments, and the faces of the triangles there.
  void collect_surroundings() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& v = mesh_.triangles[t];
      const auto known = facets_.find(ordered(Triple{v[0], v[1], v[2]}));
      if (known != facets_.end()) known->second = mesh_.triangle_face[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const Pair side = ordered(v[i], v[(i + 1) % 3]);
        if (const auto over = across_.find(side); over != across_.end())
          over->second.push_back({mesh_.triangle_face[t], v[(i + 2) % 3]});
        if (segments_.count(side)) walls_[{side[0], side[1], v[(i + 2) % 3]}] = mesh_.triangle_face[t];
      }
    }
    std::vector<char> at_segment(mesh_.points.size(), 0);
    for (const auto& [key, edge] : segments_) at_segment[key[0]] = at_segment[key[1]] = 1;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const auto& v = mesh_.tets[t];
      if (at_segment[v[0]] + at_segment[v[1]] + at_segment[v[2]] + at_segment[v[3]] < 2) continue;
      std::array<double, 6> angles{};
      bool known = false;
      for (std::size_t e = 0; e < 6; ++e) {
        const Pair key = edge(static_cast<Index>(t), e);
        if (!segments_.count(key)) continue;
        if (!known) angles = dihedral_angles(at(v[0]), at(v[1]), at(v[2]), at(v[3]));
        known = true;
        const Pair sides{v[static_cast<std::size_t>(kEdge[5 - e][0])], v[static_cast<std::size_t>(kEdge[5 - e][1])]};
        sectors_[key].push_back({static_cast<Index>(t), mesh_.tet_solid[t], sides, angles[e]});
      }
    }
  }

  static void keep_smaller(std::optional<ForcedAngle>& forced, const std::optional<ForcedAngle>& other) {
    if (other && (!forced || other->angle < forced->angle)) forced = other;
  }

  void judge(Index tet, const std::array<double, 6>& angles) {
    std::optional<ForcedAngle> forced;
    for (std::size_t e = 0; e < 6 && !forced; ++e) {
      if (angles[e] < kSmall && segments_.count(edge(tet, e))) forced = wedge(tet, edge(tet, e));
    }
    for (std::size_t i = 0; i < 4 && !forced; ++i) forced = sharp_corner(facet(tet, i));
    for (std::size_t e = 0; e < 6; ++e) {
      if (angles[e] >= kSmall) continue;
      keep_smaller(forced, narrow_face(edge(tet, e), edge(tet, 5 - e)));
    }
    for (std::size_t i = 0; i < 4; ++i) keep_smaller(forced, needle(facet(tet, i), mesh_.tets[tet][i]));
    if (!forced) return;
    const double smallest = *std::min_element(angles.begin(), angles.end());
    ++summary_.forced_below_five;
    summary_.forced_below_half += smallest < kHalf && forced->angle < kHalf ? 1 : 0;
    const auto same = std::find_if(summary_.forced.begin(), summary_.forced.end(), [&](const ForcedAngle& f) {
      return f.faces == forced->faces && f.edges == forced->edges && f.vertex == forced->vertex;
    });
    if (same == summary_.forced.end()) {
      forced->tets = 1;
      summary_.forced.push_back(*forced);
    } else {
      ++same->tets;
      if (forced->angle < same->angle) same->angle = forced->angle, same->place = forced->place;
    }
  }

  std::optional<Index> wall(const Pair& segment, Index side) const {
    const auto found = walls_.find({segment[0], segment[1], side});
    return found == walls_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The wedge of a solid that the tet is in, if it is a thin one.
  std::optional<ForcedAngle> wedge(Index tet, const Pair& segment) const {
    const std::vector<Sector>& sectors = sectors_.at(segment);
    const auto start = std::find_if(sectors.begin(), sectors.end(), [&](const Sector& s) { return s.tet == tet; });
    double sum = start->angle;
    std::vector<Index> faces;
    for (Index side : start->sides) {
      const Sector* here = &*start;
      while (!wall(segment, side)) {
        const auto next = std::find_if(sectors.begin(), sectors.end(), [&](const Sector& s) {
          return &s != here && s.solid == here->solid && (s.sides[0] == side || s.sides[1] == side);
        });
        if (next == sectors.end() || next == start) return std::nullopt;
        here = &*next;
        side = here->sides[0] == side ? here->sides[1] : here->sides[0];
        sum += here->angle;
      }
      faces.push_back(*wall(segment, side));
    }
    if (sum >= kSmall) return std::nullopt;
    std::sort(faces.begin(), faces.end());
    const Index edge = segments_.at(segment);
    const double angle = model_ == nullptr ? sum : cad_angle(segment, edge, faces[0], faces[1]);
    if (angle >= kSmall) return std::nullopt;
    const Vec3 middle = 0.5 * (at(segment[0]) + at(segment[1]));
    return ForcedAngle{faces, {edge}, std::nullopt, angle, {middle.x, middle.y, middle.z}, 0};
  }

  /// Least angle between the tangent planes of two faces along a segment of a CAD edge, degrees; at most 90.
  double cad_angle(const Pair& segment, Index edge, Index f, Index g) const {
    const auto e = by_cad_id(model_->edges, mesh_.edges[edge].cad_id);
    if (!e || (*e)->degenerate) return 90;
    double least = 90;
    const Vec3 p = at(segment[0]), q = at(segment[1]);
    for (const double s : {0.0, 0.5, 1.0}) {
      const Vec3 place = model_->frame.to_working((1 / unit_scale_) * (p + s * (q - p)));
      const double guess = (*e)->low + 0.5 * ((*e)->high - (*e)->low);
      const double t = (*e)->curve->project(place, guess, (*e)->low, (*e)->high);
      for (const Vec3& m : normals(**e, f, t)) {
        for (const Vec3& n : normals(**e, g, t)) {
          if (f == g && m == n) continue;
          least = std::min(least, degrees(std::atan2(norm(cross(m, n)), std::abs(dot(m, n)))));
        }
      }
    }
    return least;
  }

  /// Normals of a face at parameter t of an edge, one for each use.
  std::vector<Vec3> normals(const ModelEdge& edge, Index face, double t) const {
    std::vector<Vec3> all;
    const auto f = by_cad_id(model_->faces, mesh_.faces[face].cad_id);
    if (!f) return all;
    const auto add = [&](const EdgeUse& use) {
      if (&model_->edges[use.edge] == &edge) all.push_back((*f)->surface->normal(use.curve->value(t)));
    };
    for (const Loop& loop : (*f)->loops) std::for_each(loop.uses.begin(), loop.uses.end(), add);
    std::for_each((*f)->internal_edges.begin(), (*f)->internal_edges.end(), add);
    return all;
  }

  template <class Entities>
  static auto by_cad_id(const Entities& entities, std::uint32_t id) -> std::optional<decltype(entities.begin())> {
    const auto found =
        std::find_if(entities.begin(), entities.end(), [&](const auto& entity) { return entity.label.cad_id == id; });
    return found == entities.end() ? std::nullopt : std::optional(found);
  }

  /// A boundary triangle with a sharp angle between two CAD edges at a CAD vertex.
  std::optional<ForcedAngle> sharp_corner(const Triple& facet) const {
    const Index face = facets_.at(facet);
    if (face == kOutside) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = facet[i], a = facet[(i + 1) % 3], b = facet[(i + 2) % 3];
      const auto ea = segments_.find(ordered(v, a)), eb = segments_.find(ordered(v, b));
      if (mesh_.nodes[v].dimension != 0 || ea == segments_.end() || eb == segments_.end()) continue;
      const double angle = corner_angle(v, a, b);
      if (angle >= kSmall || ea->second == eb->second) continue;
      const Pair edges = ordered(ea->second, eb->second);
      return ForcedAngle{{face}, {edges[0], edges[1]}, mesh_.nodes[v].entity, angle, mesh_.points[v], 0};
    }
    return std::nullopt;
  }

  bool is_corner(Index v) const { return mesh_.nodes[v].dimension == 0; }

  /// An edge across a face, from one of its curves to another, or all of a CAD edge, so near the other curve that the
  /// tet's opposite edge sees it under a small angle.
  std::optional<ForcedAngle> narrow_face(const Pair& from, const Pair& across) const {
    const auto found = across_.find(across);
    if (found == across_.end() || found->second.empty()) return std::nullopt;
    const auto segment = segments_.find(across);
    if (segment != segments_.end() && !(is_corner(across[0]) && is_corner(across[1]))) return std::nullopt;
    double angle = seen_under(from, across);
    for (const Over& over : found->second) angle = std::min(angle, strip(from, across, over.third));
    if (angle >= kSmall) return std::nullopt;
    const std::vector<Index> edges = segment == segments_.end() ? curves_of(across) : std::vector{segment->second};
    return narrow(found->second.front().face, edges, angle, 0.5 * (at(across[0]) + at(across[1])));
  }

  /// A bound of the tet's least angle where an edge is slanted across a strip, with a triangle there whose third vertex
  /// is on the curve of one end, the foot. The other end, the apex, is hardly higher over the tet's facet at the foot
  /// than the strip is wide, and the angles at that facet's edges have that height over their distance as sine.
  double strip(const Pair& from, const Pair& across, Index third) const {
    double least = 90;
    for (std::size_t k = 0; k < 2; ++k) {
      const Index foot = across[k], apex = across[1 - k];
      if (between_curves({foot, third}) || mesh_.nodes[third].dimension > 1) continue;
      const Vec3 along = at(third) - at(foot);
      const double share = dot(at(apex) - at(foot), along) / norm2(along);
      if (!(share >= 0 && share <= 1)) continue;  // not beside the segment: the curves may meet at a wide angle there
      const Vec3 nearest = at(foot) + share * along;
      const Vec3 normal = normalized(cross(at(from[1]) - at(from[0]), at(foot) - at(from[0])));
      const double height = distance(at(apex), nearest) + std::abs(dot(nearest - at(foot), normal));
      const double furthest =
          std::max({acute_distance(apex, from, foot), acute_distance(apex, {foot, from[0]}, from[1]),
                    acute_distance(apex, {foot, from[1]}, from[0])});
      if (height < furthest) least = std::min(least, degrees(std::asin(height / furthest)));
    }
    return least;
  }

  /// Of an apex to an edge of a triangle; 0 if the angle there is not acute.
  double acute_distance(Index apex, const Pair& edge, Index third) const {
    const Vec3 along = normalized(at(edge[1]) - at(edge[0]));
    const auto off = [&](Index v) {
      const Vec3 d = at(v) - at(edge[0]);
      return d - dot(d, along) * along;
    };
    return dot(off(apex), off(third)) > 0 ? norm(off(apex)) : 0;
  }

  /// The largest angle under which an edge can be seen from the line of another as near as this, degrees.
  double seen_under(const Pair& from, const Pair& across) const {
    const double reach = std::min(to_line(across[0], from), to_line(across[1], from));
    return degrees(2 * std::asin(std::min(1.0, 0.5 * distance(at(across[0]), at(across[1])) / reach)));
  }

  /// A triangle over a narrow face, from a segment of one curve to a vertex on another, and a tet over it.
  std::optional<ForcedAngle> needle(const Triple& facet, Index apex) const {
    const Index face = facets_.at(facet);
    if (face == kOutside) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index r = facet[i], p = facet[(i + 1) % 3], q = facet[(i + 2) % 3];
      const auto segment = segments_.find(ordered(p, q));
      const NodeOnCad& node = mesh_.nodes[r];
      if (segment == segments_.end() || node.dimension > 1) continue;
      if (node.dimension == 1 && node.entity == segment->second) continue;
      const double angle = std::min(bound_at(p, q, r, apex), bound_at(q, r, p, apex));
      if (angle >= kSmall) continue;
      std::vector<Index> edges{segment->second};
      if (node.dimension == 1) edges.push_back(node.entity);
      return narrow(face, std::move(edges), angle, at(r));
    }
    return std::nullopt;
  }

  /// The angle of a tet at its edge from v to the apex is no larger than this, by the sine rule of the spherical
  /// triangle that it cuts out around v; degrees.
  double bound_at(Index v, Index a, Index b, Index apex) const {
    const auto sine = [&](Index x, Index y) { return std::sin(corner_angle(v, x, y) * std::numbers::pi / 180); };
    return degrees(std::asin(std::min(1.0, sine(a, b) / std::max(sine(apex, a), sine(apex, b)))));
  }

  /// At v between the directions to a and b, degrees.
  double corner_angle(Index v, Index a, Index b) const {
    const Vec3 x = at(a) - at(v), y = at(b) - at(v);
    return degrees(std::atan2(norm(cross(x, y)), dot(x, y)));
  }

  double to_line(Index v, const Pair& line) const {
    return norm(cross(at(v) - at(line[0]), normalized(at(line[1]) - at(line[0]))));
  }

  std::vector<Index> curves_of(const Pair& ends) const {
    std::vector<Index> edges;
    for (Index v : ends)
      if (mesh_.nodes[v].dimension == 1) edges.push_back(mesh_.nodes[v].entity);
    return edges;
  }

  static ForcedAngle narrow(Index face, std::vector<Index> edges, double angle, Vec3 place) {
    std::sort(edges.begin(), edges.end());
    return {{face}, std::move(edges), std::nullopt, angle, {place.x, place.y, place.z}, 0};
  }

  const Mesh& mesh_;
  const Model* model_;
  double unit_scale_;
  QualitySummary& summary_;
  std::vector<Small> small_;
  std::map<Pair, Index> segments_;               ///< of small tets, with their CAD edges
  std::map<Pair, std::vector<Over>> across_;     ///< edges between curves that small angles look at
  std::map<Triple, Index> facets_;               ///< of small tets, with their face if they are on the boundary
  std::map<Triple, Index> walls_;                ///< face of the triangle over a segment (two first) and a vertex
  std::map<Pair, std::vector<Sector>> sectors_;  ///< around each segment
};

}  // namespace

void find_forced_angles(const Mesh& mesh, const Model* model, double unit_scale, QualitySummary& summary) {
  ForcedAngles(mesh, model, unit_scale, summary).run();
}

}  // namespace curvetet::checks
