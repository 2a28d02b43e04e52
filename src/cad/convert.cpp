// Only what the solids' faces need becomes part of the Model, in ascending order of id. Which side of a face a solid
// lies on follows from the face's orientation in the solid's shells; shells that are inside out, by the sign of their
// volume, are turned first, since many writers get this wrong and every later stage trusts it.
#include "cad/convert.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cad/fit.h"
#include "cad/guard.h"
#include "cad/join_vertices.h"
#include "cad/loops.h"
#include "cad/occt_geometry.h"
#include "geometry/bounds.h"
#include "geometry/settle_vertices.h"
#include "geometry/touching_edges.h"

namespace curvetet {
namespace {

constexpr double kInfinite = 1e50;
/// The kernel's box may be larger than the body by this factor before the frame is made anew from the body itself.
constexpr double kLooseBox = 3;
/// A solid whose volume over its area to the power 3/2 is less than this has none (a ball has 0.09).
constexpr double kFlat = 1e-10;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A face as one shell of a solid uses it.
struct FaceUse {
  int face = 0;  ///< index in the map of faces
  bool reversed = false, internal = false;
};

struct ShellUse {
  TopoDS_Shape shell;
  std::vector<FaceUse> faces;
  double volume = 0;
  bool flipped = false;
};

class Converter {
 public:
  Converter(CadBody& body, const std::string& source)
      : body_(body),
        source_(source),
        notes_(body.notes),
        solids_(sub_shapes(body.shape, TopAbs_SOLID)),
        faces_(sub_shapes(body.shape, TopAbs_FACE)),
        edges_(sub_shapes(body.shape, TopAbs_EDGE)),
        vertices_(sub_shapes(body.shape, TopAbs_VERTEX)) {
    body_.measures.face_areas.resize(static_cast<std::size_t>(faces_.Extent()), kUnknown);
  }

  Result<Model> run() {
    if (faces_.IsEmpty()) return Error{ErrorCode::no_faces, source_ + " holds no faces"};
    if (solids_.IsEmpty()) return Error{ErrorCode::no_solid, source_ + " holds no solid"};
    if (const auto error = find_box()) return *error;
    if (const auto error = collect_shells()) return *error;
    mark_used();
    suppressed_ = suppressed_edges(body_);
    joined_ = join_vertices(vertices_, edges_, solids_, loose_box_.diagonal(), suppressed_);
    note_joined();
    make_parts(Frame::of(loose_box_));
    if (loose_box_.diagonal() > kLooseBox * model_.frame.length_to_cad(model_.box.diagonal())) {
      Box3 box;
      box.extend(model_.frame.to_cad(model_.box.low));
      box.extend(model_.frame.to_cad(model_.box.high));
      if (box.diagonal() > 0) make_parts(Frame::of(box));
    }
    if (const auto error = make_solids()) return *error;
    settle_vertices(model_);
    list_faces_of_edges();
    part_touching_edges(model_);
    return std::move(model_);
  }

 private:
  void note(const std::string& entity, const std::string& what, bool is_warning = false) {
    model_.healing.push_back({entity, what, is_warning});
  }
  static std::string entity(const char* kind, const Label& label) {
    return kind + std::string(" ") + std::to_string(label.cad_id);
  }
  const Label& face_label(int face) const { return body_.faces[static_cast<std::size_t>(face - 1)]; }
  const Label& solid_label(int solid) const { return body_.solids[static_cast<std::size_t>(solid - 1)]; }

  // --- solids and their shells ---

  std::optional<Error> collect_shells() {
    shells_.resize(static_cast<std::size_t>(solids_.Extent()));
    std::optional<Error> flat;
    bool any = false;
    for (int s = 1; s <= solids_.Extent(); ++s) {
      auto& shells = shells_[static_cast<std::size_t>(s - 1)];
      shells = shells_of(s);
      const std::string solid = entity("solid", solid_label(s));
      if (shells.empty()) {
        notes_.push_back({solid, "has no faces and is left out", true});
      } else if (without_volume(shells)) {
        notes_.push_back({solid, "has no volume and is left out", true});
        flat = Error{ErrorCode::zero_size, solid + " of " + source_ + " has no volume", {solid}};
        shells.clear();
      } else {
        orient_shells(shells, solid);
        any = true;
      }
    }
    if (any) return std::nullopt;
    return flat ? flat : Error{ErrorCode::no_solid, source_ + " holds no solid with faces"};
  }

