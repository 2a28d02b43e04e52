// The mesh against the body: labels, solids beside faces, pieces, volumes, Euler characteristics.
//
// Volumes: the solid between facets and surfaces is bounded by the facets' areas times the distances of their centres,
// which for a quadratic gap is 4/3 of the truth; twice that, and what the CAD's own tolerances allow, is accepted. So
// is what the CAD's volume lacks where its faces do not reach their edges.
//
// Euler characteristic of a solid's boundary from its topology alone: each vertex and each edge of its loops counts
// once, seams included and poles' degenerate edges left out; the open face between L loops in its plane counts 2 - L,
// where loops that touch each other in a vertex are one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "geometry/enclosed_volume.h"
#include "quality/model_checks.h"

namespace curvetet::checks {
namespace {

/// Relative error of a CAD kernel's own volume of a curved body, taken generously.
constexpr double kVolumeError = 1e-3;
constexpr int kGapSamples = 32;  ///< per edge of a face

/// Model ids by cad id; looked up only.
template <class Key, class T>
std::map<std::uint32_t, Key> by_cad_id(const IndexedVector<Key, T>& entities) {
  std::map<std::uint32_t, Key> ids;
  for (std::size_t i = 0; i < entities.size(); ++i) ids.emplace(entities[Key(i)].label.cad_id, Key(i));
  return ids;
}

template <class Key, class T>
std::vector<Key> match(const char* what, const std::vector<Entity>& entities, const IndexedVector<Key, T>& of_model,
                       Severity severity, Findings& findings) {
  const std::map<std::uint32_t, Key> ids = by_cad_id(of_model);
  std::vector<Key> result;
  for (const Entity& entity : entities) {
    const auto found = ids.find(entity.cad_id);
    result.push_back(found == ids.end() ? Key() : found->second);
    if (found != ids.end()) continue;
    findings.add("label_not_in_cad", severity, [&] { return fmt::format("{} {}", what, entity.cad_id); });
  }
  return result;
}

MeshOnModel relate(const Mesh& mesh, const Model& model, double unit_scale, const Topology& topology,
                   Findings& findings) {
  MeshOnModel m{mesh, model, topology, unit_scale, 1e-6 * model.diagonal(), {}, {}, {}, {}, {}, {}, {}};
  m.solids = match("solid", mesh.solids, model.solids, Severity::error, findings);
  m.faces = match("face", mesh.faces, model.faces, Severity::error, findings);
  m.edges = match("edge", mesh.edges, model.edges, Severity::error, findings);
  // A vertex that no face of a solid uses may be in the file and is not in the model.
  m.vertices = match("vertex", mesh.vertices, model.vertices, Severity::warning, findings);
  for (const Point& p : mesh.points) m.points.push_back(model.frame.to_working((1 / unit_scale) * vec(p)));
  m.tolerance.assign(mesh.points.size(), 0);
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    const EdgeId e = m.edges[mesh.segment_edge[i]];
    if (!e.valid()) continue;
    for (const std::uint32_t v : mesh.segments[i]) m.tolerance[v] = std::max(m.tolerance[v], model.edges[e].tolerance);
  }
  for (std::size_t i = 0; i < std::min(mesh.corner_nodes.size(), m.vertices.size()); ++i) {
    const std::uint32_t node = mesh.corner_nodes[i];
    if (node == kOutside || !m.vertices[i].valid()) continue;
    m.tolerance[node] = std::max(m.tolerance[node], model.vertices[m.vertices[i]].tolerance);
  }
  m.triangles.resize(model.faces.size());
  for (const BoundaryFacet& facet : topology.boundary) {
    if (facet.triangle == kOutside) continue;
    const FaceId f = m.faces[mesh.triangle_face[facet.triangle]];
    if (f.valid()) m.triangles[f].push_back(facet.triangle);
  }
  return m;
}

void check_corners(const MeshOnModel& m, Findings& findings) {
  for (std::size_t i = 0; i < std::min(m.mesh.corner_nodes.size(), m.vertices.size()); ++i) {
    const std::uint32_t node = m.mesh.corner_nodes[i];
    if (node == kOutside || !m.vertices[i].valid()) continue;
    const ModelVertex& vertex = m.model.vertices[m.vertices[i]];
    const double d = distance(vertex.point, m.points[node]);
    if (d <= m.limit(vertex.tolerance, node)) continue;
    findings.add("corner_off_vertex", Severity::error, [&] {
      return fmt::format("node {} is {:.3g} from vertex {} at {}", node, m.to_mesh_length(d), vertex.label.cad_id,
                         place(vec(m.mesh.points[node])));
    });
  }
}

/// Every face that bounds a solid has triangles, with the solids on their sides that the CAD says.
void check_faces_and_sides(const MeshOnModel& m, Findings& findings) {
  std::vector<std::uint32_t> solid_entity(m.model.solids.size(), kOutside);
  for (std::uint32_t s = 0; s < m.solids.size(); ++s) {
    if (m.solids[s].valid()) solid_entity[m.solids[s].value()] = s;
  }
  const auto entity = [&](SolidId s) { return s.valid() ? solid_entity[s.value()] : kOutside; };
  for (const BoundaryFacet& facet : m.topology.boundary) {
    if (facet.triangle == kOutside) continue;
    const FaceId f = m.faces[m.mesh.triangle_face[facet.triangle]];
    if (!f.valid()) continue;
    const ModelFace& face = m.model.faces[f];
    const auto& v = m.mesh.triangles[facet.triangle];
    const int inversions = (v[0] > v[1] ? 1 : 0) + (v[0] > v[2] ? 1 : 0) + (v[1] > v[2] ? 1 : 0);
    const std::uint32_t front = inversions % 2 == 0 ? facet.above : facet.below;
    const std::uint32_t back = inversions % 2 == 0 ? facet.below : facet.above;
    if (front == entity(face.front) && back == entity(face.back)) continue;
    findings.add("wrong_solid_beside_face", Severity::error, [&] {
      return fmt::format("triangle {} of face {} at {}", facet.triangle, face.label.cad_id,
                         place(vec(m.mesh.points[v[0]])));
    });
  }
  for (std::uint32_t f = 0; f < m.model.faces.size(); ++f) {
    const ModelFace& face = m.model.faces[FaceId(f)];
    if (face.front == face.back || !m.triangles[FaceId(f)].empty()) continue;
    findings.add("face_without_triangles", Severity::error, [&] { return fmt::format("face {}", face.label.cad_id); });
  }
}

/// Loops of a face, those counted as one that share a vertex.
int separate_loops(const Model& model, const ModelFace& face) {
  std::map<std::uint32_t, std::size_t> first_at;  // vertex to loop
  std::vector<std::size_t> group(face.loops.size());
  int count = static_cast<int>(group.size());
  for (std::size_t i = 0; i < group.size(); ++i) {
    group[i] = i;
    for (const EdgeUse& use : face.loops[i].uses) {
      const std::size_t other = group[first_at.emplace(model.edges[use.edge].start.value(), i).first->second];
      const std::size_t own = group[i];
      if (other == own) continue;
      std::replace(group.begin(), group.begin() + static_cast<std::ptrdiff_t>(i) + 1, own, other);
      --count;
    }
  }
  return count;
}

int euler_of_solid(const Model& model, SolidId id) {
  std::set<std::uint32_t> vertices, edges, faces;
  int euler = 0;
  for (const FaceId f : model.solids[id].faces) {
    const ModelFace& face = model.faces[f];
    if (face.front == face.back || !faces.insert(f.value()).second) continue;
    euler += 2 - separate_loops(model, face);
    for (const Loop& loop : face.loops) {
      for (const EdgeUse& use : loop.uses) {
        const ModelEdge& edge = model.edges[use.edge];
        vertices.insert(edge.start.value());
        vertices.insert(edge.end.value());
        if (!edge.degenerate) edges.insert(use.edge.value());
      }
    }
  }
  return euler + static_cast<int>(vertices.size()) - static_cast<int>(edges.size());
}

/// Area between an edge's curve and where a face says it is.
double gap_area(const ModelFace& face, const ModelEdge& edge, const EdgeUse& use) {
  if (edge.degenerate || edge.curve == nullptr) return 0;
  double area = 0;
  Vec3 previous = edge.curve->value(edge.low);
  for (int i = 1; i <= kGapSamples; ++i) {
    const double t = edge.low + (edge.high - edge.low) * i / kGapSamples;
    const Vec3 point = edge.curve->value(t);
    area += distance(point, previous) * distance(point, face.surface->value(use.curve->value(t)));
    previous = point;
  }
  return area;
}

/// Kernels integrate over the faces, seen from a point within the body's box; what passes through gaps between faces
/// that do not reach their edges is missing in the CAD's own volume.
double volume_through_gaps(const Model& model, const ModelSolid& solid) {
  double area = 0;
  for (const FaceId f : solid.faces) {
    const ModelFace& face = model.faces[f];
    for (const Loop& loop : face.loops)
      for (const EdgeUse& use : loop.uses) area += gap_area(face, model.edges[use.edge], use);
  }
  return area * model.diagonal() / 3;
}

void check_solids(const MeshOnModel& m, const std::vector<double>& volumes, const std::vector<double>& slack,
                  Findings& findings) {
  for (std::uint32_t s = 0; s < m.model.solids.size(); ++s) {
    const bool there = std::find(m.solids.begin(), m.solids.end(), SolidId(s)) != m.solids.end();
    if (there) continue;
    findings.add("empty_solid", Severity::error,
                 [&] { return fmt::format("solid {}", m.model.solids[SolidId(s)].label.cad_id); });
  }
  const double length = m.unit_scale / m.model.frame.scale;
  for (std::uint32_t s = 0; s < m.solids.size(); ++s) {
    if (!m.solids[s].valid()) continue;
    const ModelSolid& solid = m.model.solids[m.solids[s]];
    const double volume = volumes[s] / (length * length * length), off = std::abs(volume - solid.volume);
    double area = 0, tolerance = 0;
    for (const FaceId f : solid.faces) {
      area += m.model.faces[f].area;
      tolerance = std::max(tolerance, m.model.faces[f].tolerance);
    }
    const double forgiven = 2 * slack[m.solids[s].value()] + area * std::max(m.least_limit, 10 * tolerance);
    const double explained = forgiven + kVolumeError * std::abs(solid.volume);
    if (solid.volume > 0 && off > explained && off > explained + volume_through_gaps(m.model, solid)) {
      const EnclosedVolume own = enclosed_volume(m.model, m.solids[s]);
      const bool is_kernel_wrong =
          std::abs(volume - own.volume) + own.error <= forgiven + kVolumeError * std::abs(own.volume);
      findings.add(is_kernel_wrong ? "cad_volume" : "volume", is_kernel_wrong ? Severity::warning : Severity::error,
                   [&] {
                     const double cubed = length * length * length;
                     return fmt::format(
                         "solid {}: {:.6g} of the mesh, {:.6g} of the CAD kernel, {:.6g} within the faces; "
                         "chord heights explain {:.3g}",
                         solid.label.cad_id, volumes[s], solid.volume * cubed, own.volume * cubed, explained * cubed);
                   });
    }
    const int expected = euler_of_solid(m.model, m.solids[s]);
    if (m.topology.euler[s] != expected) {
      findings.add("euler_characteristic", Severity::warning, [&] {
        return fmt::format("solid {}: {} of the mesh, {} of the CAD", solid.label.cad_id, m.topology.euler[s],
                           expected);
      });
    }
    if (m.topology.region_components[s] > 1) {
      findings.add("solid_in_pieces", Severity::warning, [&] {
        return fmt::format("solid {} has {} pieces", solid.label.cad_id, m.topology.region_components[s]);
      });
    }
  }
  if (m.topology.tet_components > m.model.solids.size()) {
    findings.add("more_pieces_than_solids", Severity::error,
                 [&] { return fmt::format("{} pieces, {} solids", m.topology.tet_components, m.model.solids.size()); });
  }
}

/// How often faces of a solid meet an edge; a face meets its seam, and an edge inside of it, from both sides.
std::size_t sides_at(const Model& model, SolidId solid, EdgeId edge) {
  const auto is_of_edge = [edge](const EdgeUse& use) { return use.edge == edge; };
  std::size_t sides = 0;
  for (const FaceId f : model.edges[edge].faces) {
    const ModelFace& face = model.faces[f];
    if ((face.front == solid) == (face.back == solid)) continue;
    for (const Loop& loop : face.loops)
      sides += static_cast<std::size_t>(std::count_if(loop.uses.begin(), loop.uses.end(), is_of_edge));
    if (std::any_of(face.internal_edges.begin(), face.internal_edges.end(), is_of_edge)) sides += 2;
  }
  return sides;
}

/// An edge of more than two facets of one solid is right only on a CAD edge that the solid's faces meet as often.
void check_crowded_edges(const MeshOnModel& m, Findings& findings) {
  std::map<std::array<std::uint32_t, 2>, EdgeId> segments;
  for (std::size_t i = 0; i < m.mesh.segments.size(); ++i) {
    const auto& [a, b] = m.mesh.segments[i];
    segments.emplace(std::array{std::min(a, b), std::max(a, b)}, m.edges[m.mesh.segment_edge[i]]);
  }
  for (const CrowdedEdge& edge : m.topology.crowded_edges) {
    const auto found = segments.find({edge.a, edge.b});
    const bool on_edge = found != segments.end() && found->second.valid();
    const SolidId solid = m.solids[edge.solid];
    if (on_edge && solid.valid() && sides_at(m.model, solid, found->second) >= edge.facets) continue;
    findings.add("crowded_edge", Severity::error, [&] { return describe(m.mesh, edge); });
  }
}

}  // namespace

void check_against_model(const Mesh& mesh, const Model& model, double unit_scale, const Topology& topology,
                         const std::vector<double>& volumes, Context& context, Findings& findings) {
  const MeshOnModel m = relate(mesh, model, unit_scale, topology, findings);
  check_corners(m, findings);
  check_faces_and_sides(m, findings);
  std::vector<double> slack(model.solids.size(), 0);
  check_faces(m, context, findings, slack);
  check_curves(m, context, findings);
  check_crowded_edges(m, findings);
  check_solids(m, volumes, slack, findings);
}

}  // namespace curvetet::checks
