// Curves are sampled adaptively until length, direction and size are all nearly linear between samples; the density
// (segments per sample interval) is then summed and cut into equal shares. The turning bound enters the density itself
// rather than as a correction afterwards, so that points stay evenly spread. Kinks (turns that no sampling resolves)
// are left out of it: they would draw points to one spot. So are turns within the edge's tolerance, which are noise.

#include "boundary/curve_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace curvetet {

namespace {

constexpr double kTurnPerSegment = std::numbers::pi / 3;
constexpr double kKink = std::numbers::pi / 6;  ///< a turn left at one sample after all subdivision
constexpr double kArcOverChord = 1.4;
constexpr double kToleranceSizes = 8;  ///< turning alone asks for no segment shorter than this many tolerances
constexpr double kRounding = 0.25;     ///< a share of a segment that is not worth one more
constexpr int kSampleDepth = 8;

struct CurveSample {
  double t = 0;
  Vec3 point;
  double size = 0;
};

class CurveSampler {
 public:
  CurveSampler(const ModelEdge& edge, EdgeId id, const SizeField& sizes) : edge_(edge), id_(id), sizes_(sizes) {}

  std::vector<double> parameters() {
    sample();
    accumulate();
    const bool closed = edge_.start == edge_.end;
    const double total = shares_.back();
    const std::size_t least = closed ? 3 : 1;
    const std::size_t count = std::max(least, static_cast<std::size_t>(std::max(1.0, std::ceil(total - kRounding))));
    std::vector<double> shares;
    for (std::size_t i = 0; i <= count; ++i) {
      shares.push_back(total * static_cast<double>(i) / static_cast<double>(count));
    }
    split_bent(shares);
    std::vector<double> t;
    t.reserve(shares.size());
    for (const double share : shares) t.push_back(parameter_at(share));
    t.front() = edge_.low;
    t.back() = edge_.high;
    return strictly_rising(t, least);
  }

 private:
  CurveSample at(double t) const {
    CurveSample s{t, edge_.curve->value(t), 0};
    s.size = sizes_.at_edge(id_, s.point);
    return s;
  }

  void sample() {
    const int intervals = edge_.curve->kind() == CurveKind::line ? 2 : 32;
    samples_.push_back(at(edge_.low));
    for (int i = 1; i <= intervals; ++i) {
      const double t = i == intervals ? edge_.high : edge_.low + (edge_.high - edge_.low) * i / intervals;
      const CurveSample previous = samples_.back();
      subdivide(previous, at(t), 0);
    }
  }

  /// Appends the samples after a, up to and including b.
  void subdivide(const CurveSample& a, const CurveSample& b, int depth) {
    const CurveSample m = at(0.5 * (a.t + b.t));
    const Vec3 first = m.point - a.point, second = b.point - m.point;
    const double length = norm(first) + norm(second);
    const double smallest = std::min({a.size, m.size, b.size});
    const bool turns = norm(first) > 0 && norm(second) > 0 && angle_between(first, second) > 0.2;
    const bool uneven = std::abs(norm(first) - norm(second)) > 0.1 * length;
    const bool varies = std::abs(m.size - 0.5 * (a.size + b.size)) > 0.1 * smallest;
    const bool coarse = length > smallest || ((turns || uneven || varies) && length > 0.02 * smallest);
    // Lengths on the grid's scale are noise; straight runs are cut by length however deep that goes, within reason.
    const int limit = length > smallest ? 4 * kSampleDepth : kSampleDepth;
    if ((coarse || (turns && depth < 3)) && depth < limit && length > 1e-10) {
      subdivide(a, m, depth + 1);
      subdivide(m, b, depth + 1);
      return;
    }
    samples_.push_back(m);
    samples_.push_back(b);
  }

  void accumulate() {
    const std::size_t n = samples_.size();
    std::vector<double> turn_at(n, 0);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const Vec3 before = samples_[i].point - samples_[i - 1].point, after = samples_[i + 1].point - samples_[i].point;
      if (norm(before) < 1e-11 || norm(after) < 1e-11) continue;
      const double turn = angle_between(before, after);
      turn_at[i] = turn < kKink ? turn : 0;
    }
    shares_.assign(n, 0);
    turns_.assign(n, 0);
    lengths_.assign(n, 0);
    for (std::size_t i = 1; i < n; ++i) {
      const CurveSample &a = samples_[i - 1], &b = samples_[i];
      const double length = distance(a.point, b.point);
      const double turn = 0.5 * ((i == 1 ? turn_at[1] : turn_at[i - 1]) + (i + 1 == n ? turn_at[i - 1] : turn_at[i]));
      lengths_[i] = lengths_[i - 1] + length;
      turns_[i] = turns_[i - 1] + turn;
      const double noise = kToleranceSizes * edge_.tolerance;
      const double turning = turn * noise > kTurnPerSegment * length ? length / noise : turn / kTurnPerSegment;
      const double wanted = std::max(0.5 * length * (1 / a.size + 1 / b.size), turning);
      // A tiny share of the parameter keeps the map from shares to parameters invertible where the curve stands still.
      shares_[i] = shares_[i - 1] + wanted + 1e-9 * (b.t - a.t) / (edge_.high - edge_.low);
    }
  }

