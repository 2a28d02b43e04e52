#include "shapes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <BOPAlgo_Builder.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

#include "geometry/check.h"

namespace curvetet::test {

Folder::Folder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "curvetet-test-XXXXXX").string();
  path_ = mkdtemp(pattern.data());
}

Folder::~Folder() {
  std::error_code code;
  std::filesystem::remove_all(path_, code);
}

TopoDS_Shape make_bracket() {
  const gp_Dir up(0, 0, 1);
  TopoDS_Shape body = BRepPrimAPI_MakeBox(40, 30, 10).Shape();
  BRepFilletAPI_MakeFillet fillet(body);
  for (TopExp_Explorer edge(body, TopAbs_EDGE); edge.More(); edge.Next()) {
    fillet.Add(2, TopoDS::Edge(edge.Current()));
  }
  body = fillet.Shape();
  body = BRepAlgoAPI_Fuse(body, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(28, 15, 5), up), 8, 15).Shape()).Shape();
  body = BRepAlgoAPI_Cut(body, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(28, 15, -1), up), 5, 30).Shape()).Shape();
  return BRepAlgoAPI_Cut(body, BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(10, 15, 4), up), 0, 5, 8).Shape()).Shape();
}

TopoDS_Shape make_box_with_core() {
  BOPAlgo_Builder builder;
  builder.AddArgument(BRepPrimAPI_MakeBox(10, 10, 10).Shape());
  builder.AddArgument(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, 0), gp_Dir(0, 0, 1)), 2, 10).Shape());
  builder.Perform();
  return builder.Shape();
}

void expect_sound(const Model& model, const std::string& what) {
  for (const ModelFault& fault : check_model(model)) {
    ADD_FAILURE() << what << ": " << name(fault.kind) << ": " << fault.entity << " " << fault.what << " "
                  << fault.amount;
  }
}

double total_volume(const Model& model) {
  double sum = 0;
  for (const ModelSolid& solid : model.solids) sum += solid.volume;
  return sum / (model.frame.scale * model.frame.scale * model.frame.scale);
}

double total_area(const Model& model) {
  double sum = 0;
  for (const ModelFace& face : model.faces) sum += face.area;
  return sum / (model.frame.scale * model.frame.scale);
}

}  // namespace curvetet::test
