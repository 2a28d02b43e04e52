// The mesher puts the node of a vertex at the vertex, so the last segment of such an edge would leave its curve by more
// than its own length explains. Bending the curve to the vertex was rejected: other programs, and a check against the
// CAD, look for nodes on the curve up to its end.
#include "geometry/loose_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/analytic.h"

namespace curvetet {

namespace {

constexpr double kLoose = 0.01;     ///< distance of an end from its vertex over the edge's length
constexpr double kTolerances = 10;  ///< and over the edge's tolerance
constexpr double kLeast = 1e-6;     ///< and over the body's diagonal
constexpr double kBeyond = -0.5;    ///< cosine between the way on and the way to the vertex
constexpr int kSamples = 16;

struct End {
  EdgeId edge;
  bool at_high = false;
  Vec3 point;
  double allowed = 0;
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

/// The new edge in one loop: where it goes, and what it replaces.
struct Place {
  FaceId face;
  std::size_t loop = 0, use = 0;  ///< of the edge that ends beside its vertex
  std::size_t neighbour = 0;      ///< use of the point edge that bridges the gap
  bool after = false;             ///< the neighbour comes after
  Vec2 from, to;                  ///< of the new edge, at the end of the curve and at the vertex
};

class LooseEnds {
 public:
  LooseEnds(Model& model, std::uint32_t& edge_label, std::uint32_t& vertex_label)
      : model_(model), edge_label_(edge_label), vertex_label_(vertex_label), ends_(model.vertices.size()) {}

  void run() {
    collect();
    for (std::size_t v = 0; v < ends_.size(); ++v) {
      const CadVertexId id(v);
      if (count_loose(id, model_.vertices[id].point) == 0) continue;
      move(id);
      for (const End& end : ends_[id])
        if (is_loose(end, model_.vertices[id].point)) extend(end, id);
    }
  }

 private:
  void collect() {
    std::vector<char> used(model_.edges.size(), 0);
    for (const ModelFace& face : model_.faces)
      for (const Loop& loop : face.loops)
        for (const EdgeUse& use : loop.uses) used[use.edge.value()] = 1;
    for (std::size_t e = 0; e < used.size(); ++e) {
      const ModelEdge& edge = model_.edges[EdgeId(e)];
      if (used[e] == 0 || edge.degenerate || edge.curve == nullptr || edge.start == edge.end) continue;
      if (!edge.start.valid() || !edge.end.valid() || !(edge.low < edge.high)) continue;
      const double allowed =
          kLoose * length_of(edge) + std::max(kLeast * model_.diagonal(), kTolerances * edge.tolerance);
      ends_[edge.start].push_back({EdgeId(e), false, edge.curve->value(edge.low), allowed});
      ends_[edge.end].push_back({EdgeId(e), true, edge.curve->value(edge.high), allowed});
    }
  }

  static bool is_loose(const End& end, Vec3 vertex) { return distance(end.point, vertex) > end.allowed; }

  std::size_t count_loose(CadVertexId id, Vec3 place) const {
    return static_cast<std::size_t>(
        std::count_if(ends_[id].begin(), ends_[id].end(), [&](const End& end) { return is_loose(end, place); }));
  }

  /// To the end of an edge where fewer are loose.
  void move(CadVertexId id) {
    ModelVertex& vertex = model_.vertices[id];
    Vec3 best = vertex.point;
    for (const End& end : ends_[id])
      if (distance(end.point, vertex.point) <= vertex.tolerance && count_loose(id, end.point) < count_loose(id, best))
        best = end.point;
    if (best == vertex.point) return;
    const double by = distance(best, vertex.point);
    note("vertex", vertex.label, fmt::format("is moved by {:.3g} to where its edges end", to_cad(by)));
    vertex.point = snap(best);
  }

  void extend(const End& end, CadVertexId id) {
    ModelEdge& edge = model_.edges[end.edge];
    const Vec3 vertex = model_.vertices[id].point;
    if (lies_beyond(edge, end, vertex)) return;
    std::vector<Place> places;
    if (!find_places(end, id, places)) return;
    const double gap = distance(end.point, vertex);
    const CadVertexId own = add_vertex(end, edge);
    const EdgeId link = add_link(end, own, id, places);
    for (const Place& place : places) put_in(place, link);
    (end.at_high ? model_.edges[end.edge].end : model_.edges[end.edge].start) = own;
    note("edge", model_.edges[end.edge].label,
         fmt::format("ends {:.3g} beside vertex {}; edge {} leads there", to_cad(gap), model_.vertices[id].label.cad_id,
                     model_.edges[link].label.cad_id));
  }

