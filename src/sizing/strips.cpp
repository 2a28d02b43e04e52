// Strips: a face of width w between two of its edges, with elements of size h beside it.
//
// A tet that has an edge across the strip and a facet beside it sees that edge under an angle of about w / h, whatever
// is done to it. At h = 50 w that is a degree, with which the worst of the tets there stay above half a degree. Such
// a size is asked for only where a fifth of the field's size reaches it: a strip narrower still (a sliver left by a
// Boolean operation) would be meshed as finely all along its length, which nobody who asked for coarse elements wants.
//
// What is not a strip: two edges that meet in a wide angle, near their common vertex.

#include "sizing/strips.h"

#include <algorithm>

namespace curvetet::sizing {

namespace {

constexpr double kStripWidths = 50;        ///< size over the width of a strip
constexpr double kLeastStripSize = 0.2;    ///< of the field's size, below which no strip goes
constexpr std::size_t kMostProbes = 4000;  ///< per stretch between two samples of an edge

/// An edge, and the field's sizes at its samples.
struct SizedEdge {
  EdgeId id;
  std::vector<double> sizes;
};

/// One edge of a face looking at another.
class StripSearch {
 public:
  StripSearch(const StripInput& input, FaceId face, const SizedEdge& edge, EdgeId other,
              std::vector<SizeSource>& sources)
      : input_(input),
        face_(face),
        id_(edge.id),
        other_id_(other),
        sizes_(edge.sizes),
        edge_(input.model.edges[edge.id]),
        other_(input.model.edges[other]),
        sources_(sources) {}

  void run() {
    const std::vector<EdgeSample>& samples = input_.edges[id_.value()].samples;
    const EdgeSamples& there = input_.edges[other_id_.value()];
    for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
      const double size = std::max(sizes_[i], sizes_[i + 1]);
      const double length = distance(samples[i].point, samples[i + 1].point);
      const Vec3 middle = 0.5 * (samples[i].point + samples[i + 1].point);
      if (!there.is_within(middle, size / kStripWidths + length + sag_of(there))) continue;
      if (!curve_) curve_ = edge_.curve->clone(), other_curve_ = other_.curve->clone();
      probes_ = 0;
      search(samples[i], samples[i + 1]);
    }
  }

 private:
  /// How far a curve may leave the polygon of its samples.
  double sag_of(const EdgeSamples& there) const {
    return there.samples.empty() ? 0 : 0.125 * there.length / static_cast<double>(there.samples.size());
  }

  void search(const EdgeSample& from, const EdgeSample& to) {
    if (++probes_ > kMostProbes) return;
    const EdgeSample middle = sample_curve(*curve_, 0.5 * (from.t + to.t));
    const double demand = ask(middle);
    const double length = distance(from.point, middle.point) + distance(middle.point, to.point);
    if (length <= spacing(input_.options) * demand) return;
    search(from, middle);
    search(middle, to);
  }

  /// What the strip demands at a point of the edge; the field's size if nothing.
  double ask(const EdgeSample& sample) {
    const double size = input_.field.at_edge(id_, sample.point);
    const double guess = nearest_parameter(sample.point);
    const double t = other_curve_->project(sample.point, guess, other_.low, other_.high);
    const double width = distance(other_curve_->value(t), sample.point);
    const double demand = std::max(kStripWidths * width, input_.options.min_size);
    if (!(demand < size) || demand < kLeastStripSize * size || is_wedge(sample.point, demand)) return size;
    sources_.push_back({sample.point, demand, SizeReason::narrow_face, face_, FaceId(), width});
    return demand;
  }

  double nearest_parameter(Vec3 point) const {
    const std::vector<EdgeSample>& there = input_.edges[other_id_.value()].samples;
    return std::min_element(there.begin(), there.end(),
                            [&](const EdgeSample& a, const EdgeSample& b) {
                              return norm2(a.point - point) < norm2(b.point - point);
                            })
        ->t;
  }

  /// Is the point so near a common vertex of the two edges that these meet there in more than a degree?
  bool is_wedge(Vec3 point, double reach) const {
    for (const CadVertexId end : {edge_.start, edge_.end})
      if (end.valid() && (end == other_.start || end == other_.end) &&
          distance(point, input_.model.vertices[end].point) < reach)
        return true;
    return false;
  }

  const StripInput& input_;
  FaceId face_;
  EdgeId id_, other_id_;
  const std::vector<double>& sizes_;
  const ModelEdge &edge_, &other_;
  std::vector<SizeSource>& sources_;
  std::unique_ptr<Curve> curve_, other_curve_;
  std::size_t probes_ = 0;
};

std::vector<EdgeId> edges_of(const StripInput& input, const ModelFace& face) {
  std::vector<EdgeId> edges;
  const auto add = [&](const EdgeUse& use) {
    if (input.edges[use.edge.value()].samples.size() > 1) edges.push_back(use.edge);
  };
  for (const Loop& loop : face.loops) std::for_each(loop.uses.begin(), loop.uses.end(), add);
  std::for_each(face.internal_edges.begin(), face.internal_edges.end(), add);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

SizedEdge sized(const StripInput& input, EdgeId edge) {
  SizedEdge result{edge, {}};
  for (const EdgeSample& sample : input.edges[edge.value()].samples)
    result.sizes.push_back(input.field.at_edge(edge, sample.point));
  return result;
}

}  // namespace

std::vector<SizeSource> strip_sources(const StripInput& input, Context& context) {
  std::vector<std::vector<SizeSource>> found(input.model.faces.size());
  parallel_for(context, found.size(), [&](std::size_t i) {
    const std::vector<EdgeId> edges = edges_of(input, input.model.faces[FaceId(i)]);
    for (const EdgeId id : edges) {
      const SizedEdge edge = sized(input, id);
      for (const EdgeId other : edges) {
        if (context.should_stop()) return;
        if (id != other) StripSearch(input, FaceId(i), edge, other, found[i]).run();
      }
    }
  });
  std::vector<SizeSource> sources;
  for (const auto& part : found) sources.insert(sources.end(), part.begin(), part.end());
  return sources;
}

}  // namespace curvetet::sizing
