// Gmsh's MSH 2.2 in text, for programs that read nothing newer. It has no entities: their boxes and boundaries travel
// in the section of our own at the end, which other readers skip; parameters of nodes are lost.
#include <array>
#include <cstdint>
#include <vector>

#include "io/labels.h"
#include "io/writers.h"

namespace curvetet {

namespace {

void write_elements(const Mesh& mesh, const std::array<PhysicalGroups, 4>& groups, OutputFile& file) {
  std::size_t corners = 0;
  for (const std::uint32_t node : mesh.corner_nodes) corners += node == UINT32_MAX ? 0 : 1;
  file.line("$Elements");
  file.line(corners + mesh.segments.size() + mesh.triangles.size() + mesh.tets.size());
  std::size_t tag = 0;
  const auto put = [&](int dimension, int type, std::uint32_t entity, const std::uint32_t* nodes, std::size_t n) {
    file.put(++tag);
    const std::uint32_t group = groups[static_cast<std::size_t>(dimension)].tag_of_entity[entity];
    for (const std::uint32_t value :
         {static_cast<std::uint32_t>(type), 2U, group, entities_of(mesh, dimension)[entity].cad_id}) {
      file.put(' ');
      file.put(value);
    }
    for (std::size_t i = 0; i < n; ++i) {
      file.put(' ');
      file.put(std::size_t{nodes[i]} + 1);
    }
    file.put('\n');
  };
  for (std::size_t v = 0; v < mesh.corner_nodes.size(); ++v) {
    if (mesh.corner_nodes[v] != UINT32_MAX) put(0, 15, static_cast<std::uint32_t>(v), &mesh.corner_nodes[v], 1);
  }
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) put(1, 1, mesh.segment_edge[i], mesh.segments[i].data(), 2);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) put(2, 2, mesh.triangle_face[i], mesh.triangles[i].data(), 3);
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) put(3, 4, mesh.tet_solid[i], mesh.tets[i].data(), 4);
  file.line("$EndElements");
}

}  // namespace

void write_msh22(const Mesh& mesh, OutputFile& file) {
  std::array<PhysicalGroups, 4> groups;
  std::size_t n = 0;
  for (int d = 0; d < 4; ++d) {
    groups[static_cast<std::size_t>(d)] = physical_groups(entities_of(mesh, d), d);
    n += groups[static_cast<std::size_t>(d)].groups.size();
  }
  file.put("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n");
  file.line(n);
  for (int d = 0; d < 4; ++d) {
    for (const PhysicalGroup& group : groups[static_cast<std::size_t>(d)].groups) {
      file.line(d, group.tag, '"' + group.name + '"');
    }
  }
  file.put("$EndPhysicalNames\n$Nodes\n");
  file.line(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    file.line(i + 1, mesh.points[i][0], mesh.points[i][1], mesh.points[i][2]);
  }
  file.line("$EndNodes");
  write_elements(mesh, groups, file);
  file.line("$CurvetetLabels");
  for (const std::string& label : label_lines(mesh, true)) file.line(label);
  file.line("$EndCurvetetLabels");
}

}  // namespace curvetet