  std::vector<ShellUse> shells_of(int solid) {
    std::vector<ShellUse> shells;
    for (TopExp_Explorer shell(solids_(solid), TopAbs_SHELL); shell.More(); shell.Next()) {
      ShellUse use;
      use.shell = shell.Current();
      for (TopExp_Explorer face(use.shell, TopAbs_FACE); face.More(); face.Next()) {
        const TopAbs_Orientation orientation = face.Current().Orientation();
        if (orientation == TopAbs_EXTERNAL) continue;
        use.faces.push_back(
            {faces_.FindIndex(face.Current()), orientation == TopAbs_REVERSED, orientation == TopAbs_INTERNAL});
      }
      const std::size_t number = shell_count_++;
      if (use.faces.empty()) continue;
      use.volume = shell_volume(use.shell, number);
      shells.push_back(std::move(use));
    }
    return shells;
  }

  double shell_volume(const TopoDS_Shape& shell, std::size_t number) {
    auto& volumes = body_.measures.shell_volumes;
    if (volumes.size() <= number) volumes.resize(number + 1, kUnknown);
    if (std::isnan(volumes[number])) volumes[number] = volume_of(shell);
    return volumes[number];
  }

  double face_area(int face) {
    double& area = body_.measures.face_areas[static_cast<std::size_t>(face - 1)];
    if (std::isnan(area)) {
      GProp_GProps properties;
      BRepGProp::SurfaceProperties(faces_(face), properties, false, false);
      area = std::abs(properties.Mass());
    }
    return area;
  }

  /// Two layers of faces that cancel, for example.
  bool without_volume(const std::vector<ShellUse>& shells) {
    double volume = 0, area = 0;
    for (const ShellUse& shell : shells) {
      volume += std::abs(shell.volume);
      for (const FaceUse& use : shell.faces) area += face_area(use.face);
    }
    return volume <= kFlat * std::pow(area, 1.5);
  }

  void mark_used() {
    face_used_.assign(static_cast<std::size_t>(faces_.Extent()) + 1, 0);
    edge_used_.assign(static_cast<std::size_t>(edges_.Extent()) + 1, 0);
    vertex_used_.assign(static_cast<std::size_t>(vertices_.Extent()) + 1, 0);
    for (const auto& shells : shells_) {
      for (const ShellUse& shell : shells) {
        for (const FaceUse& use : shell.faces) face_used_[static_cast<std::size_t>(use.face)] = 1;
      }
    }
    for (int f = 1; f <= faces_.Extent(); ++f) {
      if (face_used_[static_cast<std::size_t>(f)] == 0) {
        ++ignored_;
        continue;
      }
      const TopTools_IndexedMapOfShape edges = sub_shapes(faces_(f), TopAbs_EDGE);
      for (int e = 1; e <= edges.Extent(); ++e) edge_used_[static_cast<std::size_t>(edges_.FindIndex(edges(e)))] = 1;
      const TopTools_IndexedMapOfShape vertices = sub_shapes(faces_(f), TopAbs_VERTEX);
      for (int v = 1; v <= vertices.Extent(); ++v) {
        vertex_used_[static_cast<std::size_t>(vertices_.FindIndex(vertices(v)))] = 1;
      }
    }
  }

  void make_parts(const Frame& frame) {
    model_ = Model();
    next_edge_label_ = body_.last_ids[TopAbs_EDGE];
    next_vertex_label_ = body_.last_ids[TopAbs_VERTEX];
    model_.frame = frame;
    model_.unit = body_.unit;
    model_.file_unit = body_.file_unit;
    model_.healing = notes_;
    model_.suppressed = body_.suppressed;
    if (ignored_ > 0) note("file", std::to_string(ignored_) + " faces that belong to no solid are left out", true);
    make_vertices();
    make_edges();
    make_faces();
    model_.box = sampled_box(model_);
    fit_parameter_curves(model_);
  }

