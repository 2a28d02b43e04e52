// Gaps: the distance from a sample of the boundary to the nearest other sheet in front of it or behind it.
//
// An element of size h on a sheet of curvature kappa leaves it by kappa h^2 / 8, along the normal. Kept to a quarter of
// the gap on both sides, two sheets use up half of it: h <= sqrt(2 gap / kappa). So only gaps below kappa h^2 / 2 can
// lower the size h that is there already, which is a short reach; that is what makes the search fast. A flat face needs
// nothing: its triangles do not leave it, and the other sheet's curvature counts at the other sheet's own samples.
// Faces are looked at from the nearest on, and what one demands shortens the reach for the next.
//
// Sheets are met through patches (cells of a face's (u,v) box with a box in space): every patch of a curved face looks
// for patches within reach, splits down to the size that is there, and projects its middle onto the other surface. Thus
// a gap much smaller than the spacing of samples is found, and measured exactly. From there the closest pair is
// approached by projecting to and fro, and both sheets are given what the gap demands of them. A patch that demands a
// size smaller than itself is split and asked again, so that a thin line (an eccentric bore) is followed at its own
// spacing.
//
// What is not a gap: the sample's own neighbourhood (the direction to the foot must be within 60 degrees of the
// normals, and on the same face the way along the surface must be several times the way through space); a face that
// shares an edge or a vertex, within one element of it, since meshes that share their segments there do not cross, and
// a wedge would otherwise be refined without end; a contact, where the distance is within the CAD's tolerances and no
// size would open it.
//
// Rejected: shrinking balls on the samples alone. They see only samples, so these would have to be as dense as the gap
// is thin, which is the over-refinement that this room is to prevent.

#include "sizing/gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/box_tree.h"
#include "sizing/closest_pair.h"

namespace curvetet::sizing {

namespace {

constexpr double kFacing = 0.5;             ///< cosine between the normals and the direction across the gap
constexpr double kFold = 3;                 ///< way along the same face against the way through space
constexpr double kSteepest = 0.5;           ///< gap over distance to a shared edge, above which a wedge is no gap
constexpr int kToAndFro = 4;                ///< projections towards the closest pair
constexpr double kContact = 1e-6;           ///< of the body's diagonal: closer sheets are meant to touch
constexpr std::size_t kNearestPatches = 2;  ///< of each face that a sample is projected from
constexpr double kWallWidths = 10;          ///< size over the width of a wall
constexpr double kLeastWallSize = 0.2;      ///< of the size asked, below which no wall goes for its angles
constexpr std::size_t kBlock = 256;         ///< patches or edge samples per task
constexpr std::size_t kMostProbes = 20000;  ///< per patch, or stretch between two samples of an edge

/// The size at which the chord height is a quarter of the gap.
double gap_size(double gap, double curvature) { return std::sqrt(2 * gap / curvature); }

/// The size at which tets through a wall have no angle below about five degrees, but at least a share of the size
/// asked.
double wall_size(double gap, double asked) { return std::max(kWallWidths * gap, kLeastWallSize * asked); }

/// Gaps wider than this demand nothing of an element of this size; beyond the radius a chord height means nothing.
double reach_of(double curvature, double size) { return std::min(0.5 * curvature * size * size, 0.5 / curvature); }

/// Edges and vertices of each face, ascending.
struct FaceBorder {
  std::vector<EdgeId> edges;
  std::vector<EdgeId> seams;
  std::vector<CadVertexId> vertices;
};

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

std::vector<FaceBorder> borders(const Model& model) {
  std::vector<FaceBorder> result(model.faces.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    FaceBorder& border = result[i];
    const auto add = [&](const EdgeUse& use) {
      const ModelEdge& edge = model.edges[use.edge];
      border.edges.push_back(use.edge);
      if (use.seam) border.seams.push_back(use.edge);
      border.vertices.push_back(edge.start);
      border.vertices.push_back(edge.end);
    };
    const ModelFace& face = model.faces[FaceId(i)];
    for (const Loop& loop : face.loops)
      for (const EdgeUse& use : loop.uses) add(use);
    for (const EdgeUse& use : face.internal_edges) add(use);
    sort_unique(border.edges);
    sort_unique(border.seams);
    sort_unique(border.vertices);
  }
  return result;
}

/// What all tasks share.
struct Scene {
  const GapInput& input;
  std::vector<FaceBorder> borders;
  std::vector<const Patch*> patches;
  BoxTree tree;
};

/// Where a chord could leave the boundary: a point of a face or edge, and the direction in which it bends.
struct Probe {
  Vec3 point, axis;
  double curvature = 0;
  double size = 0;  ///< of the field
  FaceId face;      ///< invalid for a point of an edge
  EdgeId edge;
  Vec2 uv;
};

struct Foot {
  Vec3 point;
  Vec2 uv;
  double gap = 0;
};

/// Two features of the boundary that both faces, or the edge and the face, have in common.
struct Shared {
  std::vector<EdgeId> edges;
  std::vector<CadVertexId> vertices;
};

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A face within reach of a probe, with those of its patches that are nearest by their middles, and their distances.
struct NearFace {
  using Ranked = std::pair<double, std::uint32_t>;
  FaceId face;
  double away = 0;  ///< of its nearest box
  std::array<Ranked, kNearestPatches> nearest;