  static bool lies_beyond(const ModelEdge& edge, const End& end, Vec3 vertex) {
    const Vec3 tangent = normalized(edge.curve->second(end.at_high ? edge.high : edge.low).dt);
    const Vec3 way_on = end.at_high ? tangent : -tangent;
    return dot(way_on, normalized(vertex - end.point)) < kBeyond;
  }

  bool find_places(const End& end, CadVertexId id, std::vector<Place>& places) const {
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      const ModelFace& face = model_.faces[FaceId(f)];
      for (const EdgeUse& use : face.internal_edges)
        if (use.edge == end.edge) return false;
      for (std::size_t l = 0; l < face.loops.size(); ++l) {
        for (std::size_t u = 0; u < face.loops[l].uses.size(); ++u) {
          if (face.loops[l].uses[u].edge != end.edge) continue;
          Place place{FaceId(f), l, u, 0, false, {}, {}};
          if (!complete(place, end, id)) return false;
          places.push_back(place);
        }
      }
    }
    return !places.empty();
  }

  /// Finds where the vertex is in (u,v), apart from the end of the curve.
  bool complete(Place& place, const End& end, CadVertexId id) const {
    const ModelFace& face = model_.faces[place.face];
    const std::vector<EdgeUse>& uses = face.loops[place.loop].uses;
    const EdgeUse& use = uses[place.use];
    const ModelEdge& edge = model_.edges[end.edge];
    if (uses.size() < 2 || use.curve == nullptr) return false;
    place.after = end.at_high != use.reversed;
    place.neighbour = place.after ? (place.use + 1) % uses.size() : (place.use + uses.size() - 1) % uses.size();
    const EdgeUse& next = uses[place.neighbour];
    if (next.curve == nullptr || next.edge == end.edge) return false;
    const ModelEdge& other = model_.edges[next.edge];
    place.from = use.curve->value(end.at_high ? edge.high : edge.low);
    if (!other.degenerate || other.start != id) return false;
    place.to = next.curve->value(place.after != next.reversed ? other.high : other.low);
    return leads_to_vertex(face, place, id);
  }

  /// The new edge has a length in (u,v), and brings the face closer to the vertex.
  bool leads_to_vertex(const ModelFace& face, const Place& place, CadVertexId id) const {
    const Vec3 vertex = model_.vertices[id].point;
    const Vec3 start = face.surface->value(place.from), end = face.surface->value(place.to);
    return distance(end, vertex) < 0.5 * distance(start, vertex) && place.from != place.to;
  }

  CadVertexId add_vertex(const End& end, const ModelEdge& edge) {
    ModelVertex vertex;
    vertex.label.cad_id = ++vertex_label_;
    vertex.point = snap(end.point);
    vertex.tolerance = edge.tolerance;
    return model_.vertices.push_back(std::move(vertex));
  }

  EdgeId add_link(const End& end, CadVertexId own, CadVertexId id, const std::vector<Place>& places) {
    const Vec3 from = model_.vertices[own].point, to = model_.vertices[id].point;
    ModelEdge link;
    link.label.cad_id = ++edge_label_;
    link.curve = make_line(from, to - from);
    link.low = 0;
    link.high = 1;
    link.start = own;
    link.end = id;
    link.tolerance = model_.edges[end.edge].tolerance;
    for (const Place& place : places) {
      const Surface& surface = *model_.faces[place.face].surface;
      for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        const Vec3 on_surface = surface.value(place.from + t * (place.to - place.from));
        link.tolerance = std::max(link.tolerance, distance(on_surface, from + t * (to - from)));
      }
    }
    return model_.edges.push_back(std::move(link));
  }

  void put_in(const Place& place, EdgeId link) {
    std::vector<EdgeUse>& uses = model_.faces[place.face].loops[place.loop].uses;
    EdgeUse use;
    use.edge = link;
    use.reversed = !place.after;
    use.curve = make_parameter_line(place.from, place.to - place.from);
    uses[place.neighbour] = std::move(use);
  }

  double to_cad(double length) const { return model_.frame.length_to_cad(length); }

  void note(const char* kind, const Label& label, const std::string& what) {
    model_.healing.push_back({fmt::format("{} {}", kind, label.cad_id), what});
  }

  Model& model_;
  std::uint32_t &edge_label_, &vertex_label_;
  IndexedVector<CadVertexId, std::vector<End>> ends_;
};

}  // namespace

void mend_loose_ends(Model& model, std::uint32_t& edge_label, std::uint32_t& vertex_label) {
  LooseEnds(model, edge_label, vertex_label).run();
}

}  // namespace curvetet
