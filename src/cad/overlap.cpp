// Overlapping solids have crossing faces, or one lies in the other without a void for it; no mesh conforms to either.
// The mesher would find out only after it has refined what crosses, and could name no more than two faces. A Boolean
// operation on each pair would find all of them, but costs more than the mesh; it only confirms what a point shows.
#include "cad/overlap.h"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <vector>

#include "cad/occt_geometry.h"
#include "cad/sew.h"

namespace curvetet {
namespace {

/// overlap_depth over the body's diagonal.
constexpr double kDepth = 1e-4;
/// Points that are classified, at most: a second or two.
constexpr std::size_t kLargestEffort = 20000;

class Part {
 public:
  explicit Part(const TopoDS_Shape& solid)
      : solid_(solid), edges_(sub_shapes(solid, TopAbs_EDGE)), vertices_(sub_shapes(solid, TopAbs_VERTEX)) {
    BRepBndLib::Add(solid, box_, false);
  }

  const Bnd_Box& box() const { return box_; }
  bool empty() const { return edges_.IsEmpty() || box_.IsVoid(); }

  /// Points of this solid in the box of another one that are on no vertex or edge of both.
  std::vector<gp_Pnt> points_in(const Part& other) const {
    std::vector<gp_Pnt> points;
    const auto add = [&](const gp_Pnt& p) {
      if (!other.box_.IsOut(p)) points.push_back(p);
    };
    for (int v = 1; v <= vertices_.Extent(); ++v) {
      if (!other.vertices_.Contains(vertices_(v))) add(BRep_Tool::Pnt(TopoDS::Vertex(vertices_(v))));
    }
    for (int e = 1; e <= edges_.Extent(); ++e) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges_(e));
      if (BRep_Tool::Degenerated(edge) || other.edges_.Contains(edge)) continue;
      const BRepAdaptor_Curve curve(edge);
      const double low = curve.FirstParameter(), high = curve.LastParameter();
      for (const double s : {0.5, 0.25, 0.75}) add(curve.Value(low + s * (high - low)));
    }
    return points;
  }

  /// Whether a point lies inside and farther than `depth` from all faces.
  bool holds(const gp_Pnt& point, double depth) {
    if (shells_.empty()) collect_shells();
    // By parity: the shells of a void need not be turned the right way.
    bool inside = false;
    for (Shell& shell : shells_) {
      shell.classifier->Perform(point, 1e-7);
      const TopAbs_State state = shell.classifier->State();
      if (state != TopAbs_IN && state != TopAbs_OUT) return false;
      if ((state == TopAbs_IN) != shell.inside_out) inside = !inside;
    }
    if (!inside) return false;
    const TopoDS_Vertex vertex = BRepBuilderAPI_MakeVertex(point).Vertex();
    return std::all_of(shells_.begin(), shells_.end(), [&](const Shell& shell) {
      const BRepExtrema_DistShapeShape to_faces(vertex, shell.shape);
      return to_faces.IsDone() && to_faces.Value() > depth;
    });
  }

 private:
  struct Shell {
    TopoDS_Shape shape;
    std::unique_ptr<BRepClass3d_SolidClassifier> classifier;
    bool inside_out = false;
  };

  void collect_shells() {
    for (TopExp_Explorer it(solid_, TopAbs_SHELL); it.More(); it.Next()) {
      TopoDS_Solid alone;
      BRep_Builder builder;
      builder.MakeSolid(alone);
      builder.Add(alone, it.Current());
      Shell shell{it.Current(), std::make_unique<BRepClass3d_SolidClassifier>(alone)};
      shell.classifier->PerformInfinitePoint(1e-7);
      shell.inside_out = shell.classifier->State() == TopAbs_IN;
      shells_.push_back(std::move(shell));
    }
  }

  TopoDS_Shape solid_;
  TopTools_IndexedMapOfShape edges_, vertices_;
  Bnd_Box box_;
  std::vector<Shell> shells_;
};

/// The volume of what two solids have in common; zero where the kernel finds none. The point alone is no proof: on some
/// solids the classifier is wrong.
double common_volume(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_Common common(a, b);
  return common.IsDone() && !common.Shape().IsNull() ? std::abs(volume_of(common.Shape())) : 0;
}

}  // namespace

bool is_inside(const TopoDS_Shape& solid, Vec3 point) {
  return Part(solid).holds(gp_Pnt(point.x, point.y, point.z), 0);
}

double overlap_depth(const CadBody& body) { return kDepth * diagonal_of(body.shape); }

Error overlap_error(const CadBody& body, const Overlap& overlap, const std::string& source) {
  const auto label = [&](int solid) { return std::to_string(body.solids[static_cast<std::size_t>(solid - 1)].cad_id); };
  const std::string one = label(overlap.one), two = label(overlap.two);
  return {ErrorCode::overlapping_solids,
          fmt::format("solids {} and {} of {} overlap by {:.4g} {}^3", one, two, source, overlap.volume, body.unit),
          {"solid " + one, "solid " + two},
          overlap.place,
          "cut one solid out of the other in the CAD system, or let them be split (--overlaps split)"};
}

std::optional<Error> find_overlap(const CadBody& body, const std::string& source) {
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  if (solids.Extent() < 2) return std::nullopt;
  std::deque<Part> parts;
  for (int s = 1; s <= solids.Extent(); ++s) parts.emplace_back(solids(s));
  const double depth = overlap_depth(body);
  std::size_t effort = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      if (parts[i].empty() || parts[j].empty() || parts[i].box().IsOut(parts[j].box())) continue;
      for (const auto& [of, in] : {std::pair(i, j), std::pair(j, i)}) {
        for (const gp_Pnt& point : parts[of].points_in(parts[in])) {
          if (++effort > kLargestEffort) return std::nullopt;
          if (!parts[in].holds(point, depth)) continue;
          const double volume = common_volume(solids(static_cast<int>(i + 1)), solids(static_cast<int>(j + 1)));
          if (!(volume > depth * depth * depth)) break;
          return overlap_error(body, {static_cast<int>(i + 1), static_cast<int>(j + 1), volume, to_vec(point.XYZ())},
                               source);
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace curvetet