  std::optional<Error> find_box() {
    Bnd_Box box;
    for (int s = 1; s <= solids_.Extent(); ++s) BRepBndLib::Add(solids_(s), box, false);
    if (box.IsVoid()) return Error{ErrorCode::zero_size, source_ + " has no extent"};
    const auto limit = [](const Bnd_Box& b) {
      Box3 limits;
      Standard_Real x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
      b.Get(x0, y0, z0, x1, y1, z1);
      limits.extend({x0, y0, z0});
      limits.extend({x1, y1, z1});
      return limits;
    };
    const auto largest = [](const Box3& b) {
      double m = 0;
      for (int i = 0; i < 3; ++i) m = std::max({m, std::abs(b.low[i]), std::abs(b.high[i])});
      return m;
    };
    Box3 limits = limit(box);
    if (box.IsOpen() || largest(limits) > kInfinite) {
      return Error{ErrorCode::unbounded, source_ + " is not bounded: a face reaches to infinity",
                   unbounded_faces(body_)};
    }
    if (!finite(limits.low) || !finite(limits.high)) {
      return Error{ErrorCode::not_finite, source_ + " has coordinates that are not finite numbers"};
    }
    if (!(limits.diagonal() > 0)) return Error{ErrorCode::zero_size, source_ + " has no extent"};
    loose_box_ = limits;
    return std::nullopt;
  }

  // --- vertices and edges ---

  double working(double length) const { return model_.frame.length_to_working(length); }

  void make_vertices() {
    vertex_id_.assign(vertex_used_.size(), CadVertexId());
    for (int v = 1; v <= vertices_.Extent(); ++v) {
      const std::size_t index = static_cast<std::size_t>(v);
      next_vertex_label_ = std::max(next_vertex_label_, body_.vertices[index - 1].cad_id);
      const std::size_t stands_for = static_cast<std::size_t>(joined_.vertex[index]);
      if (vertex_used_[index] == 0) continue;
      if (!vertex_id_[stands_for].valid()) {
        const TopoDS_Vertex& shape = TopoDS::Vertex(vertices_(joined_.vertex[index]));
        vertex_id_[stands_for] =
            add_vertex(body_.vertices[stands_for - 1], model_.frame.to_working(to_vec(BRep_Tool::Pnt(shape).XYZ())),
                       working(joined_.tolerance[stands_for]));
      }
      vertex_id_[index] = vertex_id_[stands_for];
    }
  }

  void note_joined() {
    for (int v = 1; v <= vertices_.Extent(); ++v) {
      const int other = joined_.vertex[static_cast<std::size_t>(v)];
      if (other == v || vertex_used_[static_cast<std::size_t>(v)] == 0) continue;
      const TopoDS_Vertex &one = TopoDS::Vertex(vertices_(v)), &stands_for = TopoDS::Vertex(vertices_(other));
      const bool explained = BRep_Tool::Pnt(one).Distance(BRep_Tool::Pnt(stands_for)) <= BRep_Tool::Tolerance(one);
      notes_.push_back({entity("vertex", body_.vertices[static_cast<std::size_t>(v - 1)]),
                        "is joined to " + entity("vertex", body_.vertices[static_cast<std::size_t>(other - 1)]) +
                            (explained ? ", within its tolerance" : ", since the edge between them is suppressed")});
    }
  }

  CadVertexId add_vertex(const Label& label, Vec3 point, double tolerance) {
    ModelVertex vertex;
    vertex.label = label;
    vertex.point = snap(point);
    vertex.tolerance = tolerance;
    return model_.vertices.push_back(vertex);
  }

  CadVertexId vertex_of(const TopoDS_Vertex& vertex) const {
    return vertex.IsNull() ? CadVertexId() : vertex_id_[static_cast<std::size_t>(vertices_.FindIndex(vertex))];
  }

