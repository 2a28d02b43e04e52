// The report as JSON: one function per part, keys in the order in which a reader wants them. JSON has no infinity and
// no not-a-number, so such values become null; hashes are 16 hexadecimal digits, since JSON's numbers do not hold 64
// bits.
#include "curvetet/report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace curvetet {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json place(const Point& point) { return {number(point[0]), number(point[1]), number(point[2])}; }

std::string hexadecimal(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

Json stage_json(const StageTime& stage) {
  return {{"stage", stage.stage}, {"seconds", number(stage.seconds)}, {"bytes", stage.bytes}};
}

Json rung_json(const RungCounts& rung) { return {{"tried", rung.tried}, {"recovered", rung.recovered}}; }

Json ladder_json(const LadderCounts& ladder) {
  return {{"reconnect", rung_json(ladder.reconnect)},
          {"refine", rung_json(ladder.refine)},
          {"volume_points", rung_json(ladder.volume_points)},
          {"outer_loop", rung_json(ladder.outer_loop)},
          {"fallback", rung_json(ladder.fallback)}};
}

Json recovery_json(const RecoveryCounts& counts) {
  return {{"crossings", counts.crossings},
          {"edge_flips", counts.edge_flips},
          {"edge_splits", counts.edge_splits},
          {"edges_filled", counts.edges_filled},
          {"volume_points", counts.volume_points},
          {"rounds", counts.rounds},
          {"stage_one_points", counts.stage_one_points},
          {"stage_one_allowed", counts.stage_one_allowed},
          {"stage_two_points", counts.stage_two_points},
          {"case_1", counts.case1},
          {"case_2", counts.case2},
          {"case_3a", counts.case3a},
          {"case_3b", counts.case3b},
          {"case_4", counts.case4},
          {"fallback_faces", counts.fallback_faces},
          {"ladder", ladder_json(counts.ladder)}};
}

Json reduction_json(const ReductionReport& reduction) {
  return {{"face", reduction.face},       {"other", reduction.other == 0 ? Json() : Json(reduction.other)},
          {"reason", reduction.reason},   {"size", number(reduction.size)},
          {"gap", number(reduction.gap)}, {"where", place(reduction.where)}};
}

Json suppressed_json(const SuppressedReport& detail) {
  return {{"kind", detail.kind},
          {"id", detail.cad_id},
          {"name", detail.name},
          {"size", number(detail.size)},
          {"where", place(detail.where)}};
}

Json face_json(const FaceReport& face) {
  return {{"face", face.cad_id},
          {"name", face.name},
          {"kind", face.kind},
          {"triangles_parametric", face.triangles_parametric},
          {"triangles", face.triangles},
          {"coincide", face.coincide},
          {"area", number(face.area)},
          {"triangles_asked", number(face.triangles_asked)},
          {"points",
           {{"initial", face.initial_points},
            {"edge_recovery", face.points_edge_recovery},
            {"stage_one", face.points_stage_one},
            {"stage_two", face.points_stage_two}}},
          {"hash_locked", hexadecimal(face.hash_locked)},
          {"hash_final", hexadecimal(face.hash_final)},
          {"relocks", face.relocks},
          {"unlocks", face.unlocks},
          {"flips_without_points", face.flips_without_points},
          {"fallback", face.fallback},
          {"ladder", ladder_json(face.ladder)}};
}

Json solid_json(const SolidReport& solid) {
  return {{"solid", solid.cad_id},
          {"name", solid.name},
          {"tets", solid.tets},
          {"volume", number(solid.volume)},
          {"cad_volume", number(solid.cad_volume)}};
}

Json error_json(const Error& error) {
  Json where;
  if (error.where) where = place({error.where->x, error.where->y, error.where->z});
  return {{"code", name(error.code)},
          {"message", error.message},
          {"entities", error.entities},
          {"where", where},
          {"hint", error.hint}};
}

Json forced_angle_json(const ForcedAngleReport& forced) {
  return {{"faces", forced.faces},
          {"edges", forced.edges},
          {"vertex", forced.vertex == 0 ? Json() : Json(forced.vertex)},
          {"angle", number(forced.angle)},
          {"tets", forced.tets},
          {"where", place(forced.where)}};
}

Json quality_json(const Report& report) {
  Json forced = Json::array();
  for (const ForcedAngleReport& f : report.forced_angles) forced.push_back(forced_angle_json(f));
  return {{"worst_dihedral", number(report.worst_dihedral)},
          {"worst_place", place(report.worst_place)},
          {"tets_below_half_degree", report.tets_below_half_degree},
          {"tets_below_five_degrees", report.tets_below_five_degrees},
          {"forced_below_half_degree", report.forced_below_half_degree},
          {"forced_below_five_degrees", report.forced_below_five_degrees},
          {"forced_angles", forced},
          {"unmet_tets", report.unmet_tets},
          {"mean_radius_ratio", number(report.mean_radius_ratio)},
          {"radius_ratio_histogram", report.radius_ratio_histogram},
          {"dihedral_histogram", report.dihedral_histogram}};
}

template <class T>
Json list(const std::vector<T>& items, Json (*to_json_of_item)(const T&)) {
  Json result = Json::array();
  for (const T& item : items) result.push_back(to_json_of_item(item));
  return result;
}

}  // namespace

std::string Report::to_json() const {
  const Json options = options_json.empty() ? Json() : Json::parse(options_json, nullptr, false);
  Json json;
  json["schema"] = schema;
  json["version"] = version;
  json["valid"] = valid;
  json["input"] = {
      {"file", input}, {"hash", input_hash}, {"unit", unit}, {"file_unit", file_unit}, {"healing", healing}};
  json["suppressed"] = list(suppressed, suppressed_json);
  json["mode"] = mode;
  json["options"] = options.is_discarded() ? Json() : options;
  json["counts"] = {{"points", points},
                    {"tets", tets},
                    {"triangles", triangles},
                    {"segments", segments},
                    {"initial_surface_points", initial_surface_points}};
  json["rounds"] = rounds;
  json["recovery"] = recovery_json(recovery);
  json["quality"] = quality_json(*this);
  json["reductions"] = list(reductions, reduction_json);
  json["solids"] = list(solids, solid_json);
  json["faces"] = list(faces, face_json);
  json["stages"] = list(stages, stage_json);
  json["peak_bytes"] = peak_bytes;
  json["warnings"] = warnings;
  json["errors"] = list(errors, error_json);
  json["mesh_hash"] = hexadecimal(mesh_hash);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace curvetet
