// Loops are walked in (u,v) exactly as the face mesher will walk them; distances are compared in space, since the size
// of a step in (u,v) says nothing. A join is also compared in (u,v), where a loop that jumps by a period would pass in
// space.
#include "geometry/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/trimmed_domain.h"

namespace curvetet {
namespace {

constexpr double kMoreThanATurn = 1e-3;  ///< of a period

class Checker {
 public:
  Checker(const Model& model, const CheckOptions& options)
      : model_(model), options_(options), floor_(options.floor * std::max(model.diagonal(), 1e-3)) {}

  std::vector<ModelFault> run() {
    if (!references_valid()) return std::move(faults_);
    for (std::size_t s = 0; s < model_.solids.size(); ++s) check_solid(SolidId(s));
    for (std::size_t f = 0; f < model_.faces.size(); ++f) check_face(FaceId(f));
    for (std::size_t e = 0; e < model_.edges.size(); ++e) check_edge(EdgeId(e));
    return std::move(faults_);
  }

 private:
  void add(ModelFault::Kind kind, std::string entity, std::string what, double amount = 0) {
    faults_.push_back({kind, std::move(entity), std::move(what), amount, {}});
  }
  std::string face_entity(FaceId f) const { return "face " + std::to_string(model_.faces[f].label.cad_id); }
  std::string edge_entity(EdgeId e) const { return "edge " + std::to_string(model_.edges[e].label.cad_id); }
  double allowed(double tolerance) const {
    return std::min(options_.slack * tolerance, options_.largest * model_.diagonal()) + floor_;
  }

  bool references_valid() {
    const auto valid_use = [&](const EdgeUse& use) {
      return use.edge.valid() && use.edge.value() < model_.edges.size() && use.curve != nullptr;
    };
    for (std::size_t e = 0; e < model_.edges.size(); ++e) {
      const ModelEdge& edge = model_.edges[EdgeId(e)];
      const auto known = [&](CadVertexId v) { return v.valid() && v.value() < model_.vertices.size(); };
      if (!known(edge.start) || !known(edge.end) || !(edge.low < edge.high) ||
          edge.degenerate != (edge.curve == nullptr)) {
        add(ModelFault::Kind::reference, edge_entity(EdgeId(e)), "has no ends, no range or no curve");
      }
    }
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      const ModelFace& face = model_.faces[FaceId(f)];
      bool ok = face.surface != nullptr && !face.loops.empty();
      for (const Loop& loop : face.loops) {
        ok = ok && !loop.uses.empty() && std::all_of(loop.uses.begin(), loop.uses.end(), valid_use);
      }
      ok = ok && std::all_of(face.internal_edges.begin(), face.internal_edges.end(), valid_use);
      if (!ok) add(ModelFault::Kind::reference, face_entity(FaceId(f)), "has no surface, no loop or a broken use");
    }
    return faults_.empty();
  }

  Vec2 at(const EdgeUse& use, double fraction) const {
    const ModelEdge& edge = model_.edges[use.edge];
    const double s = use.reversed ? 1 - fraction : fraction;
    return use.curve->value(edge.low + s * (edge.high - edge.low));
  }

  void check_face(FaceId f) {
    const ModelFace& face = model_.faces[f];
    double area = 0;
    bool open = false;
    for (const Loop& loop : face.loops) {
      area += loop_area(loop);
      open = !check_joins(f, loop) || open;
      for (const EdgeUse& use : loop.uses) check_use(f, use);
    }
    for (const EdgeUse& use : face.internal_edges) check_use(f, use);
    if (!open && !(area > 0)) {
      add(ModelFault::Kind::inside_out, face_entity(f), "its loops bound no positive area", area);
    }
    check_axis(f);
    check_turns(f);
  }

  /// A face may go on beyond a full turn only where it has not been before.
  void check_turns(FaceId f) {
    const ModelFace& face = model_.faces[f];
    const Vec2 extent = face.high - face.low;
    const double turn_u = face.surface->period_u(), turn_v = face.surface->period_v();
    const bool around = turn_u > 0 && extent.x > (1 + kMoreThanATurn) * turn_u;
    const bool along = turn_v > 0 && extent.y > (1 + kMoreThanATurn) * turn_v;
    if (!around && !along) return;
    const TrimmedDomain domain(model_, f);
    if (around) find_twice(f, domain, {turn_u, 0});
    if (along) find_twice(f, domain, {0, turn_v});
  }

