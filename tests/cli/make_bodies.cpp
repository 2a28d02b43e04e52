// Writes the CAD files that the tests of the command line mesh: box.step, plate.step (a plate with a bore), ball.brep.
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <STEPControl_Writer.hxx>
#include <cstdio>
#include <string>

namespace {

bool write_step(const TopoDS_Shape& shape, const std::string& path) {
  STEPControl_Writer writer;
  return writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone && writer.Write(path.c_str()) == IFSelect_RetDone;
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
  const bool done = write_step(box, folder + "box.step") &&
                    write_step(BRepAlgoAPI_Cut(box, bore).Shape(), folder + "plate.step") &&
                    BRepTools::Write(BRepPrimAPI_MakeSphere(5).Shape(), (folder + "ball.brep").c_str());
  return done ? 0 : 1;
}
