#include "mesh_arrays.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <filesystem>
#include <vector>

#include "curvetet/formats.h"
#include "run.h"

namespace py = pybind11;

namespace curvetet::python {

namespace {

/// Rows of N numbers as an (n, N) array on the vector's own memory, which lives as long as `owner`.
template <class T, std::size_t N>
py::array view(const std::vector<std::array<T, N>>& rows, const py::object& owner) {
  py::array_t<T> array({rows.size(), N}, rows.empty() ? nullptr : rows.front().data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// The CAD's ids of the entities that the elements belong to.
py::array_t<std::uint32_t> cad_ids(const std::vector<std::uint32_t>& entity_of, const std::vector<Entity>& entities) {
  py::array_t<std::uint32_t> ids(static_cast<py::ssize_t>(entity_of.size()));
  auto out = ids.mutable_unchecked<1>();
  for (std::size_t i = 0; i < entity_of.size(); ++i) out(static_cast<py::ssize_t>(i)) = entities[entity_of[i]].cad_id;
  return ids;
}

py::list entity_list(const std::vector<Entity>& entities) {
  py::list list;
  for (const Entity& entity : entities) {
    py::dict row;
    row["id"] = entity.cad_id;
    row["name"] = entity.name;
    row["colour"] = entity.colour ? py::cast(*entity.colour) : py::none();
    row["boundary"] = entity.boundary;
    list.append(row);
  }
  return list;
}

const std::vector<Entity>& entities_of(const Mesh& mesh, int dimension) {
  return dimension == 0 ? mesh.vertices : dimension == 1 ? mesh.edges : dimension == 2 ? mesh.faces : mesh.solids;
}

py::array_t<std::uint8_t> node_dimensions(const Mesh& mesh) {
  py::array_t<std::uint8_t> dimensions(static_cast<py::ssize_t>(mesh.nodes.size()));
  auto out = dimensions.mutable_unchecked<1>();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) out(static_cast<py::ssize_t>(i)) = mesh.nodes[i].dimension;
  return dimensions;
}

py::array_t<std::uint32_t> node_entities(const Mesh& mesh) {
  py::array_t<std::uint32_t> ids(static_cast<py::ssize_t>(mesh.nodes.size()));
  auto out = ids.mutable_unchecked<1>();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const NodeOnCad& node = mesh.nodes[i];
    out(static_cast<py::ssize_t>(i)) = entities_of(mesh, node.dimension)[node.entity].cad_id;
  }
  return ids;
}

py::array_t<double> node_parameters(const Mesh& mesh) {
  py::array_t<double> parameters({mesh.nodes.size(), std::size_t{2}});
  auto out = parameters.mutable_unchecked<2>();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    for (py::ssize_t k = 0; k < 2; ++k)
      out(static_cast<py::ssize_t>(i), k) = mesh.nodes[i].parameter[static_cast<std::size_t>(k)];
  }
  return parameters;
}

void write(const MadeMesh& made, const std::filesystem::path& path, const std::string& format, bool parametric) {
  const Result<MeshFormat> known = format.empty() ? format_of(path.string()) : format_named(format);
  if (!known) raise(known.error(), made.report);
  Status written = Done{};
  {
    const py::gil_scoped_release others_run;
    written = write_mesh(made.mesh, path.string(), {known.value(), parametric});
  }
  if (!written) raise(written.error(), made.report);
}

/// A property that looks into the mesh's memory.
template <class Rows>
auto rows(Rows Mesh::*member) {
  return [member](const py::object& self) { return view(self.cast<const MadeMesh&>().mesh.*member, self); };
}

auto ids(std::vector<std::uint32_t> Mesh::*member, std::vector<Entity> Mesh::*entities) {
  return [=](const MadeMesh& self) { return cad_ids(self.mesh.*member, self.mesh.*entities); };
}

auto list(std::vector<Entity> Mesh::*entities) {
  return [=](const MadeMesh& self) { return entity_list(self.mesh.*entities); };
}

std::string describe(const MadeMesh& self) {
  return "<curvetet.Mesh: " + std::to_string(self.mesh.points.size()) + " points, " +
         std::to_string(self.mesh.tets.size()) + " tets, " + std::to_string(self.mesh.triangles.size()) + " triangles>";
}

}  // namespace

void register_mesh(py::module_& module) {
  py::class_<MadeMesh>(module, "Mesh", "A tetrahedral mesh, labelled with the CAD's ids and names.")
      .def_property_readonly("points", rows(&Mesh::points), "(n, 3) float64, in `unit`")
      .def_property_readonly("tets", rows(&Mesh::tets), "(n, 4) uint32: indices of points, positively oriented")
      .def_property_readonly("tet_solids", ids(&Mesh::tet_solid, &Mesh::solids), "(n,) uint32: id of each tet's solid")
      .def_property_readonly("triangles", rows(&Mesh::triangles),
                             "(n, 3) uint32: boundary, counter-clockwise seen from outside of the CAD face")
      .def_property_readonly("triangle_faces", ids(&Mesh::triangle_face, &Mesh::faces),
                             "(n,) uint32: id of each triangle's CAD face")
      .def_property_readonly("segments", rows(&Mesh::segments), "(n, 2) uint32: on the CAD's edges")
      .def_property_readonly("segment_edges", ids(&Mesh::segment_edge, &Mesh::edges),
                             "(n,) uint32: id of each segment's CAD edge")
      .def_property_readonly(
          "node_dimensions", [](const MadeMesh& self) { return node_dimensions(self.mesh); },
          "(n,) uint8: 0 for a point at a CAD vertex, 1 on an edge, 2 on a face, 3 inside")
      .def_property_readonly(
          "node_entities", [](const MadeMesh& self) { return node_entities(self.mesh); },
          "(n,) uint32: id of the CAD entity of that dimension")
      .def_property_readonly(
          "node_parameters", [](const MadeMesh& self) { return node_parameters(self.mesh); },
          "(n, 2) float64: t on an edge, u and v on a face")
      .def_property_readonly("solids", list(&Mesh::solids), "list of dicts: id, name, colour, boundary")
      .def_property_readonly("faces", list(&Mesh::faces), "list of dicts: id, name, colour, boundary")
      .def_property_readonly("edges", list(&Mesh::edges), "list of dicts: id, name, colour, boundary")
      .def_property_readonly(
          "unit", [](const MadeMesh& self) { return self.mesh.unit; }, "of the points")
      .def_readonly("report", &MadeMesh::report, "the report as a dict")
      .def("write", &write, py::arg("path"), py::kw_only(), py::arg("format") = "", py::arg("parametric") = false,
           "Writes a file whole or not at all, by its ending or by format: msh, msh-ascii, msh22, vtu, mesh, stl.")
      .def("__repr__", &describe);
}

}  // namespace curvetet::python