  /// A cell of a raster that lies in the domain, as well as a turn later: all of its corners, for the chords that the
  /// domain is told by are not its curves.
  void find_twice(FaceId f, const TrimmedDomain& domain, Vec2 turn) {
    constexpr int kCells = 48;
    const Vec2 cell = (1.0 / kCells) * (domain.high() - domain.low());
    const auto node = [&](int i, int j) { return domain.low() + Vec2{i * cell.x, j * cell.y}; };
    std::vector<char> column(kCells + 1, 0), before;
    for (int i = 0; i <= kCells; ++i) {
      before = column;
      for (int j = 0; j <= kCells; ++j)
        column[j] = domain.inside(node(i, j)) && domain.inside(node(i, j) + turn) ? 1 : 0;
      for (int j = 1; j <= kCells; ++j) {
        if (!column[j] || !column[j - 1] || !before[j] || !before[j - 1]) continue;
        faults_.push_back({ModelFault::Kind::crosses_itself, face_entity(f), "covers a part of its surface twice", 0,
                           model_.faces[f].surface->value(node(i, j) - 0.5 * cell)});
        return;
      }
    }
  }

  /// Beyond the apex a cone goes on as its mirror image, with the side of the material changed, and so does any surface
  /// of revolution whose profile crosses its axis. The derivative around the axis changes its direction there.
  void check_axis(FaceId f) {
    const ModelFace& face = model_.faces[f];
    const bool cone = face.surface->kind() == SurfaceKind::cone;
    if (!cone && face.surface->kind() != SurfaceKind::revolution) return;
    constexpr int kSteps = 400;
    const auto ring = [&](int i) {
      return face.surface->first({face.low.x, face.low.y + (face.high.y - face.low.y) * i / kSteps});
    };
    SurfaceFirst last = ring(0);
    double before = 0, radius = norm(last.du);  // the largest radii on this side of the axis and on the one before
    Vec3 crossing{};
    for (int i = 1; i <= kSteps; ++i) {
      const SurfaceFirst here = ring(i);
      if (dot(here.du, last.du) < 0) {
        before = radius;
        radius = 0;
        const double r = norm(last.du), s = norm(here.du);
        crossing = last.value + (r / (r + s)) * (here.value - last.value);
      }
      radius = std::max(radius, norm(here.du));
      if (norm2(here.du) > 0) last = here;
      if (std::min(before, radius) <= allowed(face.tolerance)) continue;
      faults_.push_back(
          {ModelFault::Kind::crosses_itself, face_entity(f),
           cone ? "is on both sides of its cone's apex and crosses itself there" : "crosses its axis, and itself there",
           std::min(before, radius), crossing});
      return;
    }
  }

  double loop_area(const Loop& loop) const {
    constexpr int kSteps = 32;
    double twice = 0;
    const Vec2 origin = at(loop.uses.front(), 0);
    Vec2 last = origin;
    const auto advance = [&](Vec2 next) {
      twice += cross(last - origin, next - origin);
      last = next;
    };
    for (const EdgeUse& use : loop.uses) {
      for (int i = 0; i <= kSteps; ++i) advance(at(use, static_cast<double>(i) / kSteps));
    }
    return twice / 2;
  }

