// Counting triangles at each pair of vertices finds every way two sheets of coarse triangles can share what they must
// not: the wall of a thin tube whose circles have few points, both sides of a coarse lens, an edge drawn twice around a
// seam. The cure is always a point in the middle of what is shared; a flip would only move the trouble to the next
// pair.

#include "boundary/simplicial.h"

#include <algorithm>
#include <map>

#include "boundary/criteria.h"

namespace curvetet {

namespace {

constexpr int kRounds = 10;

struct Sided {
  std::uint64_t key;
  FaceId face;
  TriangleId triangle;
  int local;
};

/// Number of triangles that the uses of a curve declare at each of its segments.
std::size_t declared_at(const Model& model, const BoundaryMesh& mesh, EdgeId edge) {
  std::size_t count = 0;
  for (const FaceId f : model.edges[edge].faces) {
    if (mesh.faces[f].triangle_count() == 0) continue;
    std::size_t number = 0, in_loops = 0;
    for (const Loop& loop : model.faces[f].loops) in_loops += loop.uses.size();
    for (const UseRef& use : mesh.uses[f]) {
      const bool two_sided = number++ >= in_loops;
      if (use.edge == edge) count += two_sided ? 2 : 1;
    }
  }
  return count;
}

std::map<std::uint64_t, std::size_t> declared_segments(const Model& model, const BoundaryMesh& mesh) {
  std::map<std::uint64_t, std::size_t> declared;
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const CurveMesh& curve = mesh.curves[EdgeId(e)];
    if (curve.vertices.empty()) continue;
    const std::size_t count = declared_at(model, mesh, EdgeId(e));
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
      declared[edge_key(curve.vertices[i], curve.vertices[i + 1])] += count;
    }
  }
  return declared;
}

/// Whether a triangle is degenerate only by an edge along a pole.
bool at_pole(const Model& model, const BoundaryMesh& mesh, FaceId face, TriangleId t) {
  const FaceTriangle& f = mesh.faces[face].triangle(t);
  const std::array<VertexId, 3> v = mesh.faces[face].vertices(t);
  for (std::size_t i = 0; i < 3; ++i) {
    if (v[(i + 1) % 3] != v[(i + 2) % 3]) continue;
    if (f.use[i] < 0) return false;
    if (!model.edges[mesh.uses[face][static_cast<std::size_t>(f.use[i])].edge].degenerate) return false;
  }
  return true;
}

class Census {
 public:
  Census(const Model& model, const BoundaryMesh& mesh) : model_(model), mesh_(mesh) {}

  std::vector<Offence> run() {
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const FaceMesh& face = mesh_.faces[FaceId(f)];
      for (std::size_t t = 0; t < face.triangle_slots(); ++t) {
        if (face.triangle(TriangleId(t)).alive()) visit(FaceId(f), TriangleId(t));
      }
    }
    find_duplicates();
    find_miscounted();
    std::stable_sort(offences_.begin(), offences_.end(), [](const Offence& a, const Offence& b) {
      return std::pair(a.face, a.triangle) < std::pair(b.face, b.triangle);
    });
    return std::move(offences_);
  }

 private:
  void visit(FaceId face, TriangleId t) {
    const std::array<VertexId, 3> v = mesh_.faces[face].vertices(t);
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
      if (!at_pole(model_, mesh_, face, t)) {
        const int local = v[1] == v[2] ? 0 : v[2] == v[0] ? 1 : 2;
        offences_.push_back(
            {Offence::Kind::self_edge, face, t, local, v[(local + 1) % 3], v[(local + 2) % 3], {}, 0, 0});
      }
      return;
    }
    std::array<VertexId, 3> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    triangles_.push_back({sorted, {face, t}});
    for (int i = 0; i < 3; ++i) {
      sides_.push_back(
          {edge_key(v[static_cast<std::size_t>((i + 1) % 3)], v[static_cast<std::size_t>((i + 2) % 3)]), face, t, i});
    }
  }

  void find_duplicates() {
    std::sort(triangles_.begin(), triangles_.end());
    for (std::size_t i = 1; i < triangles_.size(); ++i) {
      if (triangles_[i].first != triangles_[i - 1].first) continue;
      for (const std::size_t k : {i - 1, i}) {
        const auto& [v, at] = triangles_[k];
        offences_.push_back({Offence::Kind::duplicate_triangle, at.first, at.second, 0, v[0], v[1], v[2], 2, 1});
      }
    }
  }

  void find_miscounted() {
    const auto declared = declared_segments(model_, mesh_);
    std::stable_sort(sides_.begin(), sides_.end(), [](const Sided& a, const Sided& b) { return a.key < b.key; });
    auto segment = declared.begin();
    for (std::size_t i = 0; i < sides_.size();) {
      std::size_t end = i;
      while (end < sides_.size() && sides_[end].key == sides_[i].key) ++end;
      while (segment != declared.end() && segment->first < sides_[i].key) ++segment;
      const bool on_curve = segment != declared.end() && segment->first == sides_[i].key;
      const std::size_t expected = on_curve ? segment->second : 2;
      if (end - i != expected) {
        for (std::size_t k = i; k < end; ++k) miscounted(sides_[k], end - i, expected);
      }
      i = end;
    }
  }

  void miscounted(const Sided& side, std::size_t found, std::size_t expected) {
    const std::array<VertexId, 3> v = mesh_.faces[side.face].vertices(side.triangle);
    const auto i = static_cast<std::size_t>(side.local);
    offences_.push_back({Offence::Kind::edge_count,
                         side.face,
                         side.triangle,
                         side.local,
                         v[(i + 1) % 3],
                         v[(i + 2) % 3],
                         {},
                         found,
                         expected});
  }

  const Model& model_;
  const BoundaryMesh& mesh_;
  std::vector<std::pair<std::array<VertexId, 3>, std::pair<FaceId, TriangleId>>> triangles_;
  std::vector<Sided> sides_;
  std::vector<Offence> offences_;
};

