// The pipeline for shapes in memory.
#include "cad/shape.h"
#include "curvetet/occt.h"
#include "pipeline/pipeline.h"

namespace curvetet {

Result<MeshOutput> mesh(const TopoDS_Shape& shape, const Options& options, Context& context,
                        Report* report_on_failure) {
  return mesh(shape, ShapeLabels{}, options, context, report_on_failure);
}

Result<MeshOutput> mesh(const TopoDS_Shape& shape, const ShapeLabels& labels, const Options& options, Context& context,
                        Report* report_on_failure) {
  Source source;
  source.name = labels.name;
  ShapeOptions load;
  if (!options.input_unit.empty()) load.unit = options.input_unit;
  load.labels = labels;
  load.joining = {options.conformal, options.overlaps};
  source.load = [&](Context& while_loading) { return model_from_shape(shape, load, while_loading); };
  source.confirm_crossing = [&](const std::vector<std::uint32_t>& faces, Context& while_loading) {
    ShapeOptions again = load;
    again.suspects = faces;
    const Result<Model> model = model_from_shape(shape, again, while_loading);
    return model ? std::optional<Error>() : std::optional(model.error());
  };
  return mesh_source(source, options, context, report_on_failure);
}

}  // namespace curvetet
