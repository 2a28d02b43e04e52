// OpenCASCADE's sewing finds the edges that belong together. The shells it returns may hold faces that are turned
// against each other, and it knows nothing of voids; both are settled here.
#include "cad/sew.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>

namespace curvetet {
namespace {

/// Turns faces so that each edge of a closed shell is walked once in either direction: breadth first from the first
/// face. A shell that cannot be oriented is left as it is.
TopoDS_Shell oriented(const TopoDS_Shell& shell) {
  struct Use {
    std::size_t face;
    bool reversed;
  };
  std::vector<TopoDS_Shape> faces;
  for (TopoDS_Iterator it(shell); it.More(); it.Next()) faces.push_back(it.Value());
  const TopTools_IndexedMapOfShape edges = sub_shapes(shell, TopAbs_EDGE);
  std::vector<std::vector<Use>> uses(static_cast<std::size_t>(edges.Extent()) + 1);
  std::vector<std::vector<std::size_t>> edges_of(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (TopExp_Explorer it(faces[f], TopAbs_EDGE); it.More(); it.Next()) {
      const auto edge = static_cast<std::size_t>(edges.FindIndex(it.Current()));
      uses[edge].push_back({f, it.Current().Orientation() == TopAbs_REVERSED});
      edges_of[f].push_back(edge);
    }
  }
  std::vector<int> turned(faces.size(), -1);
  for (std::size_t first = 0; first < faces.size(); ++first) {
    if (turned[first] >= 0) continue;
    turned[first] = 0;
    std::vector<std::size_t> queue{first};
    for (std::size_t next = 0; next < queue.size(); ++next) {
      for (const std::size_t edge : edges_of[queue[next]]) {
        if (uses[edge].size() != 2 || uses[edge][0].face == uses[edge][1].face) continue;
        const std::size_t mine = uses[edge][0].face == queue[next] ? 0 : 1;
        const std::size_t other = uses[edge][1 - mine].face;
        const bool alike = uses[edge][0].reversed == uses[edge][1].reversed;
        const int wanted = alike ? 1 - turned[queue[next]] : turned[queue[next]];
        if (turned[other] == 1 - wanted) return shell;
        if (turned[other] == wanted) continue;
        turned[other] = wanted;
        queue.push_back(other);
      }
    }
  }
  TopoDS_Shell result;
  BRep_Builder builder;
  builder.MakeShell(result);
  for (std::size_t f = 0; f < faces.size(); ++f) builder.Add(result, turned[f] == 1 ? faces[f].Reversed() : faces[f]);
  return result;
}

TopoDS_Shell shell_of(const TopoDS_Shape& face) {
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  builder.Add(shell, face);
  return shell;
}

/// All shells of a shape, and each face outside of shells as a shell of its own.
std::vector<TopoDS_Shell> shells_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shell> shells;
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next()) shells.push_back(TopoDS::Shell(it.Current()));
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    shells.push_back(shell_of(it.Current()));
  }
  return shells;
}

struct ClosedShell {
  TopoDS_Shell shell;
  double volume = 0;
  int parent = -1;  ///< the smallest larger shell around it
  int depth = 0;
};

bool contains(const TopoDS_Shell& outer, const TopoDS_Shell& inner) {
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, outer);
  BRepClass3d_SolidClassifier classifier(solid);
  classifier.PerformInfinitePoint(1e-7);
  const bool inside_out = classifier.State() == TopAbs_IN;
  for (TopExp_Explorer it(inner, TopAbs_VERTEX); it.More(); it.Next()) {
    classifier.Perform(BRep_Tool::Pnt(TopoDS::Vertex(it.Current())), 1e-7);
    if (classifier.State() == TopAbs_ON) continue;
    return (classifier.State() == TopAbs_IN) != inside_out;
  }
  return false;
}

/// Solids from closed shells: a shell inside another one is a void of it, one inside a void a solid again.
TopoDS_Compound solids_from(const std::vector<TopoDS_Shell>& shells) {
  std::vector<ClosedShell> closed;
  closed.reserve(shells.size());
  for (const TopoDS_Shell& shell : shells) closed.push_back({shell, std::abs(volume_of(shell))});
  std::stable_sort(closed.begin(), closed.end(),
                   [](const ClosedShell& a, const ClosedShell& b) { return a.volume > b.volume; });
  for (std::size_t i = 0; i < closed.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (contains(closed[j].shell, closed[i].shell)) closed[i].parent = static_cast<int>(j);
    }
    if (closed[i].parent >= 0) closed[i].depth = closed[static_cast<std::size_t>(closed[i].parent)].depth + 1;
  }
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  std::vector<TopoDS_Solid> solids(closed.size());
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const bool is_void = closed[i].depth % 2 == 1;
    if (!is_void) builder.MakeSolid(solids[i]);
    builder.Add(solids[is_void ? static_cast<std::size_t>(closed[i].parent) : i], closed[i].shell);
  }
  for (const TopoDS_Solid& solid : solids) {
    if (!solid.IsNull()) builder.Add(compound, solid);
  }
  return compound;
}

