// Two meshes of one place cross each other, so solids that touch must have the touching part in common. Boxes of faces
// tell cheaply that nothing touches. Fusing was kept away from single solids: the kernel's result is only trusted where
// every solid keeps its volume. Solids that overlap are not given to one of their owners: each would then lack a
// part of its boundary; what is common is a cell of its own, and the user says whose it is.
#include "cad/fuse.h"

#include <fmt/format.h>

#include <BOPAlgo_Builder.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <deque>
#include <gp_Pnt.hxx>
#include <vector>

#include "cad/history.h"
#include "cad/occt_geometry.h"
#include "cad/overlap.h"

namespace curvetet {
namespace {

/// Solids that are fused at once.
constexpr std::size_t kGroup = 20;
/// A second fuse takes for coincident what is closer than this many times the mean thickness of what solids have in
/// common.
constexpr double kHairs = 4;
constexpr double kVolume = 1e-4;  ///< relative change of a solid's volume that fusing may make

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
  Fuse(CadBody& body, double tolerance)
      : body_(body), tolerance_(tolerance), solids_(sub_shapes(body.shape, TopAbs_SOLID)), history_(body) {}

  Result<Fusing> run(Overlaps overlaps, const std::string& source) {
    if (!build()) return fail("solids that touch could not be fused: the CAD kernel failed");
    if (!anything_changed()) return Fusing::apart;
    if (const auto changed = changed_solid(); changed != 0) {
      return fail("solids that touch are not fused: " + name_of(changed) + " would change its volume");
    }
    if (overlaps == Overlaps::refuse) {
      if (const auto overlap = common_cell()) return overlap_error(body_, *overlap, source);
      if (const int split = split_solid(); split != 0)
        return fail("solids that touch are not fused: " + name_of(split) + " overlaps another one, by a hair");
    }
    replace();
    return Fusing::imprinted;
  }

  /// Mean thickness of the thickest cell that is of two solids, of those that only tolerances explain; 0 if there is
  /// none.
  double hair() const { return hair_; }

 private:
  Fusing fail(const std::string& why) {
    body_.notes.push_back({"file", why});
    return Fusing::failed;
  }

  /// Fuses neighbours first, then what became of them: the kernel holds each pair of faces that meet against all that
  /// meet anywhere, so a hundred solids at once take it a minute.
  bool build() {
    const std::vector<TopTools_ListOfShape> groups = groups_of_neighbours();
    TopTools_ListOfShape fused;
    for (const TopTools_ListOfShape& group : groups) {
      if (!fuse(group)) return false;
      fused.Append(builders_.back().Shape());
    }
    return groups.size() == 1 || fuse(fused);
  }

  bool fuse(const TopTools_ListOfShape& shapes) {
    BOPAlgo_Builder& builder = builders_.emplace_back();
    builder.SetNonDestructive(true);
    builder.SetUseOBB(true);
    builder.SetFuzzyValue(tolerance_);
    for (const TopoDS_Shape& shape : shapes) builder.AddArgument(shape);
    builder.Perform();
    history_.add(builder);
    return !builder.HasErrors();
  }

  /// Halves the solids across the longest side of the box of their middles, again and again, until few are left.
  std::vector<TopTools_ListOfShape> groups_of_neighbours() {
    std::vector<std::pair<gp_Pnt, TopoDS_Shape>> solids;
    for (int s = 1; s <= solids_.Extent(); ++s) {
      const TopoDS_Shape solid = history_.elementary(solids_(s));
      Bnd_Box box;
      BRepBndLib::Add(solid, box, false);
      const gp_Pnt middle = box.IsVoid() ? gp_Pnt() : gp_Pnt(0.5 * (box.CornerMin().XYZ() + box.CornerMax().XYZ()));
      solids.emplace_back(middle, volume_of(solid) < 0 ? solid.Reversed() : solid);
    }
    std::vector<TopTools_ListOfShape> groups;
    collect_groups(solids.begin(), solids.end(), groups);
    return groups;
  }

  template <class Iterator>
  static void collect_groups(Iterator begin, Iterator end, std::vector<TopTools_ListOfShape>& groups) {
    if (static_cast<std::size_t>(end - begin) <= kGroup) {
      TopTools_ListOfShape& group = groups.emplace_back();
      for (Iterator it = begin; it != end; ++it) group.Append(it->second);
      return;
    }
    Bnd_Box box;
    for (Iterator it = begin; it != end; ++it) box.Add(it->first);
    const gp_XYZ sides = box.CornerMax().XYZ() - box.CornerMin().XYZ();
    const int axis = sides.X() >= sides.Y() && sides.X() >= sides.Z() ? 1 : sides.Y() >= sides.Z() ? 2 : 3;
    std::stable_sort(begin, end,
                     [axis](const auto& a, const auto& b) { return a.first.Coord(axis) < b.first.Coord(axis); });
    collect_groups(begin, begin + (end - begin) / 2, groups);
    collect_groups(begin + (end - begin) / 2, end, groups);
  }

  bool anything_changed() {
    // A solid that lies in another one splits that one, but none of its parts.
    for (const TopAbs_ShapeEnum type : {TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX}) {
      const TopTools_IndexedMapOfShape parts = sub_shapes(body_.shape, type);
      for (int i = 1; i <= parts.Extent(); ++i) {
        if (history_.is_changed(parts(i))) return true;
      }
    }
    return false;
  }

  std::string name_of(int solid) const {
    return "solid " + std::to_string(body_.solids[static_cast<std::size_t>(solid - 1)].cad_id);
  }

  /// Of a plate with the cell's volume and surface.
  static double thickness(const TopoDS_Shape& cell, double volume) {
    GProp_GProps surface;
    BRepGProp::SurfaceProperties(cell, surface);
    return surface.Mass() > 0 ? 2 * volume / surface.Mass() : 0;
  }

