// Faces go by the kernel's defeaturing, which extends their neighbours until they meet: the result is exact. Edges are
// only chosen here: join_vertices.h makes points of them while the body is converted, so that its wires stay closed and
// its curves as they are. ShapeFix_Wireframe was rejected, since it bends and merges the neighbours of what it drops.
// Sets of faces are tried as a whole first (a bore with its ground, a rounded rim), then in parts.
#include "cad/suppress.h"

#include <fmt/format.h>

#include <BRepAlgoAPI_Defeaturing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "cad/guard.h"
#include "cad/join_vertices.h"
#include "cad/narrow_faces.h"
#include "cad/occt_geometry.h"
#include "cad/sew.h"
#include "geometry/check.h"

namespace curvetet {
namespace {

constexpr const char* kFails = "the CAD kernel fails";
constexpr const char* kBroken = "the body would be broken";

using Ids = std::set<std::uint32_t>;

/// Why a detail cannot go.
using Refusal = std::optional<std::string>;

std::string entity(SuppressedDetail::Kind kind, std::uint32_t id) { return fmt::format("{} {}", name(kind), id); }

Ids ids_of(const CadBody& body, TopAbs_ShapeEnum type) {
  Ids ids;
  for (const Label& label : labels_of(body, type)) ids.insert(label.cad_id);
  return ids;
}

/// Edges that bound no face of a set.
Ids edges_beyond(const CadBody& body, const Ids& faces) {
  const TopTools_IndexedMapOfShape all = sub_shapes(body.shape, TopAbs_FACE);
  const TopTools_IndexedMapOfShape edges = sub_shapes(body.shape, TopAbs_EDGE);
  Ids beyond = ids_of(body, TopAbs_EDGE);
  for (int f = 1; f <= all.Extent(); ++f) {
    if (!faces.contains(body.faces[static_cast<std::size_t>(f - 1)].cad_id)) continue;
    for (TopExp_Explorer edge(all(f), TopAbs_EDGE); edge.More(); edge.Next())
      beyond.erase(body.edges[static_cast<std::size_t>(edges.FindIndex(edge.Current()) - 1)].cad_id);
  }
  return beyond;
}

bool lacks_none(const Ids& ids, const Ids& wanted) {
  return std::includes(ids.begin(), ids.end(), wanted.begin(), wanted.end());
}

TopoDS_Compound empty_compound() {
  TopoDS_Compound compound;
  BRep_Builder().MakeCompound(compound);
  return compound;
}

/// What one body's solids have for faces that the other body lacks.
TopoDS_Compound faces_beyond(const CadBody& body, const CadBody& other) {
  const TopTools_IndexedMapOfShape known = sub_shapes(other.shape, TopAbs_FACE);
  TopoDS_Compound faces = empty_compound();
  for (TopExp_Explorer solid(body.shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next())
      if (!known.Contains(face.Current())) BRep_Builder().Add(faces, face.Current());
  }
  return faces;
}

std::size_t count_open(const CadBody& body) {
  std::size_t open = 0;
  for (TopExp_Explorer solid(body.shape, TopAbs_SOLID); solid.More(); solid.Next())
    open += free_edges(solid.Current()).size();
  return open;
}

/// Volume between the faces of two bodies that they do not share: together these close around it.
double volume_between(const TopoDS_Compound& before, const TopoDS_Compound& after) {
  TopoDS_Compound both = empty_compound();
  for (TopExp_Explorer face(after, TopAbs_FACE); face.More(); face.Next()) BRep_Builder().Add(both, face.Current());
  for (TopExp_Explorer face(before, TopAbs_FACE); face.More(); face.Next())
    BRep_Builder().Add(both, face.Current().Reversed());
  return std::abs(volume_of(both));
}

class Suppressor {
 public:
  Suppressor(CadBody& body, double length, const std::function<bool(const CadBody&)>& is_sound)
      : body_(body),
        length_(length),
        reach_(std::min(length, CheckOptions{}.largest * diagonal_of(body.shape))),
        is_sound_(is_sound) {}

  void run() {
    for (const std::vector<NarrowFace>& group : narrow_faces(body_, length_)) remove_group(group);
    join_edges();
    sort_suppressed(body_);
  }

 private:
  // --- faces ---

  /// All at once, or the compact ones among them and each strip on its own.
  void remove_group(const std::vector<NarrowFace>& group) {
    const Refusal refusal = remove(group);
    if (!refusal) return;
    if (group.size() == 1) return leave(group.front(), *refusal);
    std::vector<NarrowFace> compact;
    std::copy_if(group.begin(), group.end(), std::back_inserter(compact),
                 [](const NarrowFace& f) { return f.compact; });
    const bool together = compact.size() > 1 && compact.size() < group.size() && !remove(compact);
    for (const NarrowFace& face : group) {
      if (face.compact && together) continue;
      if (const Refusal alone = remove({face})) leave(face, *alone);
    }
  }