  bool check_joins(FaceId f, const Loop& loop) {
    const ModelFace& face = model_.faces[f];
    const Vec2 extent = face.high - face.low;
    bool joined = true;
    for (std::size_t i = 0; i < loop.uses.size(); ++i) {
      const EdgeUse& use = loop.uses[i];
      const EdgeUse& next = loop.uses[(i + 1) % loop.uses.size()];
      const Vec2 a = at(use, 1), b = at(next, 0);
      const ModelEdge& edge = model_.edges[use.edge];
      const CadVertexId end = use.reversed ? edge.start : edge.end;
      const double tolerance =
          std::max({edge.tolerance, model_.edges[next.edge].tolerance, model_.vertices[end].tolerance, face.tolerance});
      const double gap = distance(face.surface->value(a), face.surface->value(b));
      const bool jump = std::abs(a.x - b.x) > jump_limit(face.surface->period_u(), extent.x) ||
                        std::abs(a.y - b.y) > jump_limit(face.surface->period_v(), extent.y);
      if (std::isfinite(gap) && gap <= allowed(tolerance) && !jump) continue;
      joined = false;
      add(ModelFault::Kind::loop_open, face_entity(f),
          edge_entity(use.edge) + " does not meet " + edge_entity(next.edge) + " in (u,v)", gap);
    }
    return joined;
  }

  static double jump_limit(double period, double extent) {
    return period > 0 ? 0.25 * period : 0.25 * std::max(extent, 1e-12);
  }

  void check_use(FaceId f, const EdgeUse& use) {
    const ModelFace& face = model_.faces[f];
    const ModelEdge& edge = model_.edges[use.edge];
    double worst = 0;
    for (int i = 0; i < options_.samples; ++i) {
      const double t = edge.low + (edge.high - edge.low) * i / (options_.samples - 1);
      const Vec3 on_face = face.surface->value(use.curve->value(t));
      const Vec3 on_edge = edge.degenerate ? model_.vertices[edge.start].point : edge.curve->value(t);
      const double off = distance(on_face, on_edge);
      if (!std::isfinite(off))
        return add(ModelFault::Kind::not_finite, face_entity(f), "is not finite on " + edge_entity(use.edge));
      worst = std::max(worst, off);
    }
    double tolerance = std::max(edge.tolerance, face.tolerance);
    if (edge.degenerate) tolerance = std::max(tolerance, model_.vertices[edge.start].tolerance);
    if (worst > allowed(tolerance)) {
      add(ModelFault::Kind::curve_off, face_entity(f), edge_entity(use.edge) + " does not lie on it", worst);
    }
  }

  void check_edge(EdgeId e) {
    const ModelEdge& edge = model_.edges[e];
    if (edge.degenerate) return;
    const auto check = [&](double t, CadVertexId v) {
      const double off = distance(edge.curve->value(t), model_.vertices[v].point);
      if (std::isfinite(off) && off <= allowed(std::max(edge.tolerance, model_.vertices[v].tolerance))) return;
      add(ModelFault::Kind::vertex_off, edge_entity(e),
          "ends off vertex " + std::to_string(model_.vertices[v].label.cad_id), off);
    };
    check(edge.low, edge.start);
    check(edge.high, edge.end);
  }

  /// Around a solid each edge is used as often in one direction as in the other (seen from outside of the solid).
  void check_solid(SolidId s) {
    std::map<EdgeId, int> balance;
    for (const FaceId f : model_.solids[s].faces) {
      const ModelFace& face = model_.faces[f];
      if (face.front == face.back) continue;
      const int side = (face.back == s ? 1 : -1) * (face.reversed ? -1 : 1);
      for (const Loop& loop : face.loops) {
        for (const EdgeUse& use : loop.uses) {
          if (!model_.edges[use.edge].degenerate) balance[use.edge] += use.reversed ? -side : side;
        }
      }
    }
    for (const auto& [edge, sum] : balance) {
      if (sum == 0) continue;
      add(ModelFault::Kind::solid_open, "solid " + std::to_string(model_.solids[s].label.cad_id),
          "is not closed or not oriented at " + edge_entity(edge));
      return;
    }
  }

  const Model& model_;
  const CheckOptions& options_;
  double floor_;
  std::vector<ModelFault> faults_;
};

}  // namespace

const char* name(ModelFault::Kind kind) {
  static constexpr std::array names{"reference",  "vertex_off", "curve_off",  "loop_open",
                                    "inside_out", "solid_open", "not_finite", "crosses_itself"};
  return names[static_cast<std::size_t>(kind)];
}

std::vector<ModelFault> check_model(const Model& model, const CheckOptions& options) {
  return Checker(model, options).run();
}

}  // namespace curvetet
