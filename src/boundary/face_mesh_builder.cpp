// Each round carries the curve meshes into the charts of all faces that changed, in parallel, and gathers which
// segments are at fault; these are split in the order of edges, and the faces on them go into the next round. Moving
// nodes apart instead of splitting was rejected: a coarse rim that swallows a hole has nothing to move.

#include "boundary/face_mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "boundary/curve_mesh.h"
#include "boundary/untangle.h"
#include "planar/segment_grid.h"

namespace curvetet {

namespace {

constexpr int kChartSamples = 8;       ///< per direction of the domain's box
constexpr int kUseSamples = 16;        ///< per use, for the chart
constexpr int kArcSamples = 5;         ///< inside of a segment, for the region between chord and arc
constexpr double kChartExtent = 0.9;   ///< the larger extent of the domain in the chart
constexpr double kLargestRatio = 1e5;  ///< of the extents of the domain in the chart
constexpr int kUntangleRounds = 16;
constexpr double kStraight = 1e-7;  ///< sagitta over length below which splitting a segment changes nothing

/// All uses of a face in the numbering of BoundaryMesh::uses.
std::vector<const EdgeUse*> all_uses(const ModelFace& face) {
  std::vector<const EdgeUse*> uses;
  for (const Loop& loop : face.loops) {
    for (const EdgeUse& use : loop.uses) uses.push_back(&use);
  }
  for (const EdgeUse& use : face.internal_edges) uses.push_back(&use);
  return uses;
}

/// Even-odd test against the sampled loops.
bool inside_loops(const std::vector<std::array<Vec2, 2>>& sides, Vec2 p) {
  bool inside = false;
  for (const auto& [a, b] : sides) {
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

struct DomainSamples {
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  std::vector<std::array<Vec2, 2>> sides;
  std::vector<Vec2> on_boundary;
  void extend(Vec2 p) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

DomainSamples sample_domain(const ModelFace& face, const Model& model) {
  DomainSamples domain;
  for (const EdgeUse* use : all_uses(face)) {
    const ModelEdge& edge = model.edges[use->edge];
    Vec2 previous = use->curve->value(edge.low);
    domain.extend(previous);
    for (int i = 1; i <= kUseSamples; ++i) {
      const Vec2 next = use->curve->value(edge.low + (edge.high - edge.low) * i / kUseSamples);
      domain.extend(next);
      if (!use->internal) domain.sides.push_back({previous, next});
      if (i % 4 == 0) domain.on_boundary.push_back(next);
      previous = next;
    }
  }
  if (!(domain.low.x <= domain.high.x)) {
    domain.extend(face.low);
    domain.extend(face.high);
  }
  return domain;
}

/// Mean lengths of the derivatives over the trimmed domain.
Vec2 mean_speeds(const Surface& surface, const DomainSamples& domain) {
  Vec2 sum{};
  int count = 0;
  const auto add = [&](Vec2 uv) {
    const SurfaceFirst at = surface.first(uv);
    const double du = norm(at.du), dv = norm(at.dv);
    if (!std::isfinite(du) || !std::isfinite(dv)) return;
    sum = sum + Vec2{du, dv};
    ++count;
  };
  for (int i = 0; i < kChartSamples; ++i) {
    for (int j = 0; j < kChartSamples; ++j) {
      const Vec2 uv{domain.low.x + (domain.high.x - domain.low.x) * (i + 0.5) / kChartSamples,
                    domain.low.y + (domain.high.y - domain.low.y) * (j + 0.5) / kChartSamples};
      if (inside_loops(domain.sides, uv)) add(uv);
    }
  }
  if (count < 4) {
    for (const Vec2 uv : domain.on_boundary) add(uv);
  }
  return count > 0 ? (1.0 / count) * sum : Vec2{1, 1};
}

/// Parameters along a degenerate edge, such that the surface turns by one of kPoleSteps of a turn around the pole from
/// one to the next at most: on a sharp cone its normal does, on a flat one the direction away from the pole. With a
/// node at each of its ends alone, no triangulation of the chart could show the triangles around the pole: their order
/// around an end is not their order around the pole.
std::vector<double> pole_parameters(const Surface& surface, const EdgeUse& use, const ModelEdge& edge) {
  const auto at = [&](int i, int n) { return i == n ? edge.high : edge.low + (edge.high - edge.low) * i / n; };
  double turn = 0;
  Vec3 previous{};
  for (int i = 0; i <= kUseSamples; ++i) {
    const Vec2 uv = use.curve->value(at(i, kUseSamples));
    const SurfaceFirst first = surface.first(uv);
    const Vec3 inwards = normalized(norm2(first.du) > norm2(first.dv) ? first.du : first.dv);
    const Vec3 around = cross(surface.normal(uv), inwards);
    if (i > 0) turn += angle_between(previous, around);
    previous = around;
  }
  const double wanted = std::ceil(turn / (2 * std::numbers::pi / kPoleSteps) - 1e-6);
  const int segments = std::isfinite(wanted) ? static_cast<int>(std::clamp(wanted, 1.0, 2.0 * kPoleSteps)) : 1;
  std::vector<double> t;
  for (int i = 0; i <= segments; ++i) t.push_back(at(i, segments));
  return t;
}

struct FaceRound {
  std::vector<LoopFault> faults;
  std::vector<SegmentRef> split;
  bool built = false;
};

/// One face in one round.
class FaceBuilder {
 public:
  FaceBuilder(const Model& model, FaceId id, const BoundaryMesh& mesh, double chart_per_length)
      : model_(model),
        face_(model.faces[id]),
        mesh_(mesh),
        uses_(all_uses(face_)),
        chart_per_length_(chart_per_length) {}

  FaceRound run(FaceMesh& mesh, bool last_round) {
    chart_ = mesh.chart;
    FaceRound round;
    FaceInput input = assemble();
    if (!last_round) {
      find_crowded_arcs(input, round.split);
      if (!round.split.empty()) return round;
    }
    round.faults = mesh.build(input);
    const auto tolerance = [this](std::int32_t use) { return true_tolerance(*uses_[static_cast<std::size_t>(use)]); };
    for (int k = 0; k < kUntangleRounds && !round.faults.empty(); ++k) {
      if (!untangle(round.faults, *face_.surface, chart_, tolerance, input)) break;
      round.faults = mesh.build(input);
    }
    round.built = round.faults.empty();
    for (const LoopFault& fault : round.faults) request(fault, round.split);
    return round;
  }

 private:
  struct Side {
    std::int32_t use;
    std::size_t segment;  ///< in its chain
    Vec2 a, b;
    std::array<Vec2, kArcSamples> arc;
    double sagitta;
  };

  double use_tolerance(const EdgeUse& use) const {
    const ModelEdge& edge = model_.edges[use.edge];
    return std::max({edge.tolerance, model_.vertices[edge.start].tolerance, model_.vertices[edge.end].tolerance});
  }

  /// Not all that the CAD says of its tolerances is true: at least the distance of the curve to its place on the face.
  double true_tolerance(const EdgeUse& use) const {
    const ModelEdge& edge = model_.edges[use.edge];
    double tolerance = use_tolerance(use);
    for (int i = 0; i <= kUseSamples && !edge.degenerate; ++i) {
      const double t = edge.low + (edge.high - edge.low) * i / kUseSamples;
      tolerance = std::max(tolerance, distance(edge.curve->value(t), face_.surface->value(use.curve->value(t))));
    }
    return tolerance;
  }

  std::vector<double> parameters_of(const EdgeUse& use) const {
    const ModelEdge& edge = model_.edges[use.edge];
    return edge.degenerate ? pole_parameters(*face_.surface, use, edge) : mesh_.curves[use.edge].parameters;
  }

  ChainInput chain_of(std::int32_t number) const {
    const EdgeUse& use = *uses_[static_cast<std::size_t>(number)];
    const ModelEdge& edge = model_.edges[use.edge];
    ChainInput chain;
    chain.use = number;
    std::vector<double> t = parameters_of(use);
    chain.vertices = mesh_.curves[use.edge].vertices;
    if (edge.degenerate) chain.vertices.assign(t.size(), mesh_.cad_vertices[edge.start]);
    if (use.reversed) {
      std::reverse(t.begin(), t.end());
      std::reverse(chain.vertices.begin(), chain.vertices.end());
    }
    for (const double s : t) chain.q.push_back(chart_.to_chart(use.curve->value(s)));
    return chain;
  }

  FaceInput assemble() {
    FaceInput input;
    std::int32_t number = 0;
    for (const Loop& loop : face_.loops) {
      LoopInput chains;
      for (std::size_t i = 0; i < loop.uses.size(); ++i) chains.chains.push_back(chain_of(number++));
      input.loops.push_back(std::move(chains));
    }
    for (std::size_t i = 0; i < face_.internal_edges.size(); ++i) {
      LoopInput open;
      open.open = true;
      open.chains.push_back(chain_of(number++));
      open.chains.back().two_sided = true;
      input.loops.push_back(std::move(open));
    }
    for (std::size_t i = 0; i < face_.internal_vertices.size(); ++i) {
      input.isolated.push_back(
          {mesh_.cad_vertices[face_.internal_vertices[i]], chart_.to_chart(face_.internal_vertex_uv[i])});
    }
    join(input);
    return input;
  }

  /// Ends of chains at the same CAD vertex that the tolerances cannot tell apart become one chart point.
  void join(FaceInput& input) const {
    std::map<VertexId, std::vector<Vec2>> points;
    for (LoopInput& loop : input.loops) {
      for (std::size_t c = 0; c < loop.chains.size(); ++c) {
        ChainInput& chain = loop.chains[c];
        const double near = 2 * use_tolerance(*uses_[static_cast<std::size_t>(chain.use)]) * chart_per_length_;
        if (c > 0 && loop.chains[c - 1].vertices.back() == chain.vertices.front()) {
          chain.q.front() = loop.chains[c - 1].q.back();
        } else {
          chain.q.front() = known_point(points[chain.vertices.front()], chain.q.front(), near);
        }
        const bool last = c + 1 == loop.chains.size() && !loop.open;
        if (last && loop.chains[0].vertices.front() == chain.vertices.back()) {
          chain.q.back() = loop.chains[0].q.front();
        } else {
          chain.q.back() = known_point(points[chain.vertices.back()], chain.q.back(), near);
        }
      }
    }
  }

  static Vec2 known_point(std::vector<Vec2>& points, Vec2 q, double near) {
    for (const Vec2 p : points) {
      if (distance(p, q) <= near) return p;
    }
    points.push_back(q);
    return q;
  }

  Side side_of(const ChainInput& chain, std::size_t segment) const {
    const EdgeUse& use = *uses_[static_cast<std::size_t>(chain.use)];
    Side side{chain.use, segment, chain.q[segment], chain.q[segment + 1], {}, 0};
    const std::vector<double> t = parameters_of(use);
    const double t0 = use.reversed ? t[t.size() - 1 - segment] : t[segment];
    const double t1 = use.reversed ? t[t.size() - 2 - segment] : t[segment + 1];
    const Vec2 along = side.b - side.a;
    const double length = norm(along);
    for (int i = 0; i < kArcSamples; ++i) {
      const Vec2 q = chart_.to_chart(use.curve->value(t0 + (t1 - t0) * (i + 1) / (kArcSamples + 1)));
      side.arc[static_cast<std::size_t>(i)] = q;
      const double height = length > 0 ? std::abs(cross(along, q - side.a)) / length : distance(q, side.a);
      side.sagitta = std::max(side.sagitta, height);
    }
    return side;
  }

  /// Whether p lies strictly between the chord of a side and its arc.
  static bool between(const Side& side, Vec2 p) {
    bool inside = false;
    Vec2 a = side.b;
    const auto pass = [&](Vec2 b) {
      if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
      a = b;
    };
    pass(side.a);
    for (const Vec2 q : side.arc) pass(q);
    pass(side.b);
    return inside;
  }

  /// Whether the segment cd properly crosses the arc of a side.
  static bool crosses_arc(const Side& side, Vec2 c, Vec2 d) {
    Vec2 a = side.a;
    for (std::size_t i = 0; i <= kArcSamples; ++i) {
      const Vec2 b = i == kArcSamples ? side.b : side.arc[i];
      const double sa = cross(d - c, a - c), sb = cross(d - c, b - c), sc = cross(b - a, c - a),
                   sd = cross(b - a, d - a);
      if (sa * sb < 0 && sc * sd < 0) return true;
      a = b;
    }
    return false;
  }

  /// The curved-segment invariant: asks to split every segment whose region between chord and arc holds a node, or is
  /// crossed by another segment.
  void find_crowded_arcs(const FaceInput& input, std::vector<SegmentRef>& split) const {
    std::vector<Side> sides;
    Vec2 low{1, 1}, high{-1, -1};
    for (const LoopInput& loop : input.loops) {
      for (const ChainInput& chain : loop.chains) {
        for (std::size_t i = 0; i + 1 < chain.vertices.size(); ++i) sides.push_back(side_of(chain, i));
        for (const Vec2 q : chain.q) {
          low = {std::min(low.x, q.x), std::min(low.y, q.y)};
          high = {std::max(high.x, q.x), std::max(high.y, q.y)};
        }
      }
    }
    SegmentGrid grid;
    grid.reset(low, high, sides.size());
    for (std::uint32_t i = 0; i < sides.size(); ++i) grid.add({i, i}, sides[i].a, sides[i].b);
    for (const Side& side : sides) {
      if (crowded(side, sides, grid)) request(side.use, side.segment, split);
    }
  }

  bool crowded(const Side& side, const std::vector<Side>& sides, const SegmentGrid& grid) const {
    const double tolerance = use_tolerance(*uses_[static_cast<std::size_t>(side.use)]) * chart_per_length_;
    if (side.sagitta <= std::max(1e-4 * distance(side.a, side.b), tolerance)) return false;
    Vec2 low = side.a, high = side.a;
    const auto extend = [&](Vec2 q) {
      low = {std::min(low.x, q.x), std::min(low.y, q.y)};
      high = {std::max(high.x, q.x), std::max(high.y, q.y)};
    };
    extend(side.b);
    for (const Vec2 q : side.arc) extend(q);
    bool found = false;
    grid.near(low, high, [&](SegmentGrid::Entry entry) {
      const Side& other = sides[entry.a];
      const bool joined = other.a == side.a || other.a == side.b || other.b == side.a || other.b == side.b;
      const auto holds = [&](Vec2 q) { return q != side.a && q != side.b && between(side, q); };
      found = found || holds(other.a) || holds(other.b) || (!joined && crosses_arc(side, other.a, other.b));
    });
    return found;
  }

  void request(std::int32_t use, std::size_t segment, std::vector<SegmentRef>& split) const {
    if (use < 0) return;
    const EdgeUse& u = *uses_[static_cast<std::size_t>(use)];
    if (model_.edges[u.edge].degenerate) return;
    const std::size_t segments = mesh_.curves[u.edge].vertices.size() - 1;
    split.push_back({u.edge, u.reversed ? segments - 1 - segment : segment});
  }

  void request(const LoopFault& fault, std::vector<SegmentRef>& split) const {
    if (curved(fault.use_a, fault.segment_a)) request(fault.use_a, fault.segment_a, split);
    if (curved(fault.use_b, fault.segment_b)) request(fault.use_b, fault.segment_b, split);
  }

  bool curved(std::int32_t use, std::size_t segment) const {
    if (use < 0) return false;
    const ChainInput chain = chain_of(use);
    if (segment + 1 >= chain.q.size()) return false;
    const Side side = side_of(chain, segment);
    return side.sagitta > kStraight * distance(side.a, side.b);
  }

  const Model& model_;
  const ModelFace& face_;
  const BoundaryMesh& mesh_;
  std::vector<const EdgeUse*> uses_;
  Chart chart_;
  double chart_per_length_;  ///< chart lengths are working lengths times this, on average over the face
};

Vec3 place_of(const LoopFault& fault, FaceId face, const BoundaryMesh& mesh, const VertexStore& vertices,
              const Model& model) {
  if (fault.use_a < 0) return {};
  const UseRef& ref = mesh.uses[face][static_cast<std::size_t>(fault.use_a)];
  const CurveMesh& curve = mesh.curves[ref.edge];
  if (curve.vertices.empty()) return model.vertices[model.edges[ref.edge].start].point;
  const std::size_t n = curve.vertices.size();
  const std::size_t i = ref.use->reversed ? n - 1 - std::min(n - 1, fault.segment_a) : std::min(n - 1, fault.segment_a);
  return vertices.position(curve.vertices[i]);
}

std::string describe(const LoopFault& fault, FaceId face, const BoundaryMesh& mesh, const Model& model) {
  const auto edge_of = [&](std::int32_t use) {
    return use < 0 ? std::string("-")
                   : "edge " +
                         std::to_string(model.edges[mesh.uses[face][static_cast<std::size_t>(use)].edge].label.cad_id);
  };
  return fault.what + ": " + edge_of(fault.use_a) + " segment " + std::to_string(fault.segment_a) + ", " +
         edge_of(fault.use_b) + " segment " + std::to_string(fault.segment_b);
}

void number_uses(const Model& model, BoundaryMesh& mesh) {
  mesh.uses.assign(model.faces.size(), {});
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    for (const EdgeUse* use : all_uses(model.faces[FaceId(f)])) mesh.uses[FaceId(f)].push_back({use, use->edge});
  }
}

/// Splits what a round asked for; returns the faces that felt it, ascending.
std::vector<std::size_t> split_round(const Model& model, const std::vector<std::size_t>& faces,
                                     const std::vector<FaceRound>& rounds, double floor, VertexStore& vertices,
                                     BoundaryMesh& mesh) {
  std::vector<SegmentRef> split;
  for (const std::size_t f : faces) split.insert(split.end(), rounds[f].split.begin(), rounds[f].split.end());
  std::vector<std::size_t> touched;
  for (const SegmentRef& segment : split_segments(model, std::move(split), floor, vertices, mesh)) {
    for (const FaceId face : model.edges[segment.edge].faces) touched.push_back(face.value());
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  return touched;
}

}  // namespace

ScaledChart make_chart(const ModelFace& face, const Model& model) {
  const DomainSamples domain = sample_domain(face, model);
  const Vec2 speeds = mean_speeds(*face.surface, domain);
  const Vec2 size = domain.high - domain.low;
  double extent_u = size.x * speeds.x, extent_v = size.y * speeds.y;
  const double largest = std::max({extent_u, extent_v, 1e-300});
  extent_u = std::max(extent_u, largest / kLargestRatio);
  extent_v = std::max(extent_v, largest / kLargestRatio);
  Chart chart;
  chart.centre = 0.5 * (domain.low + domain.high);
  chart.scale_u = size.x > 0 ? kChartExtent * extent_u / (largest * size.x) : 1;
  chart.scale_v = size.y > 0 ? kChartExtent * extent_v / (largest * size.y) : 1;
  return {chart, kChartExtent / largest};
}

Status build_face_meshes(const Model& model, const BoundaryOptions& options, VertexStore& vertices, BoundaryMesh& mesh,
                         std::vector<FaceFailure>& failures, Context& context) {
  const std::size_t n = model.faces.size();
  number_uses(model, mesh);
  mesh.faces.assign(n, FaceMesh());
  std::vector<double> per_length(n, 0);
  parallel_for(context, n, [&](std::size_t f) {
    if (context.should_stop()) return;
    const ScaledChart scaled = make_chart(model.faces[FaceId(f)], model);
    mesh.faces[FaceId(f)].chart = scaled.chart;
    per_length[f] = scaled.per_length;
  });
  std::vector<FaceRound> rounds(n);
  const auto build = [&](const std::vector<std::size_t>& faces, bool last) {
    parallel_for(context, faces.size(), [&](std::size_t i) {
      const FaceId face(faces[i]);
      if (context.should_stop()) return;
      rounds[faces[i]] = FaceBuilder(model, face, mesh, per_length[faces[i]]).run(mesh.faces[face], last);
    });
  };
  std::vector<std::size_t> dirty(n);
  for (std::size_t f = 0; f < n; ++f) dirty[f] = f;
  const double floor = 1e-7 * model.diagonal();
  for (int round = 0; round < options.loop_rounds && !dirty.empty(); ++round) {
    build(dirty, false);
    if (context.should_stop()) return context.stop_error("face meshes");
    dirty = split_round(model, dirty, rounds, floor, vertices, mesh);
  }
  // What is not built by now: faces whose last split came in the last round, or whose arcs stay crowded at the floor.
  std::vector<std::size_t> rest;
  for (std::size_t f = 0; f < n; ++f) {
    if (!rounds[f].built || std::binary_search(dirty.begin(), dirty.end(), f)) rest.push_back(f);
  }
  build(rest, true);
  if (context.should_stop()) return context.stop_error("face meshes");
  for (std::size_t f = 0; f < n; ++f) {
    if (rounds[f].built) continue;
    FaceFailure failure{FaceId(f), "not built", "", {}};
    if (!rounds[f].faults.empty()) {
      const LoopFault& fault = rounds[f].faults.front();
      failure.cause = fault.what;
      failure.detail = describe(fault, FaceId(f), mesh, model);
      failure.where = place_of(fault, FaceId(f), mesh, vertices, model);
    }
    mesh.faces[FaceId(f)] = FaceMesh();
    failures.push_back(std::move(failure));
  }
  return Done{};
}

}  // namespace curvetet
