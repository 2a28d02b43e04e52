// Files: formats, names, units, errors, and the helper process.
#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BinTools.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "cad/guard.h"
#include "cad/load.h"
#include "shapes.h"

namespace curvetet {
namespace {

LoadOptions in_process() {
  LoadOptions options;
  options.isolate = false;
  return options;
}

LoadOptions isolated() {
  LoadOptions options;
  options.helper = CURVETET_TEST_CAD_HELPER;
  return options;
}

Result<Model> load(const std::string& path, const LoadOptions& options) {
  Context context;
  return load_model(path, options, context);
}

void write_text(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

std::string read_text(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// An assembly of a named, coloured box and a cylinder with a coloured face.
void write_assembly(const std::string& path, const char* unit) {
  const QuietMessages quiet;
  const bool naming = XCAFDoc_ShapeTool::AutoNaming();
  XCAFDoc_ShapeTool::SetAutoNaming(false);
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape(), cylinder = BRepPrimAPI_MakeCylinder(1, 4).Shape();
  const TDF_Label assembly = shapes->NewShape();
  TDataStd_Name::Set(assembly, "press");
  const TDF_Label box_label = shapes->AddShape(box, false), cylinder_label = shapes->AddShape(cylinder, false);
  TDataStd_Name::Set(box_label, "frame");
  TDataStd_Name::Set(cylinder_label, "piston");
  colours->SetColor(box_label, Quantity_Color(1, 0, 0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  const TopoDS_Shape face = TopExp_Explorer(cylinder, TopAbs_FACE).Current();
  colours->SetColor(shapes->AddSubShape(cylinder_label, face), Quantity_Color(0, 0, 1, Quantity_TOC_sRGB),
                    XCAFDoc_ColorSurf);
  for (const double x : {0.0, 10.0}) {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(x, 0, 0));
    shapes->AddComponent(assembly, box_label, TopLoc_Location(move));
    move.SetTranslation(gp_Vec(x, 20, 0));
    shapes->AddComponent(assembly, cylinder_label, TopLoc_Location(move));
  }
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", unit);
  writer.Transfer(document);
  writer.Write(path.c_str());
  Interface_Static::SetCVal("write.step.unit", "MM");
  XCAFDoc_ShapeTool::SetAutoNaming(naming);
}

TEST(Load, NamesColoursPathsAndUnits) {
  const test::Folder folder;
  const std::string path = folder.file("press.step");
  write_assembly(path, "INCH");
  for (const LoadOptions& options : {in_process(), isolated()}) {
    const Result<Model> result = load(path, options);
    ASSERT_TRUE(result) << result.error().message;
    const Model& model = result.value();
    test::expect_sound(model, "assembly");
    EXPECT_EQ(model.unit, "mm");
    EXPECT_EQ(model.file_unit, "inch");
    ASSERT_EQ(model.solids.size(), 4U);
    EXPECT_EQ(model.faces.size(), 18U);
    int frames = 0, pistons = 0, blue = 0;
    for (const ModelSolid& solid : model.solids) {
      EXPECT_EQ(solid.path, "press");
      frames += solid.label.name == "frame" ? 1 : 0;
      pistons += solid.label.name == "piston" ? 1 : 0;
      EXPECT_EQ(solid.label.colour.has_value(), solid.label.name == "frame");
      if (solid.label.colour) {
        EXPECT_NEAR(solid.label.colour->red, 1, 1e-3);
      }
    }
    for (const ModelFace& face : model.faces) blue += face.label.colour && face.label.colour->blue > 0.9 ? 1 : 0;
    EXPECT_EQ(frames, 2);
    EXPECT_EQ(pistons, 2);
    EXPECT_EQ(blue, 2);
    bool noted = false;
    for (const HealingNote& note : model.healing) noted = noted || note.what.find("inch") != std::string::npos;
    EXPECT_TRUE(noted);
    EXPECT_NEAR(test::total_volume(model), std::pow(25.4, 3) * 2 * (6 + 3.14159265 * 4), 1);
  }
}

TEST(Load, AllFormatsGiveTheSameBody) {
  const QuietMessages quiet;
  const test::Folder folder;
  const TopoDS_Shape shape = test::make_bracket();
  const std::string brep = folder.file("a.brep"), binary = folder.file("a.bin"), iges = folder.file("a.igs");
  BRepTools::Write(shape, brep.c_str());
  BinTools::Write(shape, binary.c_str());
  IGESControl_Writer writer("MM", 1);
  writer.AddShape(shape);
  writer.Write(iges.c_str());
  const Result<Model> expected = load(brep, in_process());
  ASSERT_TRUE(expected);
  for (const std::string& path : {binary, iges}) {
    const Result<Model> model = load(path, in_process());
    ASSERT_TRUE(model) << model.error().message;
    test::expect_sound(model.value(), path);
    EXPECT_EQ(model.value().faces.size(), expected.value().faces.size());
    EXPECT_NEAR(test::total_volume(model.value()), test::total_volume(expected.value()),
                1e-5 * test::total_volume(expected.value()));
  }
}

TEST(Load, UnitOfAFileWithoutOne) {
  const test::Folder folder;
  BRepTools::Write(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("box.brep").c_str());
  LoadOptions options = in_process();
  EXPECT_EQ(load(folder.file("box.brep"), options).value().unit, "mm");
  options.input_unit = "inch";
  EXPECT_EQ(load(folder.file("box.brep"), options).value().unit, "inch");

  const QuietMessages quiet;
  STEPControl_Writer writer;
  writer.Transfer(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), STEPControl_AsIs);
  writer.Write(folder.file("box.step").c_str());
  std::string text = read_text(folder.file("box.step"));
  for (std::size_t at = 0; (at = text.find("GLOBAL_UNIT_ASSIGNED_CONTEXT", at)) != std::string::npos;) {
    const std::size_t end = text.find("))", at);
    ASSERT_NE(end, std::string::npos);
    text.erase(at, end + 2 - at);
  }
  write_text(folder.file("bare.step"), text);
  const Result<Model> bare = load(folder.file("bare.step"), options);
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_EQ(bare.value().unit, "inch");
  EXPECT_EQ(bare.value().file_unit, "");
  EXPECT_NEAR(test::total_volume(bare.value()), 6, 1e-9);
  const Result<Model> with_unit = load(folder.file("box.step"), options);
  EXPECT_EQ(with_unit.value().unit, "mm") << "what the file says counts";
}

/// The helper's way of loading changes nothing.
TEST(Load, IsolationGivesTheSameModel) {
  const test::Folder folder;
  const std::string path = folder.file("bracket.brep");
  BRepTools::Write(test::make_bracket(), path.c_str());
  const Result<Model> a = load(path, in_process()), b = load(path, isolated());
  ASSERT_TRUE(a);
  ASSERT_TRUE(b) << b.error().message;
  const Model &one = a.value(), &two = b.value();
  ASSERT_EQ(one.faces.size(), two.faces.size());
  ASSERT_EQ(one.edges.size(), two.edges.size());
  EXPECT_EQ(one.frame.scale, two.frame.scale);
  EXPECT_EQ(one.frame.centre, two.frame.centre);
  for (std::size_t v = 0; v < one.vertices.size(); ++v) {
    EXPECT_EQ(one.vertices[CadVertexId(v)].point, two.vertices[CadVertexId(v)].point);
  }
  for (std::size_t f = 0; f < one.faces.size(); ++f) {
    const ModelFace &p = one.faces[FaceId(f)], &q = two.faces[FaceId(f)];
    EXPECT_EQ(p.label.cad_id, q.label.cad_id);
    EXPECT_EQ(p.low, q.low);
    EXPECT_EQ(p.high, q.high);
    EXPECT_EQ(p.reversed, q.reversed);
    const Vec2 middle = 0.5 * (p.low + p.high);
    EXPECT_EQ(p.surface->value(middle), q.surface->value(middle));
  }
}

TEST(Load, TypedErrors) {
  const test::Folder folder;
  const auto code = [&](const std::string& path, const LoadOptions& options) {
    const Result<Model> model = load(path, options);
    if (!model) {
      EXPECT_NE(model.error().message.find(path), std::string::npos) << model.error().message;
    }
    return model ? ErrorCode::internal : model.error().code;
  };
  write_assembly(folder.file("whole.step"), "MM");
  const std::string step = read_text(folder.file("whole.step"));
  write_text(folder.file("cut.step"), step.substr(0, step.size() / 2));
  write_text(folder.file("cut_inside.step"), step.substr(0, step.size() / 2) + "\nENDSEC;\nEND-ISO-10303-21;\n");
  write_text(folder.file("empty.step"), "");
  write_text(folder.file("words.step"), "not a step file\n");
  write_text(folder.file("words.xyz"), "no CAD at all\n");
  write_text(folder.file("words.brep"),
             "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 7\n");
  write_text(folder.file("words.igs"), "nothing that IGES knows\n");
  for (const LoadOptions& options : {in_process(), isolated()}) {
    EXPECT_EQ(code(folder.file("missing.step"), options), ErrorCode::file_not_found);
    EXPECT_EQ(code(folder.file(""), options), ErrorCode::file_unreadable);
    EXPECT_EQ(code(folder.file("empty.step"), options), ErrorCode::empty_file);
    EXPECT_EQ(code(folder.file("words.xyz"), options), ErrorCode::unknown_format);
    EXPECT_EQ(code(folder.file("words.step"), options), ErrorCode::reader_failed);
    EXPECT_EQ(code(folder.file("cut.step"), options), ErrorCode::reader_failed);
    EXPECT_EQ(code(folder.file("words.igs"), options), ErrorCode::reader_failed);
    EXPECT_EQ(code(folder.file("words.brep"), options), ErrorCode::reader_failed);
  }
  EXPECT_NE(code(folder.file("cut_inside.step"), isolated()), ErrorCode::internal);
}

TEST(Load, AHelperThatCrashesOrHangsIsAMessage) {
  const test::Folder folder;
  for (const char* name : {"crash.brep", "hang.brep", "silent.brep"}) {
    BRepTools::Write(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file(name).c_str());
  }
  const Result<Model> crashed = load(folder.file("crash.brep"), isolated());
  ASSERT_FALSE(crashed);
  EXPECT_EQ(crashed.error().code, ErrorCode::reader_crashed);
  EXPECT_NE(crashed.error().message.find("crash.brep"), std::string::npos);

  LoadOptions soon = isolated();
  soon.isolate_time_limit = 0.3;
  const Result<Model> hung = load(folder.file("hang.brep"), soon);
  ASSERT_FALSE(hung);
  EXPECT_EQ(hung.error().code, ErrorCode::reader_failed);

  const Result<Model> silent = load(folder.file("silent.brep"), isolated());
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, ErrorCode::bad_option);

  LoadOptions nowhere = isolated();
  nowhere.helper = folder.file("no_such_program");
  const Result<Model> unstarted = load(folder.file("crash.brep"), nowhere);
  ASSERT_FALSE(unstarted);
  EXPECT_EQ(unstarted.error().code, ErrorCode::bad_option);
}

TEST(Load, CancelTakesEffectAtOnce) {
  const test::Folder folder;
  BRepTools::Write(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), folder.file("hang.brep").c_str());
  Context context;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    context.cancel();
  });
  const auto start = std::chrono::steady_clock::now();
  const Result<Model> model = load_model(folder.file("hang.brep"), isolated(), context);
  canceller.join();
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::cancelled);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.2);
}

}  // namespace
}  // namespace curvetet
