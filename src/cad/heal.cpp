// Healing is asked for by evidence: the shape is converted and checked as it is, and only where the check finds a fault
// are OpenCASCADE's repairs run, from the mildest to the strongest, keeping the result with the least faults. Running
// the repairs on everything was rejected: on sound shapes they change tolerances and merge edges, and they are slow.
// Then details are suppressed, if asked for; last, solids that touch are made to share what they touch in.
#include "cad/heal.h"

#include <fmt/format.h>

#include <BRep_Tool.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <algorithm>

#include "cad/cells.h"
#include "cad/complete_edges.h"
#include "cad/confirm_crossing.h"
#include "cad/convert.h"
#include "cad/empty_faces.h"
#include "cad/fuse.h"
#include "cad/guard.h"
#include "cad/occt_geometry.h"
#include "cad/overlap.h"
#include "cad/sew.h"
#include "cad/suppress.h"
#include "geometry/check.h"

namespace curvetet {
namespace {

Error open_shell(const CadBody& body, const std::string& source, const std::vector<TopoDS_Edge>& edges) {
  const std::string why = edges.empty() ? "its faces close around no volume, or cannot be turned to face outward"
                                        : std::to_string(edges.size()) + " free edges";
  if (const std::vector<std::string> unbounded = unbounded_faces(body); edges.empty() && !unbounded.empty())
    return {ErrorCode::unbounded, source + " is not bounded: a face reaches to infinity", unbounded};
  Error error{ErrorCode::open_shell, source + " is not closed: " + why};
  error.hint = "close the gaps in the CAD system, or export a solid instead of surfaces";
  if (edges.empty()) return error;
  const TopTools_IndexedMapOfShape map = sub_shapes(body.shape, TopAbs_EDGE);
  for (const TopoDS_Edge& edge : edges) {
    const int index = map.FindIndex(edge);
    if (index == 0) continue;
    error.entities.push_back("edge " + std::to_string(body.edges[static_cast<std::size_t>(index - 1)].cad_id));
    if (error.entities.size() == 20) break;
  }
  Standard_Real low = 0, high = 0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edges.front(), low, high);
  if (!curve.IsNull()) error.where = to_vec(curve->Value(0.5 * (low + high)).XYZ());
  return error;
}

std::optional<Error> make_solids(CadBody& body, const std::string& source) {
  CadBody sewn = body;
  const SewingResult result = sew(sewn);
  if (result.open_shells > 0 && result.open_edges.empty() && enclose_solids(body)) return std::nullopt;
  if (!result.any) return open_shell(body, source, result.open_edges);
  body = std::move(sewn);
  return std::nullopt;
}

std::optional<Error> close_solids(CadBody& body, const std::string& source) {
  if (sub_shapes(body.shape, TopAbs_FACE).IsEmpty()) return Error{ErrorCode::no_faces, source + " holds no faces"};
  if (body.solids.empty()) return make_solids(body, source);
  std::vector<TopoDS_Edge> open;
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  for (int i = 1; i <= solids.Extent() && open.empty(); ++i) open = free_edges(solids(i));
  if (open.empty()) return std::nullopt;
  // Sewing may close it; solids that it leaves open must not vanish from the body.
  CadBody sewn = body;
  const SewingResult result = sew(sewn);
  if (result.any && result.open_edges.empty()) body = std::move(sewn);
  return std::nullopt;
}

// --- repairs ---

constexpr std::size_t kSerious = 1000;
// Parts of the diagonal.
constexpr double kPrecision = 1e-7;
constexpr double kShort = 1e-5;  ///< a curve that ends farther from its vertex stops short; tolerances explain less

/// How bad the faults are: what the mesher cannot survive counts most.
std::size_t badness(const std::vector<ModelFault>& faults, double diagonal) {
  std::size_t sum = 0;
  for (const ModelFault& fault : faults) {
    const bool distance = fault.kind == ModelFault::Kind::vertex_off || fault.kind == ModelFault::Kind::curve_off;
    sum += distance && fault.amount <= CheckOptions{}.largest * diagonal ? 1 : kSerious;
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
  result.bad = result.model ? badness(result.faults, result.model.value().diagonal()) : 1000 * kSerious;
  return result;
}

/// Runs OpenCASCADE's repairs; whether they changed anything is not known.
bool fix_shape(CadBody& body) {
  const double diagonal = diagonal_of(body.shape);
  const Handle(ShapeFix_Shape) fix = new ShapeFix_Shape(body.shape);
  fix->SetPrecision(kPrecision * diagonal);
  fix->SetMaxTolerance(1e-3 * diagonal);
  fix->Perform();
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  const auto context = fix->Context();
  for (int i = 1; i <= faces.Extent(); ++i) {
    if (context->Apply(faces(i)).IsSame(faces(i))) continue;
    body.notes.push_back({"face " + std::to_string(body.faces[static_cast<std::size_t>(i - 1)].cad_id), "repaired"});
  }
  replace_shape(body, fix->Shape(), [&](const TopoDS_Shape& part) { return context->Apply(part); });
  return true;
}

/// Edges that only stop too soon have a border where their faces say, however far that is. False if there are none.
bool complete(CadBody& body) {
  const double diagonal = diagonal_of(body.shape);
  return complete_edges(body, kShort * diagonal, kPrecision * diagonal);
}

/// Two edges that are one within the precision need no face between them: facets of it would cross those around.
void close_up(Attempt& best, const std::string& source) {
  const auto& faces = best.model.value().faces;
  const double diagonal = best.model.value().diagonal();
  if (std::none_of(faces.begin(), faces.end(),
                   [&](const ModelFace& face) { return face.area < kPrecision * diagonal * diagonal; }))
    return;
  CadBody body = best.body;
  if (!drop_empty_faces(body, kPrecision * diagonal_of(body.shape))) return;
  Attempt next = attempt(std::move(body), source);
  if (next.bad <= best.bad && next.body.solids.size() == best.body.solids.size()) best = std::move(next);
}

// --- details ---

/// Of the body's diagonal: what is larger is no detail.
constexpr double kLargestFeature = 0.1;

/// In the body's own unit.
double length_in_unit_of(const CadBody& body, const Length& length) {
  const std::string& unit = length.unit.empty() ? body.unit : length.unit;
  return length.value * millimetres(unit).value_or(1) / millimetres(body.unit).value_or(1);
}

/// Takes the small details out of a body, but none whose loss would leave it more broken.
Status suppress(Attempt& best, const std::string& source, const Length& min_feature) {
  const double length = length_in_unit_of(best.body, min_feature);
  const Model& model = best.model.value();
  const double diagonal = model.frame.length_to_cad(model.diagonal());
  if (!(length >= 0 && length <= kLargestFeature * diagonal)) {
    return Error{
        ErrorCode::bad_option,
        fmt::format("min-feature must be from 0 (off) to a tenth of the body's diagonal, {:.6g} {}; it is {:.6g}",
                    diagonal, best.body.unit, length)};
  }
  if (length == 0) return Done{};
  const auto without_details = [&](const std::function<bool(const CadBody&)>& is_sound) {
    CadBody body = best.body;
    suppress_details(body, length, is_sound);
    return attempt(std::move(body), source);
  };
  // The detail may be what is broken. To convert the body after each one takes long; it is done only if one does harm.
  const std::size_t allowed = std::max(best.bad, kSerious - 1);
  Attempt next = without_details([](const CadBody&) { return true; });
  if (next.bad > allowed) {
    next = without_details([&](const CadBody& body) { return attempt(body, source).bad <= allowed; });
  }
  best = std::move(next);
  return Done{};
}

// --- solids that touch ---

/// Solids that touch stay apart: a note, or an error if they must not.
Status leave_apart(Attempt& best, const std::string& source, Conformal conformal, const std::string& why) {
  if (conformal == Conformal::strict) {
    return Error{ErrorCode::not_conformal,
                 "the mesh of " + source + " would not be conformal: " + why,
                 {},
                 {},
                 "imprint the solids in the CAD system, or ask for less than strict conformity"};
  }
  const HealingNote note{"file", why + " (--conformal off meshes them apart)", true};
  best.body.notes.push_back(note);
  best.model.value().healing.push_back(note);
  return Done{};
}

/// Imprints and merges solids that touch; the result is kept unless it is worse. An error if solids overlap
/// that must not.
Status join(Attempt& best, const std::string& source, const Joining& joining) {
  if (joining.overlaps == Overlaps::refuse) {
    if (const auto error = find_overlap(best.body, source)) return *error;
  }
  CadBody fused = best.body;
  const Result<Fusing> fusing = fuse_touching(fused, joining.overlaps, source);
  if (!fusing) return fusing.error();
  if (fusing.value() == Fusing::apart) return Done{};
  if (fusing.value() == Fusing::failed) return leave_apart(best, source, joining.conformal, fused.notes.back().what);
  Attempt next = attempt(std::move(fused), source);
  if (next.bad >= kSerious) {
    return leave_apart(best, source, joining.conformal,
                       "solids that touch are not fused: the fused shape would be broken");
  }
  best = std::move(next);
  return Done{};
}

Error fault_error(const Attempt& result, const std::string& source) {
  std::vector<std::string> entities;
  const ModelFault* first = nullptr;
  for (const ModelFault& fault : result.faults) {
    if (badness({fault}, result.model.value().diagonal()) < kSerious) continue;
    if (first == nullptr) first = &fault;
    if (entities.size() < 20 && (entities.empty() || entities.back() != fault.entity)) entities.push_back(fault.entity);
  }
  if (first->kind == ModelFault::Kind::solid_open) {
    const TopTools_IndexedMapOfShape solids = sub_shapes(result.body.shape, TopAbs_SOLID);
    for (int i = 1; i <= solids.Extent(); ++i) {
      if (const auto open = free_edges(solids(i)); !open.empty()) return open_shell(result.body, source, open);
    }
  }
  const auto code_of = [](ModelFault::Kind kind) {
    if (kind == ModelFault::Kind::solid_open) return ErrorCode::open_shell;
    return kind == ModelFault::Kind::crosses_itself ? ErrorCode::self_intersection : ErrorCode::bad_face;
  };
  std::optional<Vec3> place;
  if (first->where) place = result.model.value().frame.to_cad(*first->where);
  return Error{code_of(first->kind), first->entity + " of " + source + " " + first->what, entities, place,
               "repair it in the CAD system, or export with a tighter tolerance"};
}

}  // namespace

Result<Model> heal_and_convert(CadBody& body, const std::string& source, const HealOptions& options) {
  const QuietMessages quiet;
  return guarded(ErrorCode::reader_failed, "cannot repair the shape in " + source, [&]() -> Result<Model> {
    if (const auto error = close_solids(body, source)) return *error;
    Attempt best = attempt(body, source);
    if (best.model) close_up(best, source);
    // Distances alone are measured and told; the repairs seldom lessen them.
    if (best.bad >= kSerious) {
      for (const auto repair : {complete, fix_shape}) {
        CadBody repaired = best.body;
        if (!repair(repaired)) continue;
        Attempt next = attempt(std::move(repaired), source);
        // A solid that vanishes takes its faults along.
        if (next.bad < best.bad && next.body.solids.size() >= best.body.solids.size()) best = std::move(next);
        if (best.bad < kSerious) break;
      }
    }
    if (!best.model) return best.model.error();
    if (options.min_feature.value != 0) {
      if (const Status suppressed = suppress(best, source, options.min_feature); !suppressed) return suppressed.error();
    }
    if (best.bad >= kSerious) return fault_error(best, source);
    if (options.joining.conformal != Conformal::off) {
      if (const Status joined = join(best, source, options.joining); !joined) return joined.error();
    }
    body = std::move(best.body);
    if (!options.suspects.empty()) {
      if (const auto crossing = confirm_crossing(body, options.suspects, source)) return *crossing;
    }
    for (const ModelFault& fault : best.faults) {
      const HealingNote note{fault.entity, fault.what + " (left as it is)"};
      body.notes.push_back(note);
      best.model.value().healing.push_back(note);
    }
    return std::move(best.model);
  });
}

}  // namespace curvetet