  NearFace(FaceId id, double distance) : face(id), away(distance) {
    nearest.fill({std::numeric_limits<double>::infinity(), kNone});
  }
  void keep(Ranked patch) {
    for (Ranked& slot : nearest)
      if (patch < slot) std::swap(patch, slot);
  }
};

/// How far a point is outside of a box, along the axis where that is most.
double outside(const Box3& box, Vec3 p) {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max({most, box.low[i] - p[i], p[i] - box.high[i]});
  return most;
}

/// One task's search. Owns its evaluators.
class GapSearch {
 public:
  explicit GapSearch(const Scene& scene)
      : scene_(scene), faces_(scene.input.model.faces.size()), slot_of_(faces_.size(), kNone) {}

  void search(const Patch& patch) {
    std::vector<std::uint32_t> candidates;
    if (!curved(patch)) return;
    const double reach = 2 * reach_of(patch.curvature, size_at(patch));
    scene_.tree.overlaps(grown(patch.box, reach), candidates);
    probes_ = 0;
    search(patch, candidates);
  }

  /// The stretch of an edge between two neighbouring samples.
  void search(EdgeId id, const EdgeSample& from, const EdgeSample& to) {
    const double curvature = std::max(from.curvature, to.curvature);
    if (!(curvature > 0)) return;
    const SizeField& field = scene_.input.field;
    const double size = std::max(field.at_edge(id, from.point), field.at_edge(id, to.point));
    Box3 box;
    box.extend(from.point);
    box.extend(to.point);
    const double length = distance(from.point, to.point);
    std::vector<std::uint32_t> candidates;
    const double reach = 2 * reach_of(curvature, size) + 0.125 * curvature * length * length;
    scene_.tree.overlaps(grown(box, reach), candidates);
    const ModelEdge& edge = scene_.input.model.edges[id];
    std::erase_if(candidates, [&](std::uint32_t i) {
      return std::binary_search(edge.faces.begin(), edge.faces.end(), scene_.patches[i]->face);
    });
    if (candidates.empty()) return;
    const auto curve = edge.curve->clone();
    probes_ = 0;
    search(id, *curve, from, to, candidates);
  }

  std::vector<SizeSource> take() { return std::move(sources_); }

 private:
  const FaceBending& bending_of(FaceId face) {
    auto& slot = faces_[face.value()];
    if (!slot) slot = std::make_unique<FaceBending>(scene_.input.model, face, scene_.input.options);
    return *slot;
  }

  double size_at(const Patch& patch) const { return scene_.input.field.at_face(patch.face, patch.point); }
  double least_size() const { return std::max(scene_.input.options.min_size, 1e-4 * scene_.input.options.size); }

  static bool curved(const Patch& patch) { return patch.curvature > 0 && norm2(patch.normal) > 0; }

