#include "cad/shape.h"

#include "cad/body.h"
#include "cad/heal.h"

namespace curvetet {

Result<Model> model_from_shape(const TopoDS_Shape& shape, const ShapeOptions& options, Context& context) {
  if (context.should_stop()) return context.stop_error("load");
  if (shape.IsNull()) return Error{ErrorCode::no_faces, options.name + " is a null shape"};
  CadBody body;
  body.shape = shape;
  body.unit = options.unit;
  label_all(body);
  return heal_and_convert(body, options.name);
}

}  // namespace curvetet