  void leave(const NarrowFace& face, const std::string& why) {
    note(SuppressedDetail::Kind::face, face.cad_id, fmt::format("is {:.3g} wide and left: {}", face.width, why));
    left_.insert(face.cad_id);
  }

  void note(SuppressedDetail::Kind kind, std::uint32_t id, const std::string& what) {
    body_.notes.push_back({entity(kind, id), what});
  }

  Refusal remove(const std::vector<NarrowFace>& group) {
    Refusal refusal;
    const Status tried = guarded(ErrorCode::reader_failed, kFails, [&]() -> Status {
      refusal = try_remove(group);
      return Done{};
    });
    return tried ? refusal : tried.error().message;
  }

  Refusal try_remove(const std::vector<NarrowFace>& group) {
    const TopoDS_Compound faces = faces_of(group);
    BRepAlgoAPI_Defeaturing builder;
    builder.SetShape(body_.shape);
    for (TopExp_Explorer face(faces, TopAbs_FACE); face.More(); face.Next()) builder.AddFaceToRemove(face.Current());
    builder.Build();
    if (!builder.IsDone() || builder.HasErrors() || builder.HasWarnings())
      return "the faces around do not close without it";
    CadBody next = body_;
    replace_shape(next, builder.Shape(), [&](const TopoDS_Shape& part) -> TopoDS_Shape {
      if (builder.IsDeleted(part)) return {};
      TopoDS_Compound images = empty_compound();
      for (const TopoDS_Shape& image : builder.Modified(part)) BRep_Builder().Add(images, image);
      return builder.Modified(part).IsEmpty() ? part : TopoDS_Shape(images);
    });
    if (Refusal refusal = judge_removal(next, group, faces)) return refusal;
    commit(std::move(next), group);
    return std::nullopt;
  }

  TopoDS_Compound faces_of(const std::vector<NarrowFace>& group) const {
    Ids wanted;
    for (const NarrowFace& face : group) wanted.insert(face.cad_id);
    const TopTools_IndexedMapOfShape all = sub_shapes(body_.shape, TopAbs_FACE);
    TopoDS_Compound faces = empty_compound();
    for (int f = 1; f <= all.Extent(); ++f) {
      if (wanted.contains(body_.faces[static_cast<std::size_t>(f - 1)].cad_id)) BRep_Builder().Add(faces, all(f));
    }
    return faces;
  }

  Refusal judge_removal(const CadBody& next, const std::vector<NarrowFace>& group, const TopoDS_Shape& faces) {
    Ids kept = ids_of(body_, TopAbs_FACE), gone;
    double area = 0;
    for (const NarrowFace& face : group) {
      gone.insert(face.cad_id);
      area += face.area;
    }
    for (const std::uint32_t id : gone) kept.erase(id);
    if (ids_of(next, TopAbs_FACE) != kept || !lacks_none(ids_of(next, TopAbs_EDGE), edges_beyond(body_, gone)))
      return "other faces or edges would go with it";
    if (ids_of(next, TopAbs_SOLID) != ids_of(body_, TopAbs_SOLID)) return "solids would vanish or fall apart";
    if (count_open(next) > count_open(body_)) return "a solid would be open";
    if (!BRepCheck_Analyzer(faces_beyond(next, body_)).IsValid()) return "the faces around would be broken";
    if (moves_too_far(next, faces) ||
        !(volume_between(faces_beyond(body_, next), faces_beyond(next, body_)) <= area * length_))
      return "the body would change by more than the length";
    if (!is_sound_(next)) return kBroken;
    return std::nullopt;
  }

  /// Does a vertex move by more than the length, or a new one lie farther than that from the faces that went?
  bool moves_too_far(const CadBody& next, const TopoDS_Shape& faces) const {
    std::map<std::uint32_t, gp_Pnt> places;
    const TopTools_IndexedMapOfShape before = sub_shapes(body_.shape, TopAbs_VERTEX);
    for (int v = 1; v <= before.Extent(); ++v)
      places.emplace(body_.vertices[static_cast<std::size_t>(v - 1)].cad_id, BRep_Tool::Pnt(TopoDS::Vertex(before(v))));
    const TopTools_IndexedMapOfShape after = sub_shapes(next.shape, TopAbs_VERTEX);
    for (int v = 1; v <= after.Extent(); ++v) {
      const gp_Pnt place = BRep_Tool::Pnt(TopoDS::Vertex(after(v)));
      const auto known = places.find(next.vertices[static_cast<std::size_t>(v - 1)].cad_id);
      if (known != places.end() && known->second.Distance(place) <= length_) continue;
      const BRepExtrema_DistShapeShape distance(after(v), faces);
      if (!distance.IsDone() || !(distance.Value() <= length_)) return true;
    }
    return false;
  }

