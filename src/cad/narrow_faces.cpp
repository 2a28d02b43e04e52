// OpenCASCADE's ShapeAnalysis_CheckSmallFace knows strips between two edges only, no rings, bores or faces whose sides
// are split.
#include "cad/narrow_faces.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Bnd_OBB.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/disjoint_sets.h"
#include "cad/occt_geometry.h"
#include "cad/sew.h"

namespace curvetet {
namespace {

/// A tube of that width and the face's length has an area less than this many times their product.
constexpr double kTube = 4;

/// Length of the face's boundary; edges that it uses twice are none.
double outline_of(const TopoDS_Shape& face) {
  const TopTools_IndexedMapOfShape edges = sub_shapes(face, TopAbs_EDGE);
  std::vector<int> uses(static_cast<std::size_t>(edges.Extent()) + 1, 0);
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next())
    ++uses[static_cast<std::size_t>(edges.FindIndex(it.Current()))];
  double length = 0;
  for (int e = 1; e <= edges.Extent(); ++e) {
    if (uses[static_cast<std::size_t>(e)] != 1 || BRep_Tool::Degenerated(TopoDS::Edge(edges(e)))) continue;
    GProp_GProps properties;
    BRepGProp::LinearProperties(edges(e), properties);
    length += properties.Mass();
  }
  return length;
}

/// The shorter side of a rectangle with that area and outline; of a square where no rectangle has so short an outline.
double width_of_rectangle(double area, double outline) {
  const double half = outline / 2, rest = half * half - 4 * area;
  return rest > 0 ? (half - std::sqrt(rest)) / 2 : std::sqrt(area);
}

double width_of_tube(const TopoDS_Shape& face) {
  Bnd_OBB box;
  BRepBndLib::AddOBB(face, box, false, false, false);
  std::array sides{2 * box.XHSize(), 2 * box.YHSize(), 2 * box.ZHSize()};
  std::sort(sides.begin(), sides.end());
  return sides[1];
}

NarrowFace measure(const TopoDS_Shape& face, double length) {
  NarrowFace narrow;
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties, false, false);
  narrow.area = std::abs(properties.Mass());
  narrow.place = to_vec(properties.CentreOfMass().XYZ());
  narrow.width = width_of_rectangle(narrow.area, outline_of(face));
  const double extent = diagonal_of(face);
  narrow.compact = extent < length;
  if (narrow.width >= length && narrow.area < kTube * length * extent)
    narrow.width = std::min(narrow.width, width_of_tube(face));
  return narrow;
}

/// By number in the map of faces: is it one of a solid?
std::vector<char> faces_of_solids(const CadBody& body, const TopTools_IndexedMapOfShape& faces) {
  std::vector<char> of_solid(static_cast<std::size_t>(faces.Extent()) + 1, 0);
  for (TopExp_Explorer solid(body.shape, TopAbs_SOLID); solid.More(); solid.Next())
    for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next())
      of_solid[static_cast<std::size_t>(faces.FindIndex(face.Current()))] = 1;
  return of_solid;
}

/// Which of the faces hang together by edges.
DisjointSets connected(const std::vector<TopoDS_Shape>& faces) {
  DisjointSets sets(faces.size());
  TopTools_IndexedMapOfShape edges;
  std::vector<std::uint32_t> first_at;  // face at each edge
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (TopExp_Explorer edge(faces[f], TopAbs_EDGE); edge.More(); edge.Next()) {
      const auto number = static_cast<std::size_t>(edges.Add(edge.Current())) - 1;
      if (number == first_at.size()) first_at.push_back(f);
      sets.join(first_at[number], f);
    }
  }
  return sets;
}

}  // namespace

SuppressedDetail detail_of(const CadBody& body, const NarrowFace& face) {
  const auto label =
      std::find_if(body.faces.begin(), body.faces.end(), [&](const Label& one) { return one.cad_id == face.cad_id; });
  return {SuppressedDetail::Kind::face, *label, face.width, face.place};
}

std::vector<std::vector<NarrowFace>> narrow_faces(const CadBody& body, double length) {
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  const std::vector<char> of_solid = faces_of_solids(body, faces);
  std::vector<NarrowFace> found;
  std::vector<TopoDS_Shape> shapes;
  for (int f = 1; f <= faces.Extent(); ++f) {
    if (of_solid[static_cast<std::size_t>(f)] == 0) continue;
    NarrowFace narrow = measure(faces(f), length);
    if (!(narrow.width < length)) continue;
    narrow.cad_id = body.faces[static_cast<std::size_t>(f - 1)].cad_id;
    found.push_back(narrow);
    shapes.push_back(faces(f));
  }
  DisjointSets sets = connected(shapes);
  std::vector<std::vector<NarrowFace>> groups;
  std::vector<std::size_t> group_of(found.size());
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    const std::uint32_t root = sets.root(i);
    if (root == i) {
      group_of[i] = groups.size();
      groups.emplace_back();
    }
    groups[group_of[root]].push_back(found[i]);
  }
  return groups;
}

}  // namespace curvetet