  /// The first cell that is of two solids and thicker than their tolerances.
  std::optional<Overlap> common_cell() {
    TopTools_IndexedMapOfShape cells;
    std::vector<int> owner;
    for (int s = 1; s <= solids_.Extent(); ++s) {
      for (const TopoDS_Shape& cell : history_.images(solids_(s))) {
        const auto at = static_cast<std::size_t>(cells.Add(cell)) - 1;
        if (at == owner.size()) {
          owner.push_back(s);
        } else if (const auto found = overlap_of(owner[at], s, cell)) {
          return found;
        }
      }
    }
    return std::nullopt;
  }

  /// The kernel takes what lies in a void for common if the void's shell is turned the wrong way.
  std::optional<Overlap> overlap_of(int one, int two, const TopoDS_Shape& cell) {
    const double volume = std::abs(volume_of(cell));
    if (const double hair = thickness(cell, volume); hair <= overlap_depth(body_)) {
      hair_ = std::max(hair_, hair);
      return std::nullopt;
    }
    GProp_GProps middle;
    BRepGProp::VolumeProperties(cell, middle);
    const Vec3 place = to_vec(middle.CentreOfMass().XYZ());
    if (!is_inside(solids_(one), place) || !is_inside(solids_(two), place)) return std::nullopt;
    return Overlap{one, two, volume, place};
  }

  /// The first solid that does not come out as one cell of its own; 0 if there is none.
  int split_solid() {
    TopTools_IndexedMapOfShape taken;
    for (int s = 1; s <= solids_.Extent(); ++s) {
      const TopTools_ListOfShape list = history_.images(solids_(s));
      const int known = taken.Extent();
      if (list.Extent() != 1 || taken.Add(list.First()) <= known) return s;
    }
    return 0;
  }

  /// The first solid whose cells are no solids, or do not add up to its volume; 0 if there is none.
  int changed_solid() {
    for (int s = 1; s <= solids_.Extent(); ++s) {
      const double before = std::abs(volume_of(history_.elementary(solids_(s))));
      double after = 0;
      for (const TopoDS_Shape& cell : history_.images(solids_(s))) {
        if (cell.ShapeType() != TopAbs_SOLID) return s;
        after += std::abs(volume_of(cell));
      }
      if (!(std::abs(after - before) <= kVolume * before)) return s;
    }
    return 0;
  }

  void replace() {
    history_.note_faces(body_);
    TopoDS_Compound compound;
    BRep_Builder builder;
    builder.MakeCompound(compound);
    TopTools_IndexedMapOfShape cells;
    std::vector<std::vector<int>> owners;  // of each cell
    for (int s = 1; s <= solids_.Extent(); ++s) {
      for (const TopoDS_Shape& cell : history_.images(solids_(s))) {
        const auto at = static_cast<std::size_t>(cells.Add(cell)) - 1;
        if (at == owners.size()) {
          builder.Add(compound, cell);
          owners.emplace_back();
        }
        owners[at].push_back(s);
      }
    }
    for (TopExp_Explorer it(body_.shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next()) {
      builder.Add(compound, history_.elementary(it.Current()));
    }
    const std::vector<Label> before = body_.solids;
    replace_shape(body_, compound, [&](const TopoDS_Shape& part) { return history_.image(part); });
    const TopTools_IndexedMapOfShape after = sub_shapes(compound, TopAbs_SOLID);
    for (std::size_t c = 0; c < owners.size(); ++c) {
      if (owners[c].size() < 2) continue;
      name_common(body_.solids[static_cast<std::size_t>(after.FindIndex(cells(static_cast<int>(c) + 1))) - 1],
                  owners[c], before);
    }
  }

  /// Names a cell after the solids that have it in common.
  void name_common(Label& cell, const std::vector<int>& owners, const std::vector<Label>& solids) {
    std::string ids;
    cell.name.clear();
    for (const int s : owners) {
      const Label& owner = solids[static_cast<std::size_t>(s - 1)];
      const std::string id = std::to_string(owner.cad_id);
      ids += (ids.empty() ? "solid " : " and solid ") + id;
      cell.name += (cell.name.empty() ? "" : " & ") + (owner.name.empty() ? "solid_" + id : owner.name);
    }
    body_.notes.push_back({"solid " + std::to_string(cell.cad_id), "is what " + ids + " have in common"});
  }

  CadBody& body_;
  double hair_ = 0;
  double tolerance_;  ///< what is closer than that coincides, besides the tolerances of the parts
  TopTools_IndexedMapOfShape solids_;
  std::deque<BOPAlgo_Builder> builders_;
  FuseHistory history_;
};

}  // namespace

Result<Fusing> fuse_touching(CadBody& body, Overlaps overlaps, const std::string& source) {
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  if (solids.Extent() < 2) return Fusing::apart;
  // A solid may lie in another one without a face near a face.
  if (overlaps == Overlaps::refuse && !may_touch(solids)) return Fusing::apart;
  CadBody exact = body;
  Fuse first(exact, 0);
  Result<Fusing> outcome = first.run(overlaps, source);
  if (!outcome || outcome.value() != Fusing::failed || first.hair() == 0) {
    body = std::move(exact);
    return outcome;
  }
  const double tolerance = std::min(kHairs * first.hair(), overlap_depth(body));
  Result<Fusing> joined = Fuse(body, tolerance).run(overlaps, source);
  if (joined && joined.value() == Fusing::imprinted)
    body.notes.push_back({"file", fmt::format("solids overlap by a hair; joined where closer than {:.3g}", tolerance)});
  return joined;
}

}  // namespace curvetet
