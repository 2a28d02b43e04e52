// Every format that can be read back gives the mesh that was written, but for what the format is documented to lose.
#include "io/formats.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "io/labels.h"
#include "io/two_boxes.h"

namespace curvetet {
namespace {

class Formats : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("curvetet_io_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  std::filesystem::path folder_;
};

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Two boxes with names, colours and an order of elements that no format would choose by itself.
Mesh example() {
  Mesh mesh = test::TwoBoxes(3).mesh;
  mesh.unit = "inch";
  mesh.solids[0].name = "Gehäuse \"A\" $1\\";
  mesh.faces[2].name = "inlet";
  mesh.faces[5].name = "inlet";
  mesh.faces[7].name = std::string(200, 'x');
  mesh.faces[8].name = std::string(200, 'x') + "y";
  mesh.edges[3].name = "line\nbreak";
  mesh.vertices[1].name = "load point";
  mesh.faces[2].colour = {{1.0 / 3, 0, 1}};
  std::mt19937 random(7);
  std::vector<std::size_t> order(mesh.tets.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);
  Mesh shuffled = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.tets[i] = mesh.tets[order[i]];
    shuffled.tet_solid[i] = mesh.tet_solid[order[i]];
  }
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  for (Point& point : shuffled.points) {
    for (double& coordinate : point) coordinate += noise(random);
  }
  shuffled.corner_nodes[4] = UINT32_MAX;
  return shuffled;
}

void expect_same_entities(const std::vector<Entity>& a, const std::vector<Entity>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].cad_id, b[i].cad_id);
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].colour, b[i].colour);
    EXPECT_EQ(a[i].boundary, b[i].boundary);
    EXPECT_EQ(a[i].box, b[i].box);
  }
}

void expect_same_but_nodes(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.tets, b.tets);
  EXPECT_EQ(a.tet_solid, b.tet_solid);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangle_face, b.triangle_face);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.segment_edge, b.segment_edge);
  EXPECT_EQ(a.corner_nodes, b.corner_nodes);
  for (int d = 0; d < 4; ++d) expect_same_entities(entities_of(a, d), entities_of(b, d));
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
}

void expect_same(const Mesh& a, const Mesh& b) {
  expect_same_but_nodes(a, b);
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].dimension, b.nodes[i].dimension) << i;
    EXPECT_EQ(a.nodes[i].entity, b.nodes[i].entity) << i;
    EXPECT_EQ(a.nodes[i].parameter, b.nodes[i].parameter) << i;
  }
}

TEST_F(Formats, WhatCarriesEverythingComesBackWhole) {
  const Mesh mesh = example();
  struct Case {
    const char* file;
    WriteOptions options;
  };
  for (const Case& c :
       {Case{"a.msh", {MeshFormat::msh41_binary, false}}, Case{"b.msh", {MeshFormat::msh41_binary, true}},
        Case{"c.msh", {MeshFormat::msh41_ascii, false}}, Case{"d.msh", {MeshFormat::msh41_ascii, true}},
        Case{"e.vtu", {MeshFormat::vtu, false}}}) {
    SCOPED_TRACE(c.file);
    ASSERT_TRUE(write_mesh(mesh, at(c.file), c.options).ok());
    const Result<Mesh> back = read_mesh(at(c.file));
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_same(mesh, back.value());
  }
}

TEST_F(Formats, OlderFormatsLoseOnlyParameters) {
  Mesh mesh = example();
  mesh.corner_nodes =
      test::TwoBoxes(3).mesh.corner_nodes;  // where a corner is missing, these formats cannot tell its owner
  for (const auto& [file, format] : {std::pair{"a.msh2", MeshFormat::msh22}, std::pair{"b.mesh", MeshFormat::medit}}) {
    SCOPED_TRACE(file);
    ASSERT_TRUE(write_mesh(mesh, at(file), {format, false}).ok());
    const Result<Mesh> back = read_mesh(at(file));
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_same_but_nodes(mesh, back.value());
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      EXPECT_EQ(mesh.nodes[i].dimension, back.value().nodes[i].dimension) << i;
      EXPECT_EQ(mesh.nodes[i].entity, back.value().nodes[i].entity) << i;
    }
  }
}

TEST_F(Formats, StlHoldsEveryTriangle) {
  const Mesh mesh = example();
  ASSERT_TRUE(write_mesh(mesh, at("a.stl"), {MeshFormat::stl, false}).ok());
  const std::string text = contents(at("a.stl"));
  EXPECT_EQ(text.size(), 84 + 50 * mesh.triangles.size());
  EXPECT_FALSE(text.starts_with("solid"));
}

TEST_F(Formats, SameMeshSameBytes) {
  for (const MeshFormat format : {MeshFormat::msh41_binary, MeshFormat::vtu, MeshFormat::medit}) {
    ASSERT_TRUE(write_mesh(example(), at("a"), {format, false}).ok());
    ASSERT_TRUE(write_mesh(example(), at("b"), {format, false}).ok());
    EXPECT_EQ(contents(at("a")), contents(at("b")));
  }
}

TEST_F(Formats, AFailedWriteLeavesNothing) {
  const Mesh mesh = example();
  const Status missing = write_mesh(mesh, at("no/such/folder/a.msh"), {});
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::output_unwritable);
  std::filesystem::create_directories(folder_ / "taken.msh");
  EXPECT_EQ(write_mesh(mesh, at("taken.msh"), {}).error().code, ErrorCode::output_unwritable);
  EXPECT_EQ(files(), 1U);
}

TEST_F(Formats, AFullDeviceIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const Status full = write_mesh(example(), "/dev/full", {});
  ASSERT_FALSE(full.ok());
  EXPECT_EQ(full.error().code, ErrorCode::output_unwritable);
}