  double interpolate(const std::vector<double>& values, double share) const {
    const auto upper = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, share);
    const auto i = static_cast<std::size_t>(upper - shares_.begin());
    const double width = shares_[i] - shares_[i - 1];
    const double fraction = width > 0 ? std::clamp((share - shares_[i - 1]) / width, 0.0, 1.0) : 0.5;
    return values[i - 1] + fraction * (values[i] - values[i - 1]);
  }

  double parameter_at(double share) const {
    const auto upper = std::upper_bound(shares_.begin() + 1, shares_.end() - 1, share);
    const auto i = static_cast<std::size_t>(upper - shares_.begin());
    const double width = shares_[i] - shares_[i - 1];
    const double fraction = width > 0 ? std::clamp((share - shares_[i - 1]) / width, 0.0, 1.0) : 0.5;
    return samples_[i - 1].t + fraction * (samples_[i].t - samples_[i - 1].t);
  }

  /// Segments that still turn too much, or whose arc is too long for the chord, are halved: equal shares can leave one
  /// where the density is ruled by size on one part and by turning on another.
  void split_bent(std::vector<double>& shares) const {
    for (int round = 0; round < 3; ++round) {
      std::vector<double> next{shares.front()};
      for (std::size_t i = 1; i < shares.size(); ++i) {
        const double turn = interpolate(turns_, shares[i]) - interpolate(turns_, shares[i - 1]);
        const double arc = interpolate(lengths_, shares[i]) - interpolate(lengths_, shares[i - 1]);
        const double chord =
            distance(edge_.curve->value(parameter_at(shares[i])), edge_.curve->value(parameter_at(shares[i - 1])));
        const bool bent = turn > 1.3 * kTurnPerSegment || arc > kArcOverChord * chord;
        if (bent && arc > std::max(1e-9, kToleranceSizes * edge_.tolerance))
          next.push_back(0.5 * (shares[i - 1] + shares[i]));
        next.push_back(shares[i]);
      }
      if (next.size() == shares.size()) return;
      shares = std::move(next);
    }
  }

  std::vector<double> strictly_rising(const std::vector<double>& t, std::size_t least) const {
    std::vector<double> rising{t.front()};
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
      if (t[i] > rising.back() && t[i] < t.back()) rising.push_back(t[i]);
    }
    rising.push_back(t.back());
    if (rising.size() > least) return rising;
    rising.clear();
    for (std::size_t i = 0; i <= least; ++i) {
      rising.push_back(edge_.low + (edge_.high - edge_.low) * static_cast<double>(i) / static_cast<double>(least));
    }
    return rising;
  }

  const ModelEdge& edge_;
  EdgeId id_;
  const SizeField& sizes_;
  std::vector<CurveSample> samples_;
  std::vector<double> shares_, turns_, lengths_;  ///< up to each sample
};

bool in_use(const ModelEdge& edge) { return !edge.faces.empty(); }

void add_cad_vertices(const Model& model, VertexStore& vertices, BoundaryMesh& mesh) {
  mesh.cad_vertices.assign(model.vertices.size(), VertexId());
  std::vector<bool> used(model.vertices.size(), false);
  for (const ModelEdge& edge : model.edges) {
    if (in_use(edge)) used[edge.start.value()] = used[edge.end.value()] = true;
  }
  for (const ModelFace& face : model.faces) {
    for (const CadVertexId v : face.internal_vertices) used[v.value()] = true;
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    const CadVertexId v(i);
    if (used[i]) mesh.cad_vertices[v] = vertices.add(model.vertices[v].point, Owner::of(v), {}, Origin::curve_mesh);
  }
}

VertexId add_on_edge(const Model& model, EdgeId id, double t, VertexStore& vertices) {
  return vertices.add(snap(model.edges[id].curve->value(t)), Owner::of(id), {t, 0}, Origin::curve_mesh);
}

/// Of the edges with the same two ends and one segment each, all but the straightest get a second one.
void part_single_segments(const Model& model, IndexedVector<EdgeId, std::vector<double>>& parameters) {
  std::map<std::pair<CadVertexId, CadVertexId>, std::vector<EdgeId>> singles;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ModelEdge& edge = model.edges[EdgeId(i)];
    if (parameters[EdgeId(i)].size() == 2) singles[std::minmax(edge.start, edge.end)].push_back(EdgeId(i));
  }
  const auto sagitta = [&](EdgeId id) {
    const ModelEdge& edge = model.edges[id];
    const Vec3 middle = 0.5 * (edge.curve->value(edge.low) + edge.curve->value(edge.high));
    return distance(edge.curve->value(0.5 * (edge.low + edge.high)), middle);
  };
  for (const auto& [ends, edges] : singles) {
    if (edges.size() < 2) continue;
    const EdgeId straightest = *std::min_element(edges.begin(), edges.end(), [&](EdgeId a, EdgeId b) {
      return std::pair(sagitta(a), a) < std::pair(sagitta(b), b);
    });
    for (const EdgeId id : edges) {
      const ModelEdge& edge = model.edges[id];
      if (id != straightest) parameters[id] = {edge.low, 0.5 * (edge.low + edge.high), edge.high};
    }
  }
}

