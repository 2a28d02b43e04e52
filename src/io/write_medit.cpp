// Medit's .mesh in text, as MMG and others read it. References are cad ids; names, unit and boxes travel in comments.
#include <cstdint>
#include <vector>

#include "io/labels.h"
#include "io/writers.h"

namespace curvetet {

void write_medit(const Mesh& mesh, OutputFile& file) {
  file.put("MeshVersionFormatted 2\nDimension 3\n");
  for (const std::string& label : label_lines(mesh, true)) file.line("#curvetet", label);
  file.line("Vertices");
  file.line(mesh.points.size());
  std::vector<std::uint32_t> vertex_of(mesh.points.size(), 0);  // cad id of the CAD vertex at a node
  std::size_t corners = 0;
  for (std::size_t v = 0; v < mesh.corner_nodes.size(); ++v) {
    if (mesh.corner_nodes[v] == UINT32_MAX) continue;
    vertex_of[mesh.corner_nodes[v]] = mesh.vertices[v].cad_id;
    ++corners;
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    file.line(mesh.points[i][0], mesh.points[i][1], mesh.points[i][2], vertex_of[i]);
  }
  if (corners > 0) {
    file.line("Corners");
    file.line(corners);
    for (const std::uint32_t node : mesh.corner_nodes) {
      if (node != UINT32_MAX) file.line(std::size_t{node} + 1);
    }
  }
  file.line("Edges");
  file.line(mesh.segments.size());
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    const auto& [a, b] = mesh.segments[i];
    file.line(std::size_t{a} + 1, std::size_t{b} + 1, mesh.edges[mesh.segment_edge[i]].cad_id);
  }
  file.line("Triangles");
  file.line(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    file.line(std::size_t{a} + 1, std::size_t{b} + 1, std::size_t{c} + 1, mesh.faces[mesh.triangle_face[i]].cad_id);
  }
  file.line("Tetrahedra");
  file.line(mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const auto& [a, b, c, d] = mesh.tets[i];
    file.line(std::size_t{a} + 1, std::size_t{b} + 1, std::size_t{c} + 1, std::size_t{d} + 1,
              mesh.solids[mesh.tet_solid[i]].cad_id);
  }
  file.line("End");
}

}  // namespace curvetet