  void commit(CadBody next, const std::vector<NarrowFace>& group) {
    for (const NarrowFace& face : group) next.suppressed.push_back(detail_of(body_, face));
    body_ = std::move(next);
  }

  // --- edges ---

  void join_edges() {
    const std::vector<SuppressedDetail> edges = short_edges();
    if (edges.empty() || !contract(edges)) return;
    for (const SuppressedDetail& edge : edges) {
      if (const Refusal refusal = contract({edge})) leave(edge, *refusal);
    }
  }

  void leave(const SuppressedDetail& edge, const std::string& why) {
    note(edge.kind, edge.label.cad_id, fmt::format("is {:.3g} long and left: {}", edge.size, why));
  }

  /// Those of solids between two vertices, the shortest first. The sides of narrow faces that stay are left: joined,
  /// they would pinch these.
  std::vector<SuppressedDetail> short_edges() {
    const TopTools_IndexedMapOfShape edges = sub_shapes(body_.shape, TopAbs_EDGE);
    const std::map<std::uint32_t, std::uint32_t> sides = sides_of_left();
    TopTools_IndexedMapOfShape of_solids;
    for (TopExp_Explorer solid(body_.shape, TopAbs_SOLID); solid.More(); solid.Next())
      TopExp::MapShapes(solid.Current(), TopAbs_EDGE, of_solids);
    std::vector<SuppressedDetail> found;
    for (int e = 1; e <= edges.Extent(); ++e) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges(e));
      if (!of_solids.Contains(edge) || BRep_Tool::Degenerated(edge)) continue;
      if (TopExp::FirstVertex(edge).IsSame(TopExp::LastVertex(edge))) continue;
      GProp_GProps properties;
      BRepGProp::LinearProperties(edge, properties);
      if (!(properties.Mass() < length_)) continue;
      const SuppressedDetail detail{SuppressedDetail::Kind::edge, body_.edges[static_cast<std::size_t>(e - 1)],
                                    properties.Mass(), to_vec(properties.CentreOfMass().XYZ())};
      if (const auto side = sides.find(detail.label.cad_id); side != sides.end())
        leave(detail, fmt::format("it bounds face {}", side->second));
      else
        found.push_back(detail);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.size < b.size; });
    return found;
  }

  /// Each edge of a narrow face that stays, with that face.
  std::map<std::uint32_t, std::uint32_t> sides_of_left() const {
    const TopTools_IndexedMapOfShape faces = sub_shapes(body_.shape, TopAbs_FACE);
    const TopTools_IndexedMapOfShape edges = sub_shapes(body_.shape, TopAbs_EDGE);
    std::map<std::uint32_t, std::uint32_t> sides;
    for (int f = 1; f <= faces.Extent(); ++f) {
      const std::uint32_t id = body_.faces[static_cast<std::size_t>(f - 1)].cad_id;
      if (!left_.contains(id)) continue;
      for (TopExp_Explorer edge(faces(f), TopAbs_EDGE); edge.More(); edge.Next())
        sides.emplace(body_.edges[static_cast<std::size_t>(edges.FindIndex(edge.Current()) - 1)].cad_id, id);
    }
    return sides;
  }

  Refusal contract(const std::vector<SuppressedDetail>& edges) {
    CadBody next = body_;
    next.suppressed.insert(next.suppressed.end(), edges.begin(), edges.end());
    if (reach_of_joins(next) > reach_) return "with its neighbours it is too long to be one vertex";
    if (!is_sound_(next)) return kBroken;
    body_ = std::move(next);
    return std::nullopt;
  }

  /// The largest tolerance of a vertex that suppressed edges become.
  static double reach_of_joins(const CadBody& body) {
    const TopTools_IndexedMapOfShape vertices = sub_shapes(body.shape, TopAbs_VERTEX);
    const TopTools_IndexedMapOfShape edges = sub_shapes(body.shape, TopAbs_EDGE);
    const std::vector<char> asked = suppressed_edges(body);
    const JoinedVertices joined = join_vertices(vertices, edges, {}, 0, asked);
    double reach = 0;
    for (int e = 1; e <= edges.Extent(); ++e) {
      if (asked[static_cast<std::size_t>(e)] == 0) continue;
      const auto end = static_cast<std::size_t>(vertices.FindIndex(TopExp::FirstVertex(TopoDS::Edge(edges(e)))));
      reach = std::max(reach, joined.tolerance[static_cast<std::size_t>(joined.vertex[end])]);
    }
    return reach;
  }

  CadBody& body_;
  double length_;
  double reach_;  ///< how far an edge may lie from the vertex that it becomes
  const std::function<bool(const CadBody&)>& is_sound_;
  Ids left_;  ///< faces that are narrow and stay
};

}  // namespace

void suppress_details(CadBody& body, double length, const std::function<bool(const CadBody&)>& is_sound) {
  Suppressor(body, length, is_sound).run();
}

}  // namespace curvetet
