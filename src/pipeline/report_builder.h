// Fills the report from what the stages returned.
#pragma once

#include <map>
#include <string>

#include "curvetet/report.h"
#include "pipeline/body_mesher.h"
#include "pipeline/spot.h"
#include "quality/validate.h"

namespace curvetet {

/// Healing notes, unit, options: everything known once the body is loaded.
void report_input(Report& report, const Model& model, const Settings& settings, const Options& options);
/// Counts of recovery, those of a part of a body added to what is there. Also of one that failed.
void report_recovery(Report& report, const BodyMesherResult& body);
/// Certificates, solids, counts of the surface; those of a part of a body are added to what is there. `locked`: the
/// locked facets of the finished mesh, by face.
void report_body(Report& report, const Model& model, const Settings& settings, const BodyMesherResult& body,
                 const IndexedVector<FaceId, std::vector<FacetKey>>& locked);
/// Area of each face and the triangles that its size asks for; a face that has more without a reduction gets one with
/// the reason "shape": its outline and bending, not the size field, asked for them. After report_body and
/// report_reductions.
void report_fineness(Report& report, const Model& model, const Settings& settings, const SizeField& sizes,
                     const BodyMesh& mesh);
void report_reductions(Report& report, const Model& model, const Settings& settings, const SizeField& sizes);
void report_mesh(Report& report, const Mesh& mesh, const ValidationReport& validation);
/// What to do about faces that cross whatever the size.
std::string crossing_hint(const RecoveryFailure& failure, const Model& model);
/// A failure of recovery as an error in the user's terms; `gap`: how close its two faces come, if that is known.
Error to_error(const RecoveryFailure& failure, const Model& model, const Settings& settings,
               const std::optional<FaceGap>& gap = std::nullopt);

/// For entities as errors name them, the same with kind and name: "face 12" and "face 12 (cylinder, inlet)".
std::map<std::string, std::string> entities_in_words(const Model& model);

}  // namespace curvetet