/// The triangle is still the one the offence was found at.
bool still_there(const FaceMesh& mesh, const Offence& offence) {
  if (offence.triangle.value() >= mesh.triangle_slots() || !mesh.triangle(offence.triangle).alive()) return false;
  std::array<VertexId, 3> v = mesh.vertices(offence.triangle);
  if (offence.kind == Offence::Kind::duplicate_triangle) {
    std::sort(v.begin(), v.end());
    return v == std::array<VertexId, 3>{offence.a, offence.b, offence.c};
  }
  const auto i = static_cast<std::size_t>(offence.local);
  return v[(i + 1) % 3] == offence.a && v[(i + 2) % 3] == offence.b;
}

bool insert_at(Conjoint& conjoint, FaceId face, Vec2 q) {
  const auto triangle = conjoint.boundary().faces[face].locate(q);
  return triangle && conjoint.insert_on_face(face, q, *triangle, Origin::face_mesh).ok();
}

bool cure(Conjoint& conjoint, const Offence& offence) {
  const FaceMesh& mesh = conjoint.boundary().faces[offence.face];
  if (!still_there(mesh, offence)) return false;
  const FaceTriangle t = mesh.triangle(offence.triangle);
  const std::array<Vec2, 3> q{mesh.node(t.node[0]).q, mesh.node(t.node[1]).q, mesh.node(t.node[2]).q};
  const Surface& surface = *conjoint.model().faces[offence.face].surface;
  const auto on_grid = [](Vec2 p) { return Vec2{snap(p.x), snap(p.y)}; };
  if (offence.kind != Offence::Kind::duplicate_triangle) {
    const auto i = static_cast<std::size_t>(offence.local);
    if (t.use[i] != -1) return false;
    if (insert_at(conjoint, offence.face, on_grid(0.5 * (q[(i + 1) % 3] + q[(i + 2) % 3])))) return true;
  }
  if (const auto centre = metric_centre(surface, mesh.chart, q)) {
    if (insert_at(conjoint, offence.face, *centre)) return true;
  }
  if (insert_at(conjoint, offence.face, on_grid((1.0 / 3) * (q[0] + q[1] + q[2])))) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    const VertexId a = mesh.node(t.node[(i + 1) % 3]).vertex, b = mesh.node(t.node[(i + 2) % 3]).vertex;
    const EdgeId edge = conjoint.segment_edge(a, b);
    if (edge.valid() && conjoint.split_segment(edge, a, b, Origin::face_mesh).ok()) return true;
  }
  return false;
}

}  // namespace

std::vector<Offence> find_offences(const Model& model, const BoundaryMesh& mesh) { return Census(model, mesh).run(); }

std::string describe(const Offence& offence, const Model& model) {
  std::string at = " on face " + std::to_string(model.faces[offence.face].label.cad_id) + ", vertices " +
                   std::to_string(offence.a.value()) + " " + std::to_string(offence.b.value());
  switch (offence.kind) {
    case Offence::Kind::self_edge:
      return "edge from a vertex to itself" + at;
    case Offence::Kind::duplicate_triangle:
      return "two triangles over the same vertices" + at + " " + std::to_string(offence.c.value());
    case Offence::Kind::edge_count:
      return "edge with " + std::to_string(offence.found) + " triangles instead of " +
             std::to_string(offence.expected) + at;
  }
  return at;
}

std::vector<Offence> make_simplicial(Conjoint& conjoint, const Context& context) {
  std::vector<Offence> offences = find_offences(conjoint.model(), conjoint.boundary());
  for (int round = 0; round < kRounds && !offences.empty() && !context.should_stop(); ++round) {
    bool progress = false;
    for (const Offence& offence : offences) progress = cure(conjoint, offence) || progress;
    if (!progress) break;
    offences = find_offences(conjoint.model(), conjoint.boundary());
  }
  return offences;
}

}  // namespace curvetet