/// Edges in the same place get the same points, so that their chords do not cross, and at least one between their ends.
void match_twins(const Model& model, IndexedVector<EdgeId, std::vector<double>>& parameters) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ModelEdge& edge = model.edges[EdgeId(i)];
    if (!edge.twin.valid()) continue;
    const ModelEdge& other = model.edges[edge.twin];
    std::vector<double>&own = parameters[EdgeId(i)], &theirs = parameters[edge.twin];
    if (own.size() < 2 || theirs.size() < 2) continue;
    if (own.size() == 2 && theirs.size() == 2) theirs.insert(theirs.begin() + 1, 0.5 * (other.low + other.high));
    const auto copy = [](const std::vector<double>& from, double shift, double scale, const ModelEdge& to) {
      std::vector<double> t(from.size());
      std::transform(from.begin(), from.end(), t.begin(), [&](double parameter) { return shift + scale * parameter; });
      if (scale < 0) std::reverse(t.begin(), t.end());
      t.front() = to.low;
      t.back() = to.high;
      return t;
    };
    if (own.size() > theirs.size()) {
      theirs = copy(own, -edge.twin_shift / edge.twin_scale, 1 / edge.twin_scale, other);
    } else {
      own = copy(theirs, edge.twin_shift, edge.twin_scale, edge);
    }
  }
}

}  // namespace

std::vector<double> curve_parameters(const ModelEdge& edge, EdgeId id, const SizeField& sizes) {
  return CurveSampler(edge, id, sizes).parameters();
}

Status mesh_curves(const Model& model, const SizeField& sizes, VertexStore& vertices, BoundaryMesh& mesh,
                   Context& context) {
  add_cad_vertices(model, vertices, mesh);
  IndexedVector<EdgeId, std::vector<double>> parameters(model.edges.size());
  parallel_for(context, model.edges.size(), [&](std::size_t i) {
    const ModelEdge& edge = model.edges[EdgeId(i)];
    if (context.should_stop() || edge.degenerate || !in_use(edge)) return;
    ModelEdge own = edge;
    own.curve = edge.curve->clone();
    parameters[EdgeId(i)] = curve_parameters(own, EdgeId(i), sizes);
  });
  if (context.should_stop()) return context.stop_error("curve meshes");
  part_single_segments(model, parameters);
  match_twins(model, parameters);
  mesh.curves.assign(model.edges.size(), CurveMesh());
  for (std::size_t i = 0; i < model.edges.size(); ++i) {
    const EdgeId id(i);
    const std::vector<double>& t = parameters[id];
    if (t.empty()) continue;
    CurveMesh& curve = mesh.curves[id];
    curve.parameters = t;
    curve.vertices.push_back(mesh.cad_vertices[model.edges[id].start]);
    for (std::size_t k = 1; k + 1 < t.size(); ++k) curve.vertices.push_back(add_on_edge(model, id, t[k], vertices));
    curve.vertices.push_back(mesh.cad_vertices[model.edges[id].end]);
  }
  return Done{};
}

std::vector<SegmentRef> split_segments(const Model& model, std::vector<SegmentRef> segments, double floor,
                                       VertexStore& vertices, BoundaryMesh& mesh) {
  std::sort(segments.begin(), segments.end());
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  std::vector<SegmentRef> done;
  for (std::size_t i = 0; i < segments.size();) {
    const EdgeId id = segments[i].edge;
    CurveMesh& curve = mesh.curves[id];
    CurveMesh next;
    for (std::size_t k = 0; k < curve.vertices.size(); ++k) {
      next.vertices.push_back(curve.vertices[k]);
      next.parameters.push_back(curve.parameters[k]);
      if (i >= segments.size() || segments[i] != SegmentRef{id, k} || k + 1 == curve.vertices.size()) continue;
      const Vec3 a = vertices.position(curve.vertices[k]), b = vertices.position(curve.vertices[k + 1]);
      const double t = 0.5 * (curve.parameters[k] + curve.parameters[k + 1]);
      const bool room = curve.parameters[k] < t && t < curve.parameters[k + 1];
      if (room && distance(a, b) >= floor) {
        next.vertices.push_back(add_on_edge(model, id, t, vertices));
        next.parameters.push_back(t);
        done.push_back(segments[i]);
      }
      ++i;
    }
    curve = std::move(next);
    while (i < segments.size() && segments[i].edge == id) ++i;
  }
  return done;
}

}  // namespace curvetet