  void make_edges() {
    edge_id_.assign(edge_used_.size(), EdgeId());
    for (const Label& label : body_.edges) next_edge_label_ = std::max(next_edge_label_, label.cad_id);
    for (int e = 1; e <= edges_.Extent(); ++e) {
      const std::size_t index = static_cast<std::size_t>(e);
      if (edge_used_[index] != 0) edge_id_[index] = add_edge(e);
    }
  }

  EdgeId add_edge(int number) {
    const TopoDS_Edge shape = TopoDS::Edge(edges_(number).Oriented(TopAbs_FORWARD));
    const bool suppressed = suppressed_[static_cast<std::size_t>(number)] != 0;
    ModelEdge edge;
    edge.label = body_.edges[static_cast<std::size_t>(number - 1)];
    // What is left of a suppressed edge is a pole like those that are put in: not of the input.
    if (suppressed) edge.label = {++next_edge_label_, {}, {}};
    edge.tolerance = working(BRep_Tool::Tolerance(shape));
    Standard_Real low = 0, high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(shape, low, high);
    edge.degenerate = BRep_Tool::Degenerated(shape) || curve.IsNull();
    if (edge.degenerate) BRep_Tool::Range(shape, low, high);
    edge.low = low;
    edge.high = high;
    TopoDS_Vertex start, end;
    TopExp::Vertices(shape, start, end);
    edge.start = vertex_of(start);
    edge.end = vertex_of(end);
    if (!edge.degenerate) {
      std::unique_ptr<Curve> made = make_curve(curve, model_.frame);
      edge.steps = steps_along(*made, low, high);
      edge.curve = evened(std::move(made), edge.steps);
    }
    complete_ends(edge);
    const bool point = joined_.point[static_cast<std::size_t>(number)] != 0;
    if (!edge.degenerate && (point || shrunk_to_point(edge))) {
      if (!suppressed) note(entity("edge", edge.label), "is shorter than its tolerance and taken as a point");
      edge.degenerate = true;
      edge.curve = nullptr;
    }
    if (edge.degenerate && edge.low == edge.high) edge.high = edge.low + 1;  // its uses stay at one point
    return model_.edges.push_back(std::move(edge));
  }

  /// A closed curve may come without a vertex.
  void complete_ends(ModelEdge& edge) {
    if (edge.start.valid() && edge.end.valid()) return;
    if (edge.start.valid() || edge.end.valid()) {
      (edge.start.valid() ? edge.end : edge.start) = edge.start.valid() ? edge.start : edge.end;
      return;
    }
    if (edge.degenerate || !(edge.low < edge.high)) return;
    Label label;
    label.cad_id = ++next_vertex_label_;
    edge.start = edge.end = add_vertex(label, edge.curve->value(edge.low), edge.tolerance);
    note(entity("edge", edge.label), "had no vertex; one was put on it");
  }

  bool shrunk_to_point(const ModelEdge& edge) const {
    if (!edge.start.valid() || edge.start != edge.end || !(edge.low < edge.high)) return false;
    const Vec3 first = edge.curve->value(edge.low);
    for (int i = 1; i <= 16; ++i) {
      if (distance(edge.curve->value(edge.low + (edge.high - edge.low) * i / 16), first) > edge.tolerance) return false;
    }
    return true;
  }

  EdgeId add_pole(CadVertexId vertex) {
    ModelEdge edge;
    edge.label.cad_id = ++next_edge_label_;
    edge.low = 0;
    edge.high = 1;
    edge.start = edge.end = vertex;
    edge.tolerance = model_.vertices[vertex].tolerance;
    edge.degenerate = true;
    return model_.edges.push_back(std::move(edge));
  }

  // --- faces ---

