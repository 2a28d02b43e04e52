// Writes the CAD files that the tests of the command line mesh: box.step, plate.step (a plate with a bore), ball.brep,
// pricked.step (the box with a tiny blind bore), touching.brep and overlapping.brep (two boxes that touch or overlap
// and share nothing, a third apart), crossed.brep (a box with a hollow that sticks out of it, so that faces cross); and
// those that it must refuse: a plane and a half space without end, an open shell, a body without size, a vertex.
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeHalfSpace.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <cstdio>
#include <gp_Pln.hxx>
#include <string>

namespace {

bool write_step(const TopoDS_Shape& shape, const std::string& path) {
  STEPControl_Writer writer;
  return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone && writer.Write(path.c_str()) == IFSelect_RetDone;
}

TopoDS_Shell open_shell() {
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  TopExp_Explorer face(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), TopAbs_FACE);
  for (face.Next(); face.More(); face.Next()) builder.Add(shell, face.Current());
  return shell;
}

TopoDS_Shape without_size() {
  gp_Trsf shrink;
  shrink.SetScale(gp_Pnt(0, 0, 0), 1e-12);
  return BRepBuilderAPI_Transform(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), shrink, true).Shape();
}

bool write_brep(const TopoDS_Shape& shape, const std::string& path) { return BRepTools::Write(shape, path.c_str()); }

bool write_bad_bodies(const std::string& folder) {
  const TopoDS_Face plane = BRepBuilderAPI_MakeFace(gp_Pln()).Face();
  return write_brep(plane, folder + "plane.brep") &&
         write_brep(BRepPrimAPI_MakeHalfSpace(plane, gp_Pnt(0, 0, 9)).Shape(), folder + "half_space.brep") &&
         write_brep(open_shell(), folder + "open.brep") && write_step(open_shell(), folder + "open.step") &&
         write_brep(without_size(), folder + "speck.brep") &&
         write_brep(BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Shape(), folder + "vertex.brep");
}

/// Three boxes: the second begins where `second` says along x, the first ends at 10; the third is apart.
TopoDS_Shape three_boxes(double second) {
  TopoDS_Compound boxes;
  BRep_Builder builder;
  builder.MakeCompound(boxes);
  builder.Add(boxes, BRepPrimAPI_MakeBox(10, 10, 10).Shape());
  builder.Add(boxes, BRepPrimAPI_MakeBox(gp_Pnt(second, 2, 2), 8, 8, 8).Shape());
  builder.Add(boxes, BRepPrimAPI_MakeBox(gp_Pnt(30, 0, 0), 5, 5, 5).Shape());
  return boxes;
}

/// A box, and faces beside it that close around nothing.
TopoDS_Shape box_and_open_shell() {
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, open_shell());
  builder.Add(both, BRepPrimAPI_MakeBox(gp_Pnt(20, 0, 0), 10, 10, 10).Shape());
  return both;
}

TopoDS_Shape crossed() {
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  const TopoDS_Shape hollow = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, 4), gp_Dir(1, 0.2, 0.1)), 2, 7).Shape();
  builder.Add(solid, TopExp_Explorer(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), TopAbs_SHELL).Current());
  builder.Add(solid, TopExp_Explorer(hollow, TopAbs_SHELL).Current().Reversed());
  return solid;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_bodies FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = std::string(argv[1]) + "/";
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 10, -1), gp_Dir(0, 0, 1)), 3, 40).Shape();
  const TopoDS_Shape prick = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 10, 29.9), gp_Dir(0, 0, 1)), 0.1, 1).Shape();
  const bool done = write_step(box, folder + "box.step") &&
                    write_step(BRepAlgoAPI_Cut(box, bore).Shape(), folder + "plate.step") &&
                    write_step(BRepAlgoAPI_Cut(box, prick).Shape(), folder + "pricked.step") &&
                    write_brep(BRepPrimAPI_MakeSphere(5).Shape(), folder + "ball.brep") &&
                    write_brep(three_boxes(10), folder + "touching.brep") &&
                    write_brep(three_boxes(7), folder + "overlapping.brep") &&
                    write_brep(box_and_open_shell(), folder + "leftover.brep") &&
                    write_brep(crossed(), folder + "crossed.brep") && write_bad_bodies(folder);
  return done ? 0 : 1;
}
