#include "cad/parts_of_body.h"

#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>

namespace curvetet {

Result<CadBody> parts_of_body(const CadBody& body, const std::vector<std::string>& names, const std::string& source) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopAbs_ShapeEnum type : kLabelled) {
    const TopTools_IndexedMapOfShape parts = sub_shapes(body.shape, type);
    for (int i = 1; i <= parts.Extent(); ++i) {
      const std::uint32_t id = labels_of(body, type)[static_cast<std::size_t>(i - 1)].cad_id;
      const std::string name = std::string(type_name(type)) + " " + std::to_string(id);
      if (std::find(names.begin(), names.end(), name) != names.end()) builder.Add(compound, parts(i));
    }
  }
  if (compound.NbChildren() == 0) return Error{ErrorCode::no_faces, source + " has none of the parts asked for"};
  CadBody some;
  some.shape = compound;
  some.unit = body.unit;
  label_all(some);
  return some;
}

}  // namespace curvetet
