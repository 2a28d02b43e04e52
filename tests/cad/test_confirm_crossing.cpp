// The kernel's second opinion: faces that share an edge, or only touch, do not cross; those that run through each other
// do.
#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pln.hxx>

#include "cad/confirm_crossing.h"

namespace curvetet {
namespace {

CadBody labelled(const TopoDS_Shape& shape) {
  CadBody body;
  body.shape = shape;
  label_all(body);
  return body;
}

TEST(ConfirmCrossing, NeighboursOfASolidDoNotCross) {
  for (const TopoDS_Shape& solid : {BRepPrimAPI_MakeBox(1, 2, 3).Shape(), BRepPrimAPI_MakeCylinder(1, 3).Shape()}) {
    const CadBody body = labelled(solid);
    for (std::uint32_t a = 1; a <= body.faces.size(); ++a)
      for (std::uint32_t b = a + 1; b <= body.faces.size(); ++b)
        EXPECT_FALSE(confirm_crossing(body, {a, b}, "solid")) << a << " " << b;
  }
}

TEST(ConfirmCrossing, FacesThatRunThroughEachOtherAreNamed) {
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  builder.Add(faces, BRepBuilderAPI_MakeFace(gp_Pln(gp::XOY()), -1, 1, -1, 1).Face());
  builder.Add(faces, BRepBuilderAPI_MakeFace(gp_Pln(gp::YOZ()), -1, 1, -1, 1).Face());
  builder.Add(faces, BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 5), gp_Dir(0, 0, 1)), -1, 1, -1, 1).Face());
  const CadBody body = labelled(faces);
  const auto crossing = confirm_crossing(body, {1, 2}, "cross");
  ASSERT_TRUE(crossing);
  EXPECT_EQ(crossing->code, ErrorCode::self_intersection);
  EXPECT_EQ(crossing->entities, (std::vector<std::string>{"face 1", "face 2"}));
  EXPECT_FALSE(confirm_crossing(body, {1, 3}, "cross")) << "they are apart";
  EXPECT_FALSE(confirm_crossing(body, {}, "cross"));
  EXPECT_FALSE(confirm_crossing(body, {77}, "cross"));
}

}  // namespace
}  // namespace curvetet