  void search(const Patch& patch, const std::vector<std::uint32_t>& candidates) {
    if (!curved(patch) || ++probes_ > kMostProbes) return;
    const double size = size_at(patch);
    const double reach = 2 * reach_of(patch.curvature, size);
    std::vector<std::uint32_t> near;
    for (const std::uint32_t i : candidates)
      if (boxes_within(scene_.patches[i]->box, patch.box, reach)) near.push_back(i);
    std::erase_if(near, [&](std::uint32_t i) { return is_own_neighbourhood(patch, *scene_.patches[i]); });
    if (near.empty()) return;
    double demand = size;
    if (scene_.input.domains[patch.face.value()]->inside(patch.middle()))
      demand = std::min(
          demand,
          ask({patch.point, patch.normal, patch.curvature, size, patch.face, EdgeId(), patch.middle()}, near, &patch));
    if (patch.extent() <= spacing(scene_.input.options) * std::max(demand, least_size())) return;
    const auto [one, two] = halves(patch);
    for (const auto& [low, high] : {one, two})
      if (scene_.input.domains[patch.face.value()]->meets(low, high))
        search(measure_patch(patch.face, bending_of(patch.face), low, high), near);
  }

  void search(EdgeId id, const Curve& curve, const EdgeSample& from, const EdgeSample& to,
              const std::vector<std::uint32_t>& candidates) {
    if (++probes_ > kMostProbes) return;
    const EdgeSample middle = sample_curve(curve, 0.5 * (from.t + to.t));
    if (!(middle.curvature > 0)) return;
    const double size = scene_.input.field.at_edge(id, middle.point);
    const double demand =
        ask({middle.point, middle.towards, middle.curvature, size, FaceId(), id, {}}, candidates, nullptr);
    const double length = distance(from.point, middle.point) + distance(middle.point, to.point);
    if (length <= spacing(scene_.input.options) * std::max(demand, least_size())) return;
    search(id, curve, from, middle, candidates);
    search(id, curve, middle, to, candidates);
  }

  static bool boxes_within(const Box3& a, const Box3& b, double reach) {
    for (int i = 0; i < 3; ++i)
      if (a.low[i] > b.high[i] + reach || b.low[i] > a.high[i] + reach) return false;
    return true;
  }

  /// Patches of one face that follow each other along the surface rather than face each other.
  bool is_own_neighbourhood(const Patch& a, const Patch& b) {
    if (a.face != b.face) return false;
    if (dot(a.normal, b.normal) < -0.2) return false;
    const Surface& surface = bending_of(a.face).surface();
    const Vec2 step{shortest(b.middle().x - a.middle().x, surface.period_u()),
                    shortest(b.middle().y - a.middle().y, surface.period_v())};
    const double least = kFold * distance(a.point, b.point) + a.extent() + b.extent();
    if (way_along(a, step) <= 0.5 * least && way_along(b, step) <= 0.5 * least) return true;  // no need to measure
    double way = 0;
    Vec3 last = a.point;
    for (int i = 1; i <= 4; ++i) {
      const Vec3 next = surface.value(a.middle() + (0.25 * i) * step);
      way += distance(last, next);
      last = next;
    }
    return way <= least;
  }

  /// Length of a step in (u,v), by the scale of the patch.
  static double way_along(const Patch& patch, Vec2 step) {
    const Vec2 cell = patch.high - patch.low;
    return std::hypot(step.x / cell.x * patch.length_u, step.y / cell.y * patch.length_v);
  }

  static double shortest(double step, double period) {
    return period > 0 ? step - period * std::nearbyint(step / period) : step;
  }

