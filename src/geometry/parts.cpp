#include "geometry/parts.h"

#include <numeric>

namespace curvetet {

namespace {

/// Ids of the whole that are taken into a part, and their ids there.
template <class Key>
class Selection {
 public:
  explicit Selection(std::size_t n) : taken_(n, 0), own_(n, Key()) {}
  void take(Key id) {
    if (id.valid()) taken_[id.value()] = 1;
  }
  IndexedVector<Key, Key> number() {
    IndexedVector<Key, Key> of_whole;
    for (std::size_t i = 0; i < taken_.size(); ++i)
      if (taken_[i] != 0) own_[i] = of_whole.push_back(Key(i));
    return of_whole;
  }
  /// Invalid for what was not taken.
  Key own(Key id) const { return id.valid() ? own_[id.value()] : Key(); }

 private:
  std::vector<char> taken_;
  std::vector<Key> own_;
};

class PartMaker {
 public:
  explicit PartMaker(const Model& whole)
      : whole_(whole),
        solids_(whole.solids.size()),
        faces_(whole.faces.size()),
        edges_(whole.edges.size()),
        vertices_(whole.vertices.size()) {}

  Part make(const std::vector<SolidId>& solids) {
    select(solids);
    part_.solids = solids_.number();
    part_.faces = faces_.number();
    part_.edges = edges_.number();
    part_.vertices = vertices_.number();
    copy();
    return std::move(part_);
  }

 private:
  void select(const std::vector<SolidId>& solids) {
    for (const SolidId s : solids) {
      solids_.take(s);
      for (const FaceId f : whole_.solids[s].faces) select(whole_.faces[f], f);
    }
  }

  void select(const ModelFace& face, FaceId id) {
    faces_.take(id);
    for (const Loop& loop : face.loops)
      for (const EdgeUse& use : loop.uses) select(use.edge);
    for (const EdgeUse& use : face.internal_edges) select(use.edge);
    for (const CadVertexId v : face.internal_vertices) vertices_.take(v);
  }

  void select(EdgeId edge) {
    edges_.take(edge);
    vertices_.take(whole_.edges[edge].start);
    vertices_.take(whole_.edges[edge].end);
  }

  void copy() {
    Model& model = part_.model;
    model.frame = whole_.frame;
    model.unit = whole_.unit;
    model.file_unit = whole_.file_unit;
    model.box = whole_.box;
    for (const CadVertexId v : part_.vertices) model.vertices.push_back(whole_.vertices[v]);
    for (const EdgeId e : part_.edges) model.edges.push_back(renamed(whole_.edges[e]));
    for (const FaceId f : part_.faces) model.faces.push_back(renamed(whole_.faces[f]));
    for (const SolidId s : part_.solids) model.solids.push_back(renamed(whole_.solids[s]));
  }

  ModelEdge renamed(ModelEdge edge) const {
    edge.start = vertices_.own(edge.start);
    edge.end = vertices_.own(edge.end);
    edge.twin = edges_.own(edge.twin);
    std::vector<FaceId> faces;
    for (const FaceId f : edge.faces)
      if (faces_.own(f).valid()) faces.push_back(faces_.own(f));
    edge.faces = std::move(faces);
    return edge;
  }

  ModelFace renamed(ModelFace face) const {
    for (Loop& loop : face.loops)
      for (EdgeUse& use : loop.uses) use.edge = edges_.own(use.edge);
    for (EdgeUse& use : face.internal_edges) use.edge = edges_.own(use.edge);
    for (CadVertexId& v : face.internal_vertices) v = vertices_.own(v);
    face.front = solids_.own(face.front);
    face.back = solids_.own(face.back);
    return face;
  }

  ModelSolid renamed(ModelSolid solid) const {
    for (FaceId& f : solid.faces) f = faces_.own(f);
    return solid;
  }

  const Model& whole_;
  Selection<SolidId> solids_;
  Selection<FaceId> faces_;
  Selection<EdgeId> edges_;
  Selection<CadVertexId> vertices_;
  Part part_;
};

}  // namespace

std::vector<std::vector<SolidId>> parts_of(const Model& model) {
  std::vector<std::size_t> leader(model.solids.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t s) {
    while (leader[s] != s) s = leader[s] = leader[leader[s]];
    return s;
  };
  for (const ModelFace& face : model.faces) {
    if (!face.front.valid() || !face.back.valid()) continue;
    const auto [low, high] = std::minmax({find(face.front.value()), find(face.back.value())});
    leader[high] = low;
  }
  std::vector<std::vector<SolidId>> parts;
  std::vector<std::size_t> part_of(leader.size());
  for (std::size_t s = 0; s < leader.size(); ++s) {
    const std::size_t first = find(s);
    if (first == s) {
      part_of[s] = parts.size();
      parts.emplace_back();
    }
    parts[part_of[first]].emplace_back(s);
  }
  return parts;
}

Part make_part(const Model& whole, const std::vector<SolidId>& solids) { return PartMaker(whole).make(solids); }

}  // namespace curvetet
