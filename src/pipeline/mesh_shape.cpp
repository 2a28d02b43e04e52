// The pipeline for shapes in memory.
#include "cad/kept_body.h"
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
  load.min_feature = {options.min_feature, options.unit};
  KeptBody kept;
  source.load = [&](const std::vector<std::uint32_t>& suspects, Context& while_loading) {
    load.suspects = suspects;
    const bool keep = suspects.empty() && !options.dossier.empty();
    return model_from_shape(shape, load, while_loading, keep ? &kept : nullptr);
  };
  source.body = [&] { return pack_body(kept); };
  source.parts = [&](const std::vector<std::string>& parts, Context&) {
    return brep_of_parts(shape, parts, labels.name);
  };
  return mesh_source(source, options, context, report_on_failure);
}

}  // namespace curvetet