  /// Sorts the candidates within reach of a point by their faces, the nearest face first.
  void sort_by_face(Vec3 point, double reach, const std::vector<std::uint32_t>& candidates) {
    near_.clear();
    for (const std::uint32_t i : candidates) {
      const Patch& patch = *scene_.patches[i];
      const double away = outside(patch.box, point);
      if (away > reach) continue;
      std::uint32_t& slot = slot_of_[patch.face.value()];
      if (slot == kNone) {
        slot = static_cast<std::uint32_t>(near_.size());
        near_.emplace_back(patch.face, away);
      }
      near_[slot].away = std::min(near_[slot].away, away);
      near_[slot].keep({distance(patch.point, point), i});
    }
    for (const NearFace& face : near_) slot_of_[face.face.value()] = kNone;
    std::sort(near_.begin(), near_.end(),
              [](const NearFace& a, const NearFace& b) { return std::tie(a.away, a.face) < std::tie(b.away, b.face); });
  }

  /// Looks from the probe at each face among the candidates; returns the least size demanded at the probe, or near it.
  /// What a near face demands leaves nothing for those that are farther than such elements can reach.
  double ask(const Probe& probe, const std::vector<std::uint32_t>& candidates, const Patch* patch) {
    sort_by_face(probe.point, 2 * reach_of(probe.curvature, probe.size), candidates);
    double demand = probe.size;
    for (const NearFace& other : near_) {
      if (other.away > 2 * reach_of(probe.curvature, demand)) break;
      if (is_near_shared(probe, other.face, probe.size)) continue;
      std::optional<Foot> last;
      for (const auto& [away, i] : other.nearest) {
        if (i == kNone) continue;
        const auto foot = foot_on(probe.point, other.face, scene_.patches[i]->middle());
        if (!foot || (last && distance(last->point, foot->point) <= 1e-3 * foot->gap)) continue;
        last = foot;
        if (is_gap(probe, other.face, *foot)) demand = std::min(demand, look_at(probe, other.face, *foot, patch));
      }
    }
    return demand;
  }

  double look_at(const Probe& probe, FaceId other, const Foot& foot, const Patch* patch) {
    if (patch && meets_nearby(probe, other, foot)) return probe.size;
    double demand = emit(probe, other, foot);
    if (!patch) return demand;
    const auto closest = closest_pair(probe, other, foot, patch->extent());
    if (!closest || !(closest->second.gap < 0.99 * foot.gap)) return demand;
    const auto& [there, there_foot] = *closest;
    // Further away other patches are closer to it.
    if (distance(there.point, probe.point) > patch->extent() || !is_gap(there, other, there_foot)) return demand;
    const double least = emit(there, other, there_foot);
    const double grading = scene_.input.options.grading;
    return std::min(demand, least + grading * distance(there.point, probe.point));
  }

  /// Do the two faces cross or touch within one element of the probe?
  bool meets_nearby(const Probe& probe, FaceId other, const Foot& foot) {
    const auto pair = meeting_point(bending_of(probe.face).surface(), bending_of(other).surface(), {probe.uv, foot.uv},
                                    contact(probe, other), probe.size);
    if (!pair) return false;
    const TrimmedDomain& here = *scene_.input.domains[probe.face.value()];
    const TrimmedDomain& there = *scene_.input.domains[other.value()];
    return here.inside(here.lifted(pair->one)) && there.inside(there.lifted(pair->two));
  }

  /// The closest point of a face's surface, if it is on the trimmed face or off it by less than the gap explains.
  std::optional<Foot> foot_on(Vec3 point, FaceId face, Vec2 guess) {
    const Surface& surface = bending_of(face).surface();
    const auto uv = surface.project(point, guess);
    if (!uv) return std::nullopt;
    const TrimmedDomain& domain = *scene_.input.domains[face.value()];
    Foot foot;
    foot.uv = domain.lifted(*uv);
    const SurfaceFirst s = surface.first(foot.uv);
    foot.point = s.value;
    foot.gap = distance(point, foot.point);
    if (!std::isfinite(foot.gap)) return std::nullopt;
    if (!domain.inside(foot.uv) && !domain.is_near_boundary(foot.uv, {norm(s.du), norm(s.dv)}, 0.5 * foot.gap))
      return std::nullopt;
    return foot;
  }