  void make_faces() {
    face_id_.assign(face_used_.size(), FaceId());
    LoopContext context;
    context.model = &model_;
    context.edge = [this](const TopoDS_Edge& edge) {
      return edge_id_[static_cast<std::size_t>(edges_.FindIndex(edge))];
    };
    context.add_pole = [this](CadVertexId vertex) { return add_pole(vertex); };
    for (int f = 1; f <= faces_.Extent(); ++f) {
      const std::size_t index = static_cast<std::size_t>(f);
      if (face_used_[index] == 0) continue;
      const std::size_t edges_before = model_.edges.size();
      face_id_[index] = add_face(f, context);
      if (model_.edges.size() > edges_before) note(entity("face", face_label(f)), "a pole was put in");
    }
  }

  FaceId add_face(int number, const LoopContext& context) {
    const TopoDS_Face& shape = TopoDS::Face(faces_(number));
    ModelFace face;
    face.label = face_label(number);
    face.tolerance = working(BRep_Tool::Tolerance(shape));
    const Handle(Geom_Surface) geometry = BRep_Tool::Surface(shape);
    if (geometry.IsNull()) return model_.faces.push_back(std::move(face));
    const std::shared_ptr<Surface> surface = make_surface(geometry, model_.frame);
    face.surface = surface;
    if (trace_loops(shape, context, face) > 0) note(entity("face", face.label), "an inner wire is turned");
    surface->set_domain(face.low, face.high);
    for (TopoDS_Iterator it(shape.Oriented(TopAbs_FORWARD)); it.More(); it.Next()) {
      if (it.Value().ShapeType() != TopAbs_VERTEX) continue;
      const TopoDS_Vertex& vertex = TopoDS::Vertex(it.Value());
      // The parameters stored with the vertex may be missing.
      const gp_Pnt2d uv =
          ShapeAnalysis_Surface(geometry).ValueOfUV(BRep_Tool::Pnt(vertex), BRep_Tool::Tolerance(vertex));
      face.internal_vertices.push_back(vertex_of(vertex));
      face.internal_vertex_uv.push_back({uv.X(), uv.Y()});
    }
    face.area = face_area(number) * model_.frame.scale * model_.frame.scale;
    return model_.faces.push_back(std::move(face));
  }

  // --- solids ---

  std::optional<Error> make_solids() {
    side_set_.assign(model_.faces.size(), 0);
    for (int s = 1; s <= solids_.Extent(); ++s) {
      ModelSolid solid;
      solid.label = solid_label(s);
      solid.path = body_.solid_paths[static_cast<std::size_t>(s - 1)];
      auto& shells = shells_[static_cast<std::size_t>(s - 1)];
      if (shells.empty()) continue;
      double volume = 0;
      for (const ShellUse& shell : shells) volume += shell.flipped ? -shell.volume : shell.volume;
      solid.volume = volume * std::pow(model_.frame.scale, 3);
      const SolidId id = model_.solids.push_back(std::move(solid));
      for (const ShellUse& shell : shells) {
        for (const FaceUse& use : shell.faces) {
          if (auto error = put_on_side(use, shell.flipped, id)) return error;
        }
      }
      auto& faces = model_.solids[id].faces;
      std::sort(faces.begin(), faces.end());
      faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
    return std::nullopt;
  }

  /// The largest shell must have a positive volume; another one a negative volume if it lies inside of the largest.
  void orient_shells(std::vector<ShellUse>& shells, const std::string& solid) {
    std::size_t outer = 0;
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (std::abs(shells[i].volume) > std::abs(shells[outer].volume)) outer = i;
    }
    if (shells[outer].volume < 0) {
      for (ShellUse& shell : shells) shell.flipped = true;
      notes_.push_back({solid, "was inside out and is turned"});
    }
    for (std::size_t i = 0; i < shells.size(); ++i) {
      if (i == outer) continue;
      const double volume = shells[i].flipped ? -shells[i].volume : shells[i].volume;
      if (volume > 0 && lies_inside(shells[i], shells[outer])) {
        shells[i].flipped = !shells[i].flipped;
        notes_.push_back({solid, "a void in it was inside out and is turned"});
      }
    }
  }

