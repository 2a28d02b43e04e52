// Where solids touch, four faces meet in one edge, and sewing pairs them as it likes. Imprinting needs no pairs.
// Telling solids from the voids between them by the faces' orientation was rejected: in files of loose faces it is at
// random.
#include "cad/cells.h"

#include <BOPAlgo_MakerVolume.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <array>
#include <optional>

#include "cad/history.h"

namespace curvetet {
namespace {

/// A face of the imprinted body: how many of the input's faces lie there, and the cells on its sides.
struct Wall {
  int inputs = 0;
  std::array<int, 2> cells{-1, -1};  ///< -1: outside of all
  int cell_count = 0;
};

class Cells {
 public:
  Cells(const CadBody& body, const TopTools_IndexedMapOfShape& cells, FuseHistory& history) : cells_(cells) {
    for (int c = 0; c < cells.Extent(); ++c) {
      for (TopExp_Explorer it(cells(c + 1), TopAbs_FACE); it.More(); it.Next()) {
        Wall& wall = wall_of(it.Current());
        if (wall.cell_count < 2) wall.cells[static_cast<std::size_t>(wall.cell_count)] = c;
        ++wall.cell_count;
      }
    }
    const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
    for (int f = 1; f <= faces.Extent(); ++f) {
      for (const TopoDS_Shape& image : history.images(faces(f))) ++wall_of(image).inputs;
    }
    is_solid_.resize(static_cast<std::size_t>(cells.Extent()));
  }

  /// The cells that are solids; empty if the faces contradict each other, or one bounds no solid.
  std::vector<TopoDS_Shape> solids() {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Wall& wall : walls_) changed |= spread(wall);
    }
    for (const Wall& wall : walls_) {
      const bool one = is_solid(wall.cells[0]).value_or(false), two = is_solid(wall.cells[1]).value_or(false);
      const int sides = (one ? 1 : 0) + (two ? 1 : 0);
      if (wall.cell_count > 2 || sides != wall.inputs) return {};
    }
    std::vector<TopoDS_Shape> found;
    for (int c = 0; c < cells_.Extent(); ++c) {
      if (is_solid(c).value_or(false)) found.push_back(cells_(c + 1));
    }
    return found;
  }

 private:
  Wall& wall_of(const TopoDS_Shape& face) {
    const auto index = static_cast<std::size_t>(map_.Add(face));
    if (walls_.size() < index) walls_.resize(index);
    return walls_[index - 1];
  }

  std::optional<bool> is_solid(int cell) const {
    return cell < 0 ? std::optional<bool>(false) : is_solid_[static_cast<std::size_t>(cell)];
  }

  /// One face parts a solid from a void, two that coincide part two solids.
  bool spread(const Wall& wall) {
    for (const auto& [from, to] : {std::pair(0U, 1U), std::pair(1U, 0U)}) {
      const std::optional<bool> known = is_solid(wall.cells[from]);
      if (!known || is_solid(wall.cells[to])) continue;
      is_solid_[static_cast<std::size_t>(wall.cells[to])] = wall.inputs == 1 ? !*known : *known;
      return true;
    }
    return false;
  }

  const TopTools_IndexedMapOfShape& cells_;
  TopTools_IndexedMapOfShape map_;
  std::vector<Wall> walls_;
  std::vector<std::optional<bool>> is_solid_;
};

}  // namespace

bool enclose_solids(CadBody& body) {
  BOPAlgo_MakerVolume maker;
  FuseHistory history(body);
  history.add(maker);
  const TopTools_IndexedMapOfShape faces = sub_shapes(body.shape, TopAbs_FACE);
  for (int f = 1; f <= faces.Extent(); ++f) maker.AddArgument(history.elementary(faces(f)));
  maker.SetIntersect(true);
  maker.SetNonDestructive(true);
  maker.Perform();
  if (maker.HasErrors()) return false;
  const TopTools_IndexedMapOfShape cells = sub_shapes(maker.Shape(), TopAbs_SOLID);
  const std::vector<TopoDS_Shape> solids = Cells(body, cells, history).solids();
  if (solids.empty()) return false;
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& solid : solids) builder.Add(compound, solid);
  history.note_faces(body);
  replace_shape(body, compound, [&](const TopoDS_Shape& part) { return history.image(part); });
  body.notes.push_back({"file", "faces put together to " + std::to_string(body.solids.size()) + " solids that touch"});
  return true;
}

}  // namespace curvetet
