// Makes a block with a bore in OpenCASCADE, names the bore's face, asks for a finer size there, and writes the mesh.
// usage: mesh_a_shape BLOCK.msh
#include <curvetet/formats.h>
#include <curvetet/occt.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: mesh_a_shape BLOCK.msh\n", stderr);
    return 2;
  }
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 10, -1), gp_Dir(0, 0, 1)), 3, 40).Shape();
  const TopoDS_Shape block = BRepAlgoAPI_Cut(box, bore).Shape();

  curvetet::ShapeLabels labels{"block", {}};
  for (TopExp_Explorer face(block, TopAbs_FACE); face.More(); face.Next()) {
    const bool round = BRepAdaptor_Surface(TopoDS::Face(face.Current())).GetType() == GeomAbs_Cylinder;
    if (round) labels.parts.push_back({face.Current(), "bore"});
  }

  curvetet::Options options;
  options.size = 4;
  options.input_unit = "mm";  // of the shape
  options.local_sizes.push_back({curvetet::LocalSize::Kind::face, "bore", 2});

  curvetet::Context context;
  const curvetet::Result<curvetet::MeshOutput> made = curvetet::mesh(block, labels, options, context);
  if (!made) {
    std::fprintf(stderr, "%s\n%s\n", made.error().message.c_str(), made.error().hint.c_str());
    return curvetet::exit_code(made.error().code);
  }
  const curvetet::Report& report = made.value().report;
  for (const curvetet::FaceReport& face : report.faces)
    std::printf("%s (%s): %zu triangles\n", face.name.c_str(), face.kind.c_str(), face.triangles);
  if (!report.valid) return 5;
  const curvetet::Status written = curvetet::write_mesh(made.value().mesh, argv[1], {});
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return written ? 0 : curvetet::exit_code(written.error().code);
}
