// Checks by recounting from the triangles alone; nothing is taken from how the meshes were made.

#include "boundary/boundary_check.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "boundary/face_recovery.h"
#include "boundary/simplicial.h"
#include "boundary/vertex_fans.h"

namespace curvetet {

namespace {

std::string number(std::size_t n) { return std::to_string(n); }

void check_curves(const Model& model, const BoundaryMesh& mesh, std::vector<std::string>& faults) {
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const ModelEdge& edge = model.edges[EdgeId(e)];
    const CurveMesh& curve = mesh.curves[EdgeId(e)];
    const std::string at = "curve " + std::to_string(edge.label.cad_id) + ": ";
    if (edge.degenerate || edge.faces.empty()) {
      if (!curve.vertices.empty()) faults.push_back(at + "meshed though degenerate or unused");
      continue;
    }
    if (curve.vertices.size() < 2 || curve.vertices.size() != curve.parameters.size()) {
      faults.push_back(at + "no segments");
      continue;
    }
    if (edge.start == edge.end && curve.vertices.size() < 4)
      faults.push_back(at + "closed with less than three segments");
    for (std::size_t i = 1; i < curve.parameters.size(); ++i) {
      if (!(curve.parameters[i - 1] < curve.parameters[i])) faults.push_back(at + "parameters do not rise");
    }
    if (curve.vertices.front() != mesh.cad_vertices[edge.start] ||
        curve.vertices.back() != mesh.cad_vertices[edge.end]) {
      faults.push_back(at + "ends are not the CAD vertices");
    }
  }
}

void check_face(const Model& model, const BoundaryMesh& mesh, FaceId id, std::vector<std::string>& faults) {
  const FaceMesh& face = mesh.faces[id];
  const std::string at = "face " + std::to_string(model.faces[id].label.cad_id) + ": ";
  if (face.triangle_count() == 0) {
    faults.push_back(at + "no triangles");
    return;
  }
  for (const std::string& fault : face.check()) faults.push_back(at + fault);
  std::map<std::pair<std::int32_t, std::uint64_t>, std::size_t> sides;
  for (std::size_t t = 0; t < face.triangle_slots(); ++t) {
    const FaceTriangle& triangle = face.triangle(TriangleId(t));
    for (std::size_t i = 0; triangle.alive() && i < 3; ++i) {
      const VertexId a = face.node(triangle.node[(i + 1) % 3]).vertex, b = face.node(triangle.node[(i + 2) % 3]).vertex;
      if (triangle.use[i] != -1) ++sides[{triangle.use[i], edge_key(a, b)}];
    }
  }
  for (std::size_t u = 0; u < mesh.uses[id].size(); ++u) {
    const CurveMesh& curve = mesh.curves[mesh.uses[id][u].edge];
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
      if (!sides.contains({static_cast<std::int32_t>(u), edge_key(curve.vertices[i], curve.vertices[i + 1])})) {
        faults.push_back(at + "segment " + number(i) + " of use " + number(u) + " is not in the face mesh");
      }
    }
  }
}

/// Sides of the triangles of a solid's boundary, as the solid's outward orientation runs through them, and its volume.
void check_solid(const Model& model, const BoundaryMesh& mesh, const VertexStore& vertices, SolidId id,
                 std::vector<std::string>& faults) {
  std::map<std::pair<VertexId, VertexId>, int> balance;
  double volume = 0;
  for (const FaceId f : model.solids[id].faces) {
    const ModelFace& face = model.faces[f];
    const FaceMesh& t_ps = mesh.faces[f];
    if (t_ps.triangle_count() == 0) return;  // reported by the face
    if (face.front == face.back) continue;   // inside of the solid, or of none
    const bool along = (face.back == id) != face.reversed;
    for (std::size_t t = 0; t < t_ps.triangle_slots(); ++t) {
      if (!t_ps.triangle(TriangleId(t)).alive()) continue;
      std::array<VertexId, 3> v = t_ps.vertices(TriangleId(t));
      if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
      if (!along) std::swap(v[1], v[2]);
      volume += dot(vertices.position(v[0]), cross(vertices.position(v[1]), vertices.position(v[2]))) / 6;
      for (std::size_t i = 0; i < 3; ++i) {
        const VertexId a = v[i], b = v[(i + 1) % 3];
        balance[std::minmax(a, b)] += a < b ? 1 : -1;
      }
    }
  }
  const std::string at = "solid " + std::to_string(model.solids[id].label.cad_id) + ": ";
  const auto unbalanced = static_cast<std::size_t>(
      std::count_if(balance.begin(), balance.end(), [](const auto& entry) { return entry.second != 0; }));
  if (unbalanced > 0) faults.push_back(at + "not closed or not oriented at " + number(unbalanced) + " edges");
  if (unbalanced == 0 && !(volume > 0)) faults.push_back(at + "volume is not positive");
}

