// Two meshes of one place cross each other, so solids that touch must have the touching part in common. Boxes of faces
// tell cheaply that nothing touches. Fusing was kept away from single solids: the kernel's result is only trusted where
// every solid comes out as one, of the same volume.
#include "cad/fuse.h"

#include <BOPAlgo_Builder.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>

#include "cad/history.h"

namespace curvetet {
namespace {

constexpr double kVolume = 1e-4;  ///< relative change of a solid's volume that fusing may make

double volume_of(const TopoDS_Shape& solid) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(solid, properties, false, false, false);
  return properties.Mass();
}

struct FaceBox {
  Bnd_Box box;
  int face = 0, solid = 0;
};

/// Do the boxes of two faces of different solids meet, that the solids do not share?
bool may_touch(const TopTools_IndexedMapOfShape& solids) {
  std::vector<FaceBox> boxes;
  TopTools_IndexedMapOfShape faces;
  for (int s = 1; s <= solids.Extent(); ++s) {
    for (TopExp_Explorer it(solids(s), TopAbs_FACE); it.More(); it.Next()) {
      FaceBox entry;
      BRepBndLib::Add(it.Current(), entry.box, false);
      entry.face = faces.Add(it.Current());
      entry.solid = s;
      for (const FaceBox& other : boxes) {
        if (other.solid != s && other.face != entry.face && !other.box.IsOut(entry.box)) return true;
      }
      boxes.push_back(entry);
    }
  }
  return false;
}

class Fuse {
 public:
  explicit Fuse(CadBody& body) : body_(body), solids_(sub_shapes(body.shape, TopAbs_SOLID)), history_(body, builder_) {}

  Fusing run() {
    builder_.SetNonDestructive(true);
    builder_.SetUseOBB(true);
    for (int s = 1; s <= solids_.Extent(); ++s) {
      const TopoDS_Shape solid = history_.elementary(solids_(s));
      builder_.AddArgument(volume_of(solid) < 0 ? solid.Reversed() : solid);
    }
    builder_.Perform();
    if (builder_.HasErrors()) return fail("solids that touch could not be fused: the CAD kernel failed");
    if (!anything_changed()) return Fusing::apart;
    const auto overlap = overlapping_solid();
    if (overlap != 0) {
      return fail("solids that touch are not fused: solid " +
                  std::to_string(body_.solids[static_cast<std::size_t>(overlap - 1)].cad_id) + " overlaps another one");
    }
    replace();
    return Fusing::imprinted;
  }

 private:
  Fusing fail(const std::string& why) {
    body_.notes.push_back({"file", why});
    return Fusing::failed;
  }

  bool anything_changed() {
    for (const TopAbs_ShapeEnum type : {TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
      const TopTools_IndexedMapOfShape parts = sub_shapes(body_.shape, type);
      for (int i = 1; i <= parts.Extent(); ++i) {
        if (!builder_.Modified(history_.elementary(parts(i))).IsEmpty()) return true;
      }
    }
    return false;
  }

  /// The first solid that does not come out as one solid of its own with the same volume; 0 if there is none.
  int overlapping_solid() {
    TopTools_IndexedMapOfShape taken;
    for (int s = 1; s <= solids_.Extent(); ++s) {
      const TopTools_ListOfShape list = history_.images(solids_(s));
      if (list.Extent() != 1 || list.First().ShapeType() != TopAbs_SOLID) return s;
      const int known = taken.Extent();
      if (taken.Add(list.First()) <= known) return s;
      const double before = std::abs(volume_of(history_.elementary(solids_(s)))),
                   after = std::abs(volume_of(list.First()));
      if (!(std::abs(after - before) <= kVolume * before)) return s;
    }
    return 0;
  }

  void replace() {
    history_.note_faces(body_);
    TopoDS_Compound compound;
    BRep_Builder builder;
    builder.MakeCompound(compound);
    for (int s = 1; s <= solids_.Extent(); ++s) builder.Add(compound, history_.images(solids_(s)).First());
    for (TopExp_Explorer it(body_.shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next()) {
      builder.Add(compound, history_.elementary(it.Current()));
    }
    replace_shape(body_, compound, [&](const TopoDS_Shape& part) { return history_.image(part); });
  }

  CadBody& body_;
  TopTools_IndexedMapOfShape solids_;
  BOPAlgo_Builder builder_;
  FuseHistory history_;
};

}  // namespace

Fusing fuse_touching(CadBody& body) {
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  if (solids.Extent() < 2 || !may_touch(solids)) return Fusing::apart;
  return Fuse(body).run();
}

}  // namespace curvetet