  static bool lies_inside(const ShellUse& shell, const ShellUse& outer) {
    TopoDS_Solid solid;
    BRep_Builder builder;
    builder.MakeSolid(solid);
    builder.Add(solid, outer.shell);
    BRepClass3d_SolidClassifier classifier(solid);
    classifier.PerformInfinitePoint(1e-7);
    const bool inside_out = classifier.State() == TopAbs_IN;
    for (TopExp_Explorer vertex(shell.shell, TopAbs_VERTEX); vertex.More(); vertex.Next()) {
      classifier.Perform(BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())), 1e-7);
      if (classifier.State() == TopAbs_IN) return !inside_out;
      if (classifier.State() == TopAbs_OUT) return inside_out;
    }
    return false;
  }

  std::optional<Error> put_on_side(const FaceUse& use, bool flipped, SolidId solid) {
    const FaceId id = face_id_[static_cast<std::size_t>(use.face)];
    ModelFace& face = model_.faces[id];
    model_.solids[solid].faces.push_back(id);
    const auto clash = [&](SolidId other) {
      const Label& a = model_.solids[other].label;
      const Label& b = model_.solids[solid].label;
      return Error{ErrorCode::overlapping_solids,
                   "solids " + std::to_string(a.cad_id) + " and " + std::to_string(b.cad_id) +
                       " lie on the same side of face " + std::to_string(face.label.cad_id) + " of " + source_,
                   {entity("solid", a), entity("solid", b), entity("face", face.label)},
                   {},
                   "cut one solid out of the other in the CAD system"};
    };
    if (use.internal) {
      face.front = face.back = solid;
      return std::nullopt;
    }
    const bool reversed = use.reversed != flipped;
    if (side_set_[id.value()] == 0) {
      side_set_[id.value()] = 1;
      face.reversed = reversed;
      face.back = solid;
      return std::nullopt;
    }
    SolidId& side = face.reversed == reversed ? face.back : face.front;
    if (side.valid()) return clash(side);
    side = solid;
    return std::nullopt;
  }

  void list_faces_of_edges() {
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      const auto add = [&](const EdgeUse& use) {
        auto& faces = model_.edges[use.edge].faces;
        if (faces.empty() || faces.back() != FaceId(f)) faces.push_back(FaceId(f));
      };
      const ModelFace& face = model_.faces[FaceId(f)];
      for (const Loop& loop : face.loops) std::for_each(loop.uses.begin(), loop.uses.end(), add);
      std::for_each(face.internal_edges.begin(), face.internal_edges.end(), add);
    }
  }

  CadBody& body_;
  const std::string& source_;
  std::vector<HealingNote> notes_;
  TopTools_IndexedMapOfShape solids_, faces_, edges_, vertices_;
  std::vector<std::vector<ShellUse>> shells_;  ///< by solid
  std::vector<char> face_used_, edge_used_, vertex_used_;
  std::vector<char> side_set_;
  std::vector<FaceId> face_id_;
  std::vector<EdgeId> edge_id_;
  std::vector<CadVertexId> vertex_id_;
  std::uint32_t next_vertex_label_ = 0, next_edge_label_ = 0;
  std::size_t ignored_ = 0, shell_count_ = 0;
  std::vector<char> suppressed_;  ///< by edge
  JoinedVertices joined_;
  Box3 loose_box_;
  Model model_;
};

}  // namespace

Result<Model> convert_body(CadBody& body, const std::string& source) {
  return guarded(ErrorCode::reader_failed, "cannot use the shape in " + source,
                 [&] { return Converter(body, source).run(); });
}

std::vector<std::string> unbounded_faces(const CadBody& body) {
  std::vector<std::string> found;
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  for (int f = 1; f <= faces.Extent() && found.size() < 20; ++f) {
    Bnd_Box box;
    BRepBndLib::Add(faces(f), box, false);
    Standard_Real x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
    if (box.IsVoid()) continue;
    box.Get(x0, y0, z0, x1, y1, z1);
    const double largest = std::max({-x0, -y0, -z0, x1, y1, z1});
    if (box.IsOpen() || largest > kInfinite)
      found.push_back("face " + std::to_string(body.faces[static_cast<std::size_t>(f - 1)].cad_id));
  }
  return found;
}

}  // namespace curvetet
