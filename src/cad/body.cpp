#include "cad/body.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace curvetet {

namespace {

/// Of each face's part in a volume.
constexpr double kVolumeError = 1e-5;
/// Of a volume, up to which two rules agree.
constexpr double kAgree = 1e-3;

double plain_volume(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

/// The faces of a shape, extrusions as the B-splines that they are.
TopoDS_Shape with_knots(const TopoDS_Shape& shape) {
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face face = TopoDS::Face(it.Current());
    const bool extrusion = BRepAdaptor_Surface(face, false).GetType() == GeomAbs_SurfaceOfExtrusion;
    builder.Add(faces, extrusion ? BRepBuilderAPI_NurbsConvert(face).Shape() : face);
  }
  return faces;
}

double adaptive_volume(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, kVolumeError, false, false);
  return properties.Mass();
}

}  // namespace

const char* type_name(TopAbs_ShapeEnum type) {
  switch (type) {
    case TopAbs_SOLID:
      return "solid";
    case TopAbs_FACE:
      return "face";
    case TopAbs_EDGE:
      return "edge";
    default:
      return "vertex";
  }
}

std::vector<Label>& labels_of(CadBody& body, TopAbs_ShapeEnum type) {
  switch (type) {
    case TopAbs_SOLID:
      return body.solids;
    case TopAbs_FACE:
      return body.faces;
    case TopAbs_EDGE:
      return body.edges;
    default:
      return body.vertices;
  }
}

const std::vector<Label>& labels_of(const CadBody& body, TopAbs_ShapeEnum type) {
  return labels_of(const_cast<CadBody&>(body), type);
}

TopTools_IndexedMapOfShape sub_shapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum type) {
  TopTools_IndexedMapOfShape map;
  if (!shape.IsNull()) TopExp::MapShapes(shape, type, map);
  return map;
}

std::vector<char> suppressed_edges(const CadBody& body) {
  std::set<std::uint32_t> ids;
  for (const SuppressedDetail& detail : body.suppressed)
    if (detail.kind == SuppressedDetail::Kind::edge) ids.insert(detail.label.cad_id);
  std::vector<char> suppressed{0};
  for (const Label& label : body.edges) suppressed.push_back(ids.contains(label.cad_id) ? 1 : 0);
  return suppressed;
}

void sort_suppressed(CadBody& body) {
  std::sort(body.suppressed.begin(), body.suppressed.end(), [](const auto& a, const auto& b) {
    return std::make_pair(a.kind, a.label.cad_id) < std::make_pair(b.kind, b.label.cad_id);
  });
}

// No rule of the kernel's is right everywhere: its plain Gauss rule is off by a percent on threads and bowls given as
// B-splines, its adaptive rule by a tenth on extrusions of closed splines, whose knots it does not see, and its
// Gauss-Kronrod rule may not end.
double volume_of(const TopoDS_Shape& shape) {
  const double plain = plain_volume(shape), adaptive = adaptive_volume(shape);
  if (std::abs(plain - adaptive) <= kAgree * std::abs(plain)) return adaptive;
  try {
    const double other = adaptive_volume(with_knots(shape));
    return std::abs(other - plain) < std::abs(adaptive - plain) ? other : adaptive;
  } catch (const Standard_Failure&) {
    return adaptive;
  }
}

void label_all(CadBody& body) {
  for (const TopAbs_ShapeEnum type : kLabelled) {
    auto& labels = labels_of(body, type);
    labels.assign(static_cast<std::size_t>(sub_shapes(body.shape, type).Extent()), Label());
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i].cad_id = static_cast<std::uint32_t>(i + 1);
  }
  body.solid_paths.assign(body.solids.size(), "");
  body.shared_product.assign(body.solids.size(), 0);
}

void replace_shape(CadBody& body, const TopoDS_Shape& shape,
                   const std::function<TopoDS_Shape(const TopoDS_Shape&)>& image) {
  const std::vector<std::string> old_paths = body.solid_paths;
  for (const TopAbs_ShapeEnum type : kLabelled) {
    const TopTools_IndexedMapOfShape before = sub_shapes(body.shape, type), after = sub_shapes(shape, type);
    const std::vector<Label> old = labels_of(body, type);
    std::vector<Label> labels(static_cast<std::size_t>(after.Extent()));
    std::vector<std::string> paths(labels.size());
    std::vector<char> taken(labels.size(), 0);
    std::uint32_t& next = body.last_ids[type];
    for (int i = 1; i <= before.Extent(); ++i) {
      const std::size_t from = static_cast<std::size_t>(i - 1);
      next = std::max(next, old[from].cad_id);
      const TopTools_IndexedMapOfShape parts = sub_shapes(image(before(i)), type);
      bool first = true;
      for (int k = 1; k <= parts.Extent(); ++k) {
        const auto to = static_cast<std::size_t>(after.FindIndex(parts(k))) - 1;
        if (to >= labels.size() || taken[to] != 0) continue;
        taken[to] = 1;
        labels[to] = old[from];
        if (!first) labels[to].cad_id = 0;  // an id names one part
        first = false;
        if (type == TopAbs_SOLID) paths[to] = old_paths[from];
      }
    }
    for (Label& label : labels) {
      if (label.cad_id == 0) label.cad_id = ++next;
    }
    labels_of(body, type) = std::move(labels);
    if (type == TopAbs_SOLID) body.solid_paths = std::move(paths);
  }
  body.shape = shape;
  body.measures = CadMeasures();
}

}  // namespace curvetet