  /// From a probe and its foot on another face to the closest pair of the two surfaces, if it is elsewhere.
  std::optional<std::pair<Probe, Foot>> closest_pair(Probe probe, FaceId other, Foot foot, double furthest) {
    const Vec3 across = (1 / foot.gap) * (foot.point - probe.point);
    if (std::abs(dot(across, probe.axis)) > 1 - 1e-5) return std::nullopt;  // closest already
    const FaceBending& bend = bending_of(probe.face);
    const auto pair = approach(bend.surface(), bending_of(other).surface(), {probe.uv, foot.uv}, furthest);
    const TrimmedDomain& here = *scene_.input.domains[probe.face.value()];
    const TrimmedDomain& there = *scene_.input.domains[other.value()];
    probe.uv = here.lifted(pair.one);
    foot.uv = there.lifted(pair.two);
    if (!here.inside(probe.uv) || !there.inside(foot.uv)) return std::nullopt;
    const SurfaceBending at = bending(bend.surface(), probe.uv);
    probe.point = at.point;
    probe.axis = at.normal;
    probe.curvature = bend.effective_curvature(at);
    probe.size = scene_.input.field.at_face(probe.face, probe.point);
    foot.point = bending_of(other).surface().value(foot.uv);
    foot.gap = distance(probe.point, foot.point);
    return std::pair{probe, foot};
  }

  /// Sheets this close are meant to touch.
  double contact(const Probe& probe, FaceId other) const {
    const Model& model = scene_.input.model;
    const double own = probe.face.valid() ? model.faces[probe.face].tolerance : model.edges[probe.edge].tolerance;
    return std::max(2 * (own + model.faces[other].tolerance), kContact * model.diagonal()) + 64 * kGrid;
  }

  bool is_gap(const Probe& probe, FaceId other, const Foot& foot) {
    if (foot.gap <= contact(probe, other)) return false;
    const Vec3 across = (1 / foot.gap) * (foot.point - probe.point);
    if (std::abs(dot(across, probe.axis)) < kFacing) return false;
    const Vec3 normal = bending_of(other).surface().normal(foot.uv);
    if (std::abs(dot(across, normal)) < kFacing) return false;
    return !is_near_shared(probe, other, std::max(probe.size, foot.gap / kSteepest));
  }

  const Shared& shared_with(const Probe& probe, FaceId other) {
    const std::uint32_t own = probe.face.valid() ? probe.face.value() : probe.edge.value();
    const auto [entry, inserted] = shared_.try_emplace({probe.face.valid(), own, other.value()});
    if (!inserted) return entry->second;
    Shared& shared = entry->second;
    const FaceBorder& there = scene_.borders[other.value()];
    if (probe.face == other) {
      shared.edges = there.seams;
    } else if (probe.face.valid()) {
      const FaceBorder& here = scene_.borders[probe.face.value()];
      std::set_intersection(here.edges.begin(), here.edges.end(), there.edges.begin(), there.edges.end(),
                            std::back_inserter(shared.edges));
      std::set_intersection(here.vertices.begin(), here.vertices.end(), there.vertices.begin(), there.vertices.end(),
                            std::back_inserter(shared.vertices));
    } else {
      const ModelEdge& edge = scene_.input.model.edges[probe.edge];
      for (const CadVertexId end : {edge.start, edge.end})
        if (std::binary_search(there.vertices.begin(), there.vertices.end(), end)) shared.vertices.push_back(end);
    }
    return shared;
  }

  /// Is the probe closer to an edge or vertex that it has in common with the other face?
  bool is_near_shared(const Probe& probe, FaceId other, double reach) {
    const Shared& shared = shared_with(probe, other);
    for (const CadVertexId vertex : shared.vertices)
      if (distance(probe.point, scene_.input.model.vertices[vertex].point) < reach) return true;
    for (const EdgeId edge : shared.edges)
      if (scene_.input.edges[edge.value()].is_within(probe.point, reach)) return true;
    return false;
  }

  /// Whether a solid is between a point of a face and a foot.
  bool is_wall(const Probe& probe, const Foot& foot) const {
    if (!probe.face.valid()) return false;
    const ModelFace& face = scene_.input.model.faces[probe.face];
    const bool ahead = (dot(foot.point - probe.point, probe.axis) > 0) != face.reversed;
    return (ahead ? face.front : face.back).valid();
  }