std::string owner_name(const Model& model, Owner owner) {
  switch (owner.kind) {
    case OwnerKind::vertex:
      return "vertex " + std::to_string(model.vertices[CadVertexId(owner.index)].label.cad_id);
    case OwnerKind::edge:
      return "edge " + std::to_string(model.edges[EdgeId(owner.index)].label.cad_id);
    case OwnerKind::face:
      return "face " + std::to_string(model.faces[FaceId(owner.index)].label.cad_id);
    case OwnerKind::interior:
      break;
  }
  return "the inside";
}

/// A vertex and a solid it bounds (invalid for a face of none).
using Membership = std::pair<VertexId, SolidId>;

std::vector<Membership> memberships(const Model& model, const BoundaryMesh& mesh) {
  std::vector<Membership> all;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const ModelFace& face = model.faces[FaceId(f)];
    const FaceMesh& t_ps = mesh.faces[FaceId(f)];
    for (std::size_t n = 0; n < t_ps.node_count(); ++n) {
      if (!t_ps.triangle_at(NodeId(n)).valid()) continue;
      const VertexId v = t_ps.node(NodeId(n)).vertex;
      if (face.front.valid() || !face.back.valid()) all.emplace_back(v, face.front);
      if (face.back.valid()) all.emplace_back(v, face.back);
    }
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void check_places(const Model& model, const BoundaryMesh& mesh, const VertexStore& vertices,
                  std::vector<std::string>& faults) {
  std::vector<std::tuple<SolidId, double, double, double, VertexId>> places;
  for (const auto& [v, solid] : memberships(model, mesh)) {
    const Vec3 p = vertices.position(v);
    places.emplace_back(solid, p.x, p.y, p.z, v);
  }
  std::sort(places.begin(), places.end());
  std::set<std::pair<VertexId, VertexId>> pairs;  // two solids may share the same pair
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto& [s0, x0, y0, z0, a] = places[i - 1];
    const auto& [s1, x1, y1, z1, b] = places[i];
    if (s0 != s1 || x0 != x1 || y0 != y1 || z0 != z1 || !pairs.emplace(a, b).second) continue;
    faults.push_back("vertices " + number(a.value()) + " of " + owner_name(model, vertices.owner(a)) + " and " +
                     number(b.value()) + " of " + owner_name(model, vertices.owner(b)) + " are at one place");
  }
}

}  // namespace

std::vector<std::string> check_boundary(const Model& model, const BoundaryMesh& mesh, const VertexStore& vertices) {
  std::vector<std::string> faults;
  check_curves(model, mesh, faults);
  for (std::size_t f = 0; f < model.faces.size(); ++f) check_face(model, mesh, FaceId(f), faults);
  for (const Offence& offence : find_offences(model, mesh)) faults.push_back(describe(offence, model));
  for (std::size_t s = 0; s < model.solids.size(); ++s) check_solid(model, mesh, vertices, SolidId(s), faults);
  check_places(model, mesh, vertices, faults);
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    for (const FanFault& fault : find_fan_faults(mesh.faces[FaceId(f)], facets_of(mesh.faces[FaceId(f)], FaceId(f))))
      faults.push_back("face " + std::to_string(model.faces[FaceId(f)].label.cad_id) + ": " + describe(fault));
  return faults;
}

}  // namespace curvetet
