// The kernel's defeaturing (see suppress.h) extends the faces around a detail until they meet, and fails where they do
// already: here they are only sewn.
#include "cad/empty_faces.h"

#include <fmt/format.h>

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepTools_ReShape.hxx>
#include <TopExp_Explorer.hxx>
#include <cstdint>
#include <set>
#include <vector>

#include "cad/narrow_faces.h"

namespace curvetet {
namespace {

/// Notes what sewing made of parts of a face.
void note_parts(BRepBuilderAPI_Sewing& sewing, const TopoDS_Shape& face, TopAbs_ShapeEnum type,
                BRepTools_ReShape& change) {
  for (TopExp_Explorer part(face, type); part.More(); part.Next())
    if (sewing.IsModifiedSubShape(part.Current()))
      change.Replace(part.Current(), sewing.ModifiedSubShape(part.Current()));
}

/// Sews the other faces of a solid that has empty ones; notes what became of them and of their parts.
void sew_others(const TopoDS_Shape& solid, const TopTools_IndexedMapOfShape& empty, double width,
                BRepTools_ReShape& change) {
  BRepBuilderAPI_Sewing sewing(width);
  std::vector<TopoDS_Shape> others;
  bool any = false;
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next()) {
    if (empty.Contains(face.Current())) {
      change.Remove(face.Current());
      any = true;
    } else {
      sewing.Add(face.Current());
      others.push_back(face.Current());
    }
  }
  if (!any) return;
  sewing.Perform();
  for (const TopoDS_Shape& face : others) {
    if (sewing.IsModified(face)) change.Replace(face, sewing.Modified(face));
    note_parts(sewing, face, TopAbs_EDGE, change);
    note_parts(sewing, face, TopAbs_VERTEX, change);
  }
}

}  // namespace

bool drop_empty_faces(CadBody& body, double width) {
  std::set<std::uint32_t> ids;
  std::vector<SuppressedDetail> dropped;
  for (const std::vector<NarrowFace>& group : narrow_faces(body, width))
    for (const NarrowFace& face : group) {
      ids.insert(face.cad_id);
      dropped.push_back(detail_of(body, face));
    }
  if (dropped.empty()) return false;
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  TopTools_IndexedMapOfShape empty;
  for (int f = 1; f <= faces.Extent(); ++f)
    if (ids.contains(body.faces[static_cast<std::size_t>(f - 1)].cad_id)) empty.Add(faces(f));
  const Handle(BRepTools_ReShape) change = new BRepTools_ReShape;
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  for (int i = 1; i <= solids.Extent(); ++i) sew_others(solids(i), empty, width, *change);
  replace_shape(body, change->Apply(body.shape), [&](const TopoDS_Shape& part) { return change->Value(part); });
  for (const SuppressedDetail& detail : dropped)
    body.notes.push_back({fmt::format("face {}", detail.label.cad_id), "has no area and is left out"});
  body.suppressed.insert(body.suppressed.end(), dropped.begin(), dropped.end());
  sort_suppressed(body);
  return true;
}

}  // namespace curvetet
