// The copy is made by writing the shape to memory and reading it again: this keeps the order of all parts, instances
// and locations included, so that an index into the original is an index into the copy. BRepBuilderAPI_Copy loses the
// way from a part inside a located compound to its copy.
#include "cad/shape.h"

#include <BinTools.hxx>
#include <sstream>

#include "cad/body.h"
#include "cad/guard.h"
#include "cad/heal.h"
#include "cad/kept_body.h"

namespace curvetet {

namespace {

Result<TopoDS_Shape> copy_of(const TopoDS_Shape& shape, const std::string& name) {
  return guarded(ErrorCode::reader_failed, "cannot copy " + name, [&]() -> Result<TopoDS_Shape> {
    std::stringstream bytes;
    BinTools::Write(shape, bytes, false, false, BinTools_FormatVersion_CURRENT);
    TopoDS_Shape copy;
    BinTools::Read(copy, bytes);
    if (copy.IsNull()) return Error{ErrorCode::reader_failed, "cannot copy " + name};
    return copy;
  });
}

Status label_part(CadBody& body, const TopoDS_Shape& shape, const PartLabel& label, const std::string& name) {
  for (const TopAbs_ShapeEnum type : kLabelled) {
    if (label.part.IsNull() || label.part.ShapeType() != type) continue;
    const int index = sub_shapes(shape, type).FindIndex(label.part);
    if (index == 0) break;
    Label& target = labels_of(body, type)[static_cast<std::size_t>(index - 1)];
    target.name = label.name;
    if (label.colour) target.colour = Colour{(*label.colour)[0], (*label.colour)[1], (*label.colour)[2]};
    return Done{};
  }
  return Error{ErrorCode::bad_option,
               "the part labelled '" + label.name + "' is no solid, face, edge or vertex of " + name,
               {},
               {},
               "label parts as TopExp::MapShapes or TopExp_Explorer find them in the shape, with their location"};
}

}  // namespace

Result<Model> model_from_shape(const TopoDS_Shape& shape, const ShapeOptions& options, Context& context,
                               KeptBody* kept) {
  if (context.should_stop()) return context.stop_error("load");
  const std::string& name = options.labels.name;
  if (shape.IsNull()) return Error{ErrorCode::no_faces, name + " is a null shape"};
  Result<TopoDS_Shape> copy = copy_of(shape, name);
  if (!copy) return copy.error();
  CadBody body;
  body.shape = copy.value();
  body.unit = options.unit;
  label_all(body);
  for (const PartLabel& label : options.labels.parts)
    if (const Status labelled = label_part(body, shape, label, name); !labelled) return labelled.error();
  Result<Model> model = heal_and_convert(body, name, {options.joining, options.min_feature, options.suspects});
  if (model && kept != nullptr) *kept = std::make_shared<const CadBody>(std::move(body));
  return model;
}

Result<std::string> brep_of_parts(const TopoDS_Shape& shape, const std::vector<std::string>& parts,
                                  const std::string& name) {
  CadBody body;
  body.shape = shape;
  label_all(body);
  return brep_of_parts(std::make_shared<const CadBody>(std::move(body)), parts, name);
}

}  // namespace curvetet
