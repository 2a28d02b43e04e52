// Healing is asked for by evidence: the shape is converted and checked as it is, and only where the check finds a fault
// are OpenCASCADE's repairs run, from the mildest to the strongest, keeping the result with the least faults. Running
// the repairs on everything was rejected: on sound shapes they change tolerances and merge edges, and they are slow.
#include "cad/heal.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>

#include "cad/convert.h"
#include "cad/guard.h"
#include "cad/occt_geometry.h"
#include "geometry/check.h"

namespace curvetet {
namespace {

double diagonal_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() || box.IsOpen() ? 1 : std::sqrt(box.SquareExtent());
}

// --- free edges ---

/// Edges that the faces of a shape use once in all; faces embedded in a solid do not count.
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

Error open_shell(const CadBody& body, const std::string& source, const std::vector<TopoDS_Edge>& edges) {
  Error error{ErrorCode::open_shell, source + " is not closed: " + std::to_string(edges.size()) + " free edges"};
  error.hint = "close the gaps in the CAD system, or export a solid instead of surfaces";
  if (edges.empty()) return error;
  const TopTools_IndexedMapOfShape map = sub_shapes(body.shape, TopAbs_EDGE);
  for (const TopoDS_Edge& edge : edges) {
    const int index = map.FindIndex(edge);
    if (index != 0)
      error.entities.push_back("edge " + std::to_string(body.edges[static_cast<std::size_t>(index - 1)].cad_id));
    if (error.entities.size() == 20) break;
  }
  Standard_Real low = 0, high = 0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edges.front(), low, high);
  if (!curve.IsNull()) error.where = to_vec(curve->Value(0.5 * (low + high)).XYZ());
  return error;
}

// --- sewing ---

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
  for (const TopoDS_Shell& shell : shells) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shell, properties, false, false, false);
    closed.push_back({shell, std::abs(properties.Mass())});
  }
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

/// Tries growing tolerances. True when solids were made; the body is then replaced.
bool sew(CadBody& body, std::vector<TopoDS_Edge>& left_open) {
  const double diagonal = diagonal_of(body.shape);
  for (const double relative : {1e-6, 1e-5, 1e-4}) {
    BRepBuilderAPI_Sewing sewing(relative * diagonal);
    const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
    for (int i = 1; i <= faces.Extent(); ++i) sewing.Add(faces(i));
    sewing.Perform();
    if (sewing.SewedShape().IsNull()) continue;
    std::vector<TopoDS_Shell> closed;
    left_open.clear();
    std::size_t open_count = 0;
    for (const TopoDS_Shell& shell : shells_of(sewing.SewedShape())) {
      const std::vector<TopoDS_Edge> open = free_edges(shell);
      if (open.empty()) {
        closed.push_back(shell);
      } else {
        ++open_count;
        left_open.insert(left_open.end(), open.begin(), open.end());
      }
    }
    const bool last = relative == 1e-4;
    if (closed.empty() || (open_count > 0 && !last)) continue;
    replace_shape(body, solids_from(closed), [&](const TopoDS_Shape& part) { return sewn_image(sewing, part); });
    body.notes.push_back({"file", "faces sewn into " + std::to_string(body.solids.size()) + " solids"});
    if (open_count > 0) {
      body.notes.push_back({"file", std::to_string(open_count) + " shells stay open and are left out"});
    }
    return true;
  }
  return false;
}

std::optional<Error> close_solids(CadBody& body, const std::string& source) {
  if (sub_shapes(body.shape, TopAbs_FACE).IsEmpty()) return Error{ErrorCode::no_faces, source + " holds no faces"};
  std::vector<TopoDS_Edge> open;
  if (body.solids.empty()) {
    if (!sew(body, open)) return open_shell(body, source, open);
    return std::nullopt;
  }
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  for (int i = 1; i <= solids.Extent() && open.empty(); ++i) open = free_edges(solids(i));
  if (open.empty()) return std::nullopt;
  const Error error = open_shell(body, source, open);
  // Sewing may close it; solids that it leaves open must not vanish from the body.
  CadBody sewn = body;
  if (!sew(sewn, open) || !open.empty()) return error;
  body = std::move(sewn);
  return std::nullopt;
}

// --- repairs ---

/// How bad the faults are: what the mesher cannot survive counts most.
std::size_t badness(const std::vector<ModelFault>& faults) {
  std::size_t sum = 0;
  for (const ModelFault& fault : faults) {
    const bool distance = fault.kind == ModelFault::Kind::vertex_off || fault.kind == ModelFault::Kind::curve_off;
    sum += distance ? 1 : 1000;
  }
  return sum;
}

struct Attempt {
  CadBody body;
  Result<Model> model = Error{};
  std::vector<ModelFault> faults;
  std::size_t bad = 0;
};

Attempt attempt(CadBody body, const std::string& source) {
  Attempt result;
  result.body = std::move(body);
  result.model = convert_body(result.body, source);
  if (result.model) result.faults = check_model(result.model.value());
  result.bad = result.model ? badness(result.faults) : 1000000;
  return result;
}

void fix_shape(CadBody& body) {
  const double diagonal = diagonal_of(body.shape);
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(body.shape);
  fix->SetPrecision(1e-7 * diagonal);
  fix->SetMaxTolerance(1e-3 * diagonal);
  fix->Perform();
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  const auto context = fix->Context();
  for (int i = 1; i <= faces.Extent(); ++i) {
    if (context->Apply(faces(i)).IsSame(faces(i))) continue;
    body.notes.push_back({"face " + std::to_string(body.faces[static_cast<std::size_t>(i - 1)].cad_id), "repaired"});
  }
  replace_shape(body, fix->Shape(), [&](const TopoDS_Shape& part) { return context->Apply(part); });
}

Error fault_error(const Attempt& result, const std::string& source) {
  std::vector<std::string> entities;
  const ModelFault* first = nullptr;
  for (const ModelFault& fault : result.faults) {
    if (badness({fault}) < 1000) continue;
    if (first == nullptr) first = &fault;
    if (entities.size() < 20 && (entities.empty() || entities.back() != fault.entity)) entities.push_back(fault.entity);
  }
  const bool open = first->kind == ModelFault::Kind::solid_open;
  return Error{open ? ErrorCode::open_shell : ErrorCode::bad_face,
               first->entity + " of " + source + " " + first->what,
               entities,
               {},
               "repair it in the CAD system, or export with a tighter tolerance"};
}

}  // namespace

Result<Model> heal_and_convert(CadBody& body, const std::string& source) {
  const QuietMessages quiet;
  return guarded(ErrorCode::reader_failed, "cannot repair the shape in " + source, [&]() -> Result<Model> {
    if (const auto error = close_solids(body, source)) return *error;
    Attempt best = attempt(body, source);
    if (best.bad > 0) {
      CadBody fixed = body;
      fix_shape(fixed);
      Attempt next = attempt(std::move(fixed), source);
      if (next.bad < best.bad) best = std::move(next);
    }
    if (!best.model) return best.model.error();
    if (best.bad >= 1000) return fault_error(best, source);
    body = std::move(best.body);
    for (const ModelFault& fault : best.faults) {
      const HealingNote note{fault.entity, fault.what + " (left as it is)"};
      body.notes.push_back(note);
      best.model.value().healing.push_back(note);
    }
    return std::move(best.model);
  });
}

}  // namespace curvetet
