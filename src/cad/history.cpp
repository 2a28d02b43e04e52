#include "cad/history.h"

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include "cad/elementary.h"

namespace curvetet {
namespace {

bool is_swept_line(const TopoDS_Shape& face) {
  TopLoc_Location location;
  return !ElementarySurfaces::elementary(BRep_Tool::Surface(TopoDS::Face(face), location)).IsNull();
}

/// Appends what a builder made of the shape; the shape itself, if it left it alone.
void append_images(BOPAlgo_Builder& builder, const TopoDS_Shape& shape, TopTools_ListOfShape& list) {
  const TopTools_ListOfShape& made = builder.Modified(shape);
  if (made.IsEmpty() && !builder.IsDeleted(shape)) list.Append(shape);
  for (const TopoDS_Shape& image : made) list.Append(image);
}

}  // namespace

FuseHistory::FuseHistory(const CadBody& body) {
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  bool any = false;
  for (int i = 1; i <= faces.Extent() && !any; ++i) any = is_swept_line(faces(i));
  if (!any) return;
  modifier_.Init(body.shape);
  modifier_.Perform(new ElementarySurfaces());
  modified_ = modifier_.IsDone();
}

TopTools_ListOfShape FuseHistory::images(const TopoDS_Shape& part) {
  TopTools_ListOfShape list;
  list.Append(elementary(part));
  for (BOPAlgo_Builder* builder : builders_) {
    TopTools_ListOfShape next;
    for (const TopoDS_Shape& shape : list) append_images(*builder, shape, next);
    list = next;
  }
  return list;
}

bool FuseHistory::is_changed(const TopoDS_Shape& part) {
  const TopTools_ListOfShape list = images(part);
  return list.Extent() != 1 || !list.First().IsSame(elementary(part));
}

TopoDS_Shape FuseHistory::image(const TopoDS_Shape& part) {
  TopoDS_Compound parts;
  BRep_Builder builder;
  builder.MakeCompound(parts);
  for (const TopoDS_Shape& shape : images(part)) builder.Add(parts, shape);
  return parts;
}

void FuseHistory::note_faces(CadBody& body) {
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  TopTools_IndexedMapOfShape seen;
  std::vector<std::uint32_t> owner;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const std::uint32_t id = body.faces[static_cast<std::size_t>(i - 1)].cad_id;
    const TopTools_ListOfShape list = images(faces(i));
    const std::string entity = "face " + std::to_string(id);
    if (list.Extent() > 1) {
      body.notes.push_back({entity, "is split in " + std::to_string(list.Extent()) + " where others touch it"});
    }
    for (const TopoDS_Shape& shape : list) {
      const int known = seen.Extent(), at = seen.Add(shape);
      if (at > known) {
        owner.push_back(id);
      } else {
        const std::string other = std::to_string(owner[static_cast<std::size_t>(at - 1)]);
        body.notes.push_back({entity, "coincides with face " + other + " there and is shared with it"});
      }
    }
  }
}

}  // namespace curvetet