  /// Gives both sides what the gap demands of them; returns what it demands of the probe.
  double emit(const Probe& probe, FaceId other, const Foot& foot) {
    double demand = probe.size;
    const SizeField& field = scene_.input.field;
    FaceId own = probe.face;
    if (!own.valid() && !scene_.input.model.edges[probe.edge].faces.empty())
      own = scene_.input.model.edges[probe.edge].faces.front();
    const bool wall = is_wall(probe, foot);
    const auto wanted = [&](double curvature) {
      const double size = gap_size(foot.gap, curvature);
      return wall ? std::min(size, wall_size(foot.gap, scene_.input.options.size)) : size;
    };
    if (probe.curvature > 0 && gap_size(foot.gap, probe.curvature) < probe.size) {
      demand = wanted(probe.curvature);
      sources_.push_back({probe.point, demand, SizeReason::gap, own, other, foot.gap});
    }
    const FaceBending& bend = bending_of(other);
    const double curvature = bend.effective_curvature(bending(bend.surface(), foot.uv));
    // Where the other side is as sharply bent, its own samples are as dense, and find this gap themselves.
    const bool coarser = curvature < 0.5 * probe.curvature;
    if (coarser && curvature > 0 && gap_size(foot.gap, curvature) < field.at_face(other, foot.point))
      sources_.push_back({foot.point, wanted(curvature), SizeReason::gap, other, own, foot.gap});
    return demand;
  }

  const Scene& scene_;
  std::vector<std::unique_ptr<FaceBending>> faces_;
  std::map<std::tuple<bool, std::uint32_t, std::uint32_t>, Shared> shared_;
  std::vector<SizeSource> sources_;
  std::size_t probes_ = 0;
  std::vector<NearFace> near_;          ///< of the probe at hand
  std::vector<std::uint32_t> slot_of_;  ///< in near_, by face
};

Scene make_scene(const GapInput& input) {
  std::vector<const Patch*> patches;
  std::vector<Box3> boxes;
  for (const FaceSamples& samples : input.faces)
    for (const Patch& patch : samples.patches) {
      patches.push_back(&patch);
      boxes.push_back(patch.box);
    }
  return {input, borders(input.model), std::move(patches), BoxTree(boxes)};
}

/// A run of consecutive patches of the scene, or of samples of one edge.
struct Block {
  EdgeId edge;
  std::size_t begin = 0, end = 0;
};

std::vector<Block> blocks_of(const Scene& scene) {
  std::vector<Block> blocks;
  for (std::size_t begin = 0; begin < scene.patches.size(); begin += kBlock)
    blocks.push_back({EdgeId(), begin, std::min(begin + kBlock, scene.patches.size())});
  for (std::size_t i = 0; i < scene.input.edges.size(); ++i) {
    const auto& samples = scene.input.edges[i].samples;
    for (std::size_t begin = 0; begin + 1 < samples.size(); begin += kBlock)
      blocks.push_back({EdgeId(i), begin, std::min(begin + kBlock, samples.size() - 1)});
  }
  return blocks;
}

}  // namespace

std::vector<SizeSource> gap_sources(const GapInput& input, Context& context) {
  const Scene scene = make_scene(input);
  const std::vector<Block> blocks = blocks_of(scene);
  std::vector<std::vector<SizeSource>> found(blocks.size());
  parallel_for(context, blocks.size(), [&](std::size_t b) {
    if (context.should_stop()) return;
    const Block& block = blocks[b];
    GapSearch search(scene);
    for (std::size_t i = block.begin; i < block.end; ++i) {
      if (block.edge.valid()) {
        const auto& samples = input.edges[block.edge.value()].samples;
        search.search(block.edge, samples[i], samples[i + 1]);
      } else {
        search.search(*scene.patches[i]);
      }
    }
    found[b] = search.take();
  });
  std::vector<SizeSource> sources;
  for (const auto& part : found) sources.insert(sources.end(), part.begin(), part.end());
  return sources;
}

}  // namespace curvetet::sizing