/// What sewing made of a part of the shape.
TopoDS_Shape sewn_image(const BRepBuilderAPI_Sewing& sewing, const TopoDS_Shape& part) {
  if (sewing.IsModified(part)) return sewing.Modified(part);
  if (sewing.IsModifiedSubShape(part)) return sewing.ModifiedSubShape(part);
  return part;
}

/// Is each edge walked once in either direction?
bool is_oriented(const TopoDS_Shell& shell) {
  const TopTools_IndexedMapOfShape edges = sub_shapes(shell, TopAbs_EDGE);
  std::vector<int> balance(static_cast<std::size_t>(edges.Extent()) + 1, 0);
  for (TopExp_Explorer it(shell, TopAbs_EDGE); it.More(); it.Next()) {
    if (BRep_Tool::Degenerated(TopoDS::Edge(it.Current()))) continue;
    balance[static_cast<std::size_t>(edges.FindIndex(it.Current()))] +=
        it.Current().Orientation() == TopAbs_REVERSED ? -1 : 1;
  }
  return std::all_of(balance.begin(), balance.end(), [](int sum) { return sum == 0; });
}

/// The outcome of sewing with one tolerance.
struct Seam {
  Handle(BRepBuilderAPI_Sewing) sewing;
  std::vector<TopoDS_Shell> closed;
  std::size_t open_shells = 0;  ///< open, or impossible to orient
  std::vector<TopoDS_Edge> open_edges;
};

/// How many faces sewing may join along an edge.
enum class FacesAtEdge { two, any };

Seam sew_with(const CadBody& body, double tolerance, FacesAtEdge faces_at_edge) {
  Seam seam;
  seam.sewing = new BRepBuilderAPI_Sewing(tolerance);
  seam.sewing->SetNonManifoldMode(faces_at_edge == FacesAtEdge::any);
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) seam.sewing->Add(faces(i));
  seam.sewing->Perform();
  if (seam.sewing->SewedShape().IsNull()) return seam;
  for (const TopoDS_Shell& shell : shells_of(seam.sewing->SewedShape())) {
    const std::vector<TopoDS_Edge> open = free_edges(shell);
    const TopoDS_Shell turned = oriented(shell);
    if (open.empty() && is_oriented(turned)) {
      seam.closed.push_back(turned);
    } else {
      ++seam.open_shells;
      seam.open_edges.insert(seam.open_edges.end(), open.begin(), open.end());
    }
  }
  return seam;
}

}  // namespace

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() || box.IsOpen() ? 1 : std::sqrt(box.SquareExtent());
}

std::vector<TopoDS_Edge> free_edges(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape edges = sub_shapes(shape, TopAbs_EDGE);
  std::vector<int> uses(static_cast<std::size_t>(edges.Extent()) + 1, 0);
  const auto one_sided = [](const TopoDS_Shape& part) {
    return part.Orientation() == TopAbs_FORWARD || part.Orientation() == TopAbs_REVERSED;
  };
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    if (!one_sided(face.Current())) continue;
    for (TopExp_Explorer edge(face.Current(), TopAbs_EDGE); edge.More(); edge.Next()) {
      if (one_sided(edge.Current())) ++uses[static_cast<std::size_t>(edges.FindIndex(edge.Current()))];
    }
  }
  std::vector<TopoDS_Edge> found;
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    if (uses[static_cast<std::size_t>(i)] == 1 && !BRep_Tool::Degenerated(edge)) found.push_back(edge);
  }
  return found;
}

SewingResult sew(CadBody& body) {
  const double diagonal = diagonal_of(body.shape);
  const auto complete = [](const Seam& seam) { return !seam.closed.empty() && seam.open_shells == 0; };
  Seam best;
  for (const double relative : {1e-6, 1e-5, 1e-4}) {
    Seam next = sew_with(body, relative * diagonal, FacesAtEdge::two);
    const bool first = best.sewing.IsNull();
    if (first || next.open_edges.size() < best.open_edges.size() || (best.closed.empty() && !next.closed.empty())) {
      best = std::move(next);
    }
    if (complete(best)) break;
    // Where a body touches itself along an edge, four faces meet, and in pairs they may be joined the wrong way.
    next = sew_with(body, relative * diagonal, FacesAtEdge::any);
    if (!complete(next)) continue;
    best = std::move(next);
    break;
  }
  SewingResult result{!best.closed.empty(), best.open_shells, best.open_edges};
  if (!result.any) return result;
  replace_shape(body, solids_from(best.closed),
                [&](const TopoDS_Shape& part) { return sewn_image(*best.sewing, part); });
  body.notes.push_back({"file", "faces sewn into " + std::to_string(body.solids.size()) + " solids"});
  if (best.open_shells > 0) {
    body.notes.push_back({"file", std::to_string(best.open_shells) + " shells stay open and are left out", true});
  }
  return result;
}

}  // namespace curvetet
