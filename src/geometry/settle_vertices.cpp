// The mesher puts the node of a vertex at the vertex, so the last segment of an edge that ends beside it would leave
// its curve by more than its own length explains. Bending the curve to the vertex was rejected: other programs, and a
// check against the CAD, look for nodes on the curve up to its end. So was a short edge from the one to the other:
// where edges agree on no place, the body is at fault, and the check of the model says so.
#include "geometry/settle_vertices.h"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/check.h"

namespace curvetet {

namespace {

constexpr double kLoose = 0.01;  ///< distance of an end from its vertex over the edge's length
constexpr int kSamples = 16;

struct End {
  EdgeId edge;
  Vec3 point;
};

double length_of(const ModelEdge& edge) {
  double length = 0;
  Vec3 previous = edge.curve->value(edge.low);
  for (int i = 1; i <= kSamples; ++i) {
    const Vec3 next = edge.curve->value(edge.low + (edge.high - edge.low) * i / kSamples);
    length += distance(previous, next);
    previous = next;
  }
  return length;
}

class Settler {
 public:
  explicit Settler(Model& model) : model_(model), ends_(model.vertices.size()) {}

  void run() {
    collect();
    for (std::size_t v = 0; v < ends_.size(); ++v) settle(CadVertexId(v));
  }

 private:
  void collect() {
    std::vector<char> used(model_.edges.size(), 0);
    for (const ModelFace& face : model_.faces)
      for (const Loop& loop : face.loops)
        for (const EdgeUse& use : loop.uses) used[use.edge.value()] = 1;
    for (std::size_t e = 0; e < used.size(); ++e) {
      const ModelEdge& edge = model_.edges[EdgeId(e)];
      if (used[e] == 0 || edge.curve == nullptr || edge.start == edge.end || !(edge.low < edge.high)) continue;
      if (edge.start.valid()) ends_[edge.start].push_back({EdgeId(e), edge.curve->value(edge.low)});
      if (edge.end.valid()) ends_[edge.end].push_back({EdgeId(e), edge.curve->value(edge.high)});
    }
  }

  /// Beside `place` by more than the edge's tolerance and length explain. The length is only taken where it decides.
  bool is_loose(const End& end, Vec3 place) const {
    const ModelEdge& edge = model_.edges[end.edge];
    const CheckOptions check;
    const double gap =
        distance(end.point, place) - std::max(check.floor * model_.diagonal(), check.slack * edge.tolerance);
    return gap > 0 && gap > kLoose * length_of(edge);
  }

  std::size_t count_loose(CadVertexId id, Vec3 place) const {
    return static_cast<std::size_t>(
        std::count_if(ends_[id].begin(), ends_[id].end(), [&](const End& end) { return is_loose(end, place); }));
  }

  void settle(CadVertexId id) {
    ModelVertex& vertex = model_.vertices[id];
    std::size_t fewest = count_loose(id, vertex.point);
    if (fewest == 0) return;
    const double reach = std::min(vertex.tolerance, CheckOptions{}.largest * model_.diagonal());
    Vec3 best = vertex.point;
    for (const End& end : ends_[id]) {
      if (distance(end.point, vertex.point) > reach) continue;
      if (const std::size_t loose = count_loose(id, end.point); loose < fewest) {
        fewest = loose;
        best = end.point;
      }
    }
    if (best == vertex.point) return;
    model_.healing.push_back({fmt::format("vertex {}", vertex.label.cad_id),
                              fmt::format("is moved by {:.3g} to where its edges end",
                                          model_.frame.length_to_cad(distance(best, vertex.point)))});
    vertex.point = snap(best);
  }

  Model& model_;
  IndexedVector<CadVertexId, std::vector<End>> ends_;
};

}  // namespace

void settle_vertices(Model& model) { Settler(model).run(); }

}  // namespace curvetet