TEST_F(Formats, ALinkStaysALink) {
  ASSERT_TRUE(write_file_atomically(at("target"), "old").ok());
  std::filesystem::create_symlink(folder_ / "target", folder_ / "link");
  ASSERT_TRUE(write_file_atomically(at("link"), "new").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "link"));
  EXPECT_EQ(contents(at("target")), "new");
  EXPECT_EQ(files(), 2U);
}

TEST_F(Formats, EndingsAndNames) {
  EXPECT_EQ(format_of("a/b.MSH").value(), MeshFormat::msh41_binary);
  EXPECT_EQ(format_of("b.vtu").value(), MeshFormat::vtu);
  EXPECT_EQ(format_of("b.step").error().code, ErrorCode::bad_option);
  EXPECT_EQ(format_of("msh").error().code, ErrorCode::bad_option);
  EXPECT_EQ(format_named("msh22").value(), MeshFormat::msh22);
  EXPECT_FALSE(format_named("MSH").ok());
}

TEST_F(Formats, MissingFoldersAndEmptyFiles) {
  EXPECT_EQ(read_mesh(at("none.msh")).error().code, ErrorCode::file_not_found);
  std::filesystem::create_directories(folder_ / "folder.msh");
  EXPECT_EQ(read_mesh(at("folder.msh")).error().code, ErrorCode::file_unreadable);
  ASSERT_TRUE(write_file_atomically(at("empty.vtu"), "").ok());
  EXPECT_EQ(read_mesh(at("empty.vtu")).error().code, ErrorCode::empty_file);
  EXPECT_EQ(read_mesh(at("a.stl")).error().code, ErrorCode::unknown_format);
}

/// Cut at many places and with single bytes changed, a file gives a mesh or an error, and nothing else.
TEST_F(Formats, BrokenFilesGiveErrors) {
  const Mesh mesh = test::TwoBoxes(1).mesh;
  std::mt19937 random(3);
  for (const auto& [file, format] :
       {std::pair{"a.msh", MeshFormat::msh41_binary}, std::pair{"b.msh", MeshFormat::msh41_ascii},
        std::pair{"c.msh2", MeshFormat::msh22}, std::pair{"d.vtu", MeshFormat::vtu},
        std::pair{"e.mesh", MeshFormat::medit}}) {
    ASSERT_TRUE(write_mesh(mesh, at(file), {format, false}).ok());
    const std::string whole = contents(at(file));
    std::size_t errors = 0;
    for (int i = 0; i < 300; ++i) {
      std::string broken = whole;
      if (i % 3 == 0) {
        broken.resize(random() % whole.size());
      } else {
        broken[random() % whole.size()] = static_cast<char>(random() % 256);
      }
      std::ofstream(at(file), std::ios::binary) << broken;
      const Result<Mesh> back = read_mesh(at(file));
      errors += back.ok() ? 0 : 1;
      if (back.ok()) {
        for (const auto& tet : back.value().tets) {
          for (const std::uint32_t node : tet) ASSERT_LT(node, back.value().points.size());
        }
      } else {
        EXPECT_FALSE(back.error().message.empty());
      }
    }
    EXPECT_GT(errors, 50U) << file;
  }
}

TEST_F(Formats, WhatAMeshCannotHoldIsNotSkipped) {
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n";
  std::ofstream(at("hex.msh")) << head << "$Elements\n1\n1 5 2 1 1 1 1 1 1 1 1 1 1\n$EndElements\n";
  EXPECT_EQ(read_mesh(at("hex.msh")).error().code, ErrorCode::reader_failed);
  std::ofstream(at("nan.msh")) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 nan 0 0\n$EndNodes\n";
  EXPECT_EQ(read_mesh(at("nan.msh")).error().code, ErrorCode::not_finite);
}

TEST(Groups, EqualNamesShareOnlyWhereTheCadSaysSo) {
  std::vector<Entity> faces(4);
  for (std::uint32_t i = 0; i < 4; ++i) faces[i].cad_id = i + 1;
  faces[0].name = "inlet";
  faces[1].name = "face_4";  // the CAD's own name, which is also what an unnamed face 4 would be called
  faces[2].name = "inlet";
  faces[3].name = "face_4";
  faces[3].cad_id = 4;
  const PhysicalGroups groups = physical_groups(faces, 2);
  EXPECT_EQ(groups.tag_of_entity[0], groups.tag_of_entity[2]);
  EXPECT_NE(groups.tag_of_entity[1], groups.tag_of_entity[3]);
  std::set<std::string> names;
  for (const PhysicalGroup& group : groups.groups) EXPECT_TRUE(names.insert(group.name).second) << group.name;
}

TEST(Groups, LongAndStrangeNamesStayApart) {
  std::vector<Entity> faces(4);
  for (std::uint32_t i = 0; i < 4; ++i) faces[i].cad_id = i + 1;
  faces[0].name = std::string(126, 'a') + "äb";
  faces[1].name = std::string(126, 'a') + "äc";
  faces[2].name = "\xff\"quoted\"\n";
  faces[3].name = "  ";
  const PhysicalGroups groups = physical_groups(faces, 2);
  ASSERT_EQ(groups.groups.size(), 4U);
  std::set<std::string> names;
  for (const PhysicalGroup& group : groups.groups) {
    EXPECT_LE(group.name.size(), 127U);
    EXPECT_EQ(group.name.find_first_of("\"\n\\"), std::string::npos);
    EXPECT_TRUE(names.insert(group.name).second) << group.name;
  }
}

}  // namespace
}  // namespace curvetet
