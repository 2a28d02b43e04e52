#include "pipeline/report_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "geometry/check.h"
#include "geometry/parts.h"
#include "pipeline/assemble.h"

namespace curvetet {

namespace {

/// Triangles over those asked for above which a face counts as finer than asked: two rows across a strip come to that.
constexpr double kFine = 2;

const char* reason_name(SizeReason reason) {
  switch (reason) {
    case SizeReason::asked:
      return "asked";
    case SizeReason::curvature:
      return "curvature";
    case SizeReason::chord_height:
      return "chord_height";
    case SizeReason::gap:
      return "gap";
    case SizeReason::narrow_face:
      return "narrow_face";
    case SizeReason::edge_length:
      return "edge_length";
    case SizeReason::callback:
      return "callback";
    case SizeReason::outer_loop:
      return "outer_loop";
  }
  return "asked";
}

Vec3 out_point(Vec3 working, const Model& model, const Settings& settings) {
  return settings.unit_scale * model.frame.to_cad(working);
}

std::size_t count_origin(const BodyMesh& body, const std::vector<VertexId>& vertices, Origin origin) {
  return static_cast<std::size_t>(
      std::count_if(vertices.begin(), vertices.end(), [&](VertexId v) { return body.vertices.origin(v) == origin; }));
}

/// The worst distance of an edge to one of the faces at which recovery failed, where it exceeds the size that was tried
/// there: at that scale the body itself does not say where its boundary is.
std::optional<ModelFault> gap_of_input(const RecoveryFailure& failure, const Model& model) {
  if (!(failure.size > 0)) return std::nullopt;
  CheckOptions options;
  options.slack = 0;
  options.floor = 0;
  std::optional<ModelFault> worst;
  for (const ModelFault& fault : check_model(model, options)) {
    const auto concerns = [&](FaceId f) {
      return fault.entity == "face " + std::to_string(model.faces[f].label.cad_id);
    };
    if (fault.kind != ModelFault::Kind::curve_off || !(fault.amount > failure.size)) continue;
    if (std::none_of(failure.faces.begin(), failure.faces.end(), concerns)) continue;
    if (!worst || fault.amount > worst->amount) worst = fault;
  }
  return worst;
}

struct FaceExtent {
  double area = 0;
  Vec3 place;  ///< of a vertex
};

FaceExtent extent_of(const BodyMesh& body, FaceId face) {
  FaceExtent extent;
  const FaceMesh& mesh = body.boundary.faces[face];
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    if (!mesh.triangle(TriangleId(t)).alive()) continue;
    const std::array<VertexId, 3> v = mesh.vertices(TriangleId(t));
    const Vec3 a = body.vertices.position(v[0]);
    extent.place = a;
    extent.area += 0.5 * norm(cross(body.vertices.position(v[1]) - a, body.vertices.position(v[2]) - a));
  }
  return extent;
}

template <class SortedFacets>
std::vector<FacetKey> in_common(const std::vector<FacetKey>& a, const SortedFacets& b) {
  std::vector<FacetKey> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

FaceReport face_report(const Model& model, const BodyMesh& body, FaceId face, const std::vector<FacetKey>& locked) {
  FaceReport r;
  r.cad_id = model.faces[face].label.cad_id;
  r.name = model.face_name(face);
  r.kind = name(model.faces[face].surface->kind());
  r.initial_points = body.initial_points[face];
  const std::vector<VertexId> vertices = vertices_of(body.boundary.faces[face]);
  r.points_edge_recovery = count_origin(body, vertices, Origin::edge_recovery);
  r.points_stage_one = count_origin(body, vertices, Origin::stage_one);
  r.points_stage_two = count_origin(body, vertices, Origin::stage_two);
  const FaceCertificate& c = body.recovery.faces[face];
  r.triangles_parametric = c.parametric;
  r.triangles = locked.size();
  const std::vector<FacetKey> unchanged = in_common(locked, c.locked);
  r.coincide = unchanged.size() - in_common(unchanged, c.marched).size();
  r.hash_locked = facet_hash(c.locked);
  r.hash_final = facet_hash(locked);
  r.relocks = (locked.size() - unchanged.size() + 1) / 2;
  r.unlocks = c.unlocks;
  r.flips_without_points = c.ladder.reconnect.recovered;
  r.fallback = c.fallback;
  r.ladder = c.ladder;
  return r;
}

void add(RungCounts& sum, const RungCounts& more) {
  sum.tried += more.tried;
  sum.recovered += more.recovered;
}

ForcedAngleReport forced_report(const Mesh& mesh, const ForcedAngle& forced) {
  ForcedAngleReport r;
  for (std::uint32_t f : forced.faces) r.faces.push_back(mesh.faces[f].cad_id);
  for (std::uint32_t e : forced.edges) r.edges.push_back(mesh.edges[e].cad_id);
  if (forced.vertex) r.vertex = mesh.vertices[*forced.vertex].cad_id;
  r.angle = forced.angle;
  r.tets = forced.tets;
  r.where = forced.place;
  return r;
}

}  // namespace

void report_input(Report& report, const Model& model, const Settings& settings, const Options& options) {
  report.unit = settings.unit;
  report.file_unit = model.file_unit;
  report.mode = options.recovery == RecoveryMode::paper ? "paper" : "conjoint";
  report.options_json = options_json(options, settings, model);
  for (const HealingNote& note : model.healing) {
    report.healing.push_back(note.entity + ": " + note.what);
    if (note.is_warning) report.warnings.push_back(report.healing.back());
  }
  for (const SuppressedDetail& detail : model.suppressed) {
    const Vec3 p = settings.unit_scale * detail.place;
    report.suppressed.push_back({name(detail.kind),
                                 detail.label.cad_id,
                                 detail.label.name,
                                 detail.size * settings.unit_scale,
                                 {p.x, p.y, p.z}});
  }
}

void report_recovery(Report& report, const BodyMesherResult& body) {
  const BodyMesh& mesh = *body.mesh;
  RecoveryCounts& c = report.recovery;
  c.crossings += mesh.crossings.first_pairs;
  c.edge_flips += mesh.recovery.edge_flips;
  c.edge_splits += mesh.recovery.edge_splits;
  c.edges_filled += mesh.recovery.edges_filled;
  c.volume_points += mesh.recovery.volume_points;
  c.rounds = std::max(c.rounds, mesh.recovery.rounds);
  c.stage_one_points += mesh.crossings.points + mesh.paper.stage_one_points;
  c.stage_one_allowed += mesh.paper.stage_one_allowed;
  c.stage_two_points += mesh.recovery.points;
  c.case1 += mesh.paper.case1;
  c.case2 += mesh.paper.case2;
  c.case3a += mesh.paper.case3a;
  c.case3b += mesh.paper.case3b;
  c.case4 += mesh.paper.case4;
  for (const RungCounts& r : body.restarts) add(c.ladder.outer_loop, r);
  for (const FaceCertificate& f : mesh.recovery.faces) {
    c.fallback_faces += f.fallback ? 1 : 0;
    add(c.ladder.reconnect, f.ladder.reconnect);
    add(c.ladder.refine, f.ladder.refine);
    add(c.ladder.volume_points, f.ladder.volume_points);
    add(c.ladder.fallback, f.ladder.fallback);
  }
}

void report_body(Report& report, const Model& model, const Settings& settings, const BodyMesherResult& body,
                 const IndexedVector<FaceId, std::vector<FacetKey>>& locked) {
  const BodyMesh& mesh = *body.mesh;
  report.initial_surface_points += mesh.initial_surface_points;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    report.faces.push_back(face_report(model, mesh, FaceId(f), locked[FaceId(f)]));
    report.faces.back().ladder.outer_loop = body.restarts[FaceId(f)];
  }
  const double scale = settings.unit_scale / model.frame.scale;
  for (std::size_t s = 0; s < model.solids.size(); ++s) {
    SolidReport r;
    r.cad_id = model.solids[SolidId(s)].label.cad_id;
    r.name = model.solid_name(SolidId(s));
    r.volume = mesh.classified.volumes[SolidId(s)] * scale * scale * scale;
    r.cad_volume = model.solids[SolidId(s)].volume * scale * scale * scale;
    report.solids.push_back(r);
  }
}

void report_reductions(Report& report, const Model& model, const Settings& settings, const SizeField& sizes) {
  for (const SizeReduction& r : sizes.reductions(model)) {
    ReductionReport out;
    out.face = r.face.valid() ? model.faces[r.face].label.cad_id : 0;
    out.other = r.other.valid() ? model.faces[r.other].label.cad_id : 0;
    out.reason = reason_name(r.reason);
    out.size = model.frame.length_to_cad(r.size) * settings.unit_scale;
    out.gap = model.frame.length_to_cad(r.gap) * settings.unit_scale;
    const Vec3 p = out_point(r.where, model, settings);
    out.where = {p.x, p.y, p.z};
    report.reductions.push_back(out);
  }
}

void report_fineness(Report& report, const Model& model, const Settings& settings, const SizeField& sizes,
                     const BodyMesh& mesh) {
  std::set<std::uint32_t> explained;
  for (const ReductionReport& r : report.reductions) explained.insert(r.face);
  const double scale = model.frame.length_to_cad(1) * settings.unit_scale;
  const std::size_t first = report.faces.size() - model.faces.size();  // the last ones are this model's
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const FaceId face(f);
    FaceReport& r = report.faces[first + f];
    const FaceExtent extent = extent_of(mesh, face);
    const double size = std::min(sizes.largest(), sizes.face_limit(face));
    const double of_one = std::sqrt(3.0) / 4 * size * size;
    r.area = extent.area * scale * scale;
    r.triangles_asked = extent.area / of_one;
    const auto triangles = static_cast<double>(r.triangles);
    if (triangles <= kFine * r.triangles_asked || explained.contains(r.cad_id)) continue;
    const Vec3 p = out_point(extent.place, model, settings);
    report.reductions.push_back(
        {r.cad_id, 0, "shape", size * scale * std::sqrt(r.triangles_asked / triangles), 0, {p.x, p.y, p.z}});
  }
}

void report_mesh(Report& report, const Mesh& mesh, const ValidationReport& validation) {
  report.points = mesh.points.size();
  report.tets = mesh.tets.size();
  report.triangles = mesh.triangles.size();
  report.segments = mesh.segments.size();
  for (SolidReport& s : report.solids) s.tets = 0;
  for (std::uint32_t solid : mesh.tet_solid) ++report.solids[solid].tets;
  report.mesh_hash = mesh_hash(mesh);
  report.worst_dihedral = validation.quality.worst_dihedral;
  report.worst_place = validation.quality.worst_place;
  report.tets_below_half_degree = validation.quality.below_half_degree;
  report.tets_below_five_degrees = validation.quality.below_five_degrees;
  report.forced_below_half_degree = validation.quality.forced_below_half;
  report.forced_below_five_degrees = validation.quality.forced_below_five;
  for (const ForcedAngle& f : validation.quality.forced) report.forced_angles.push_back(forced_report(mesh, f));
  report.mean_radius_ratio = validation.quality.radius_ratio.mean;
  report.radius_ratio_histogram = validation.quality.radius_ratio.bins;
  report.dihedral_histogram = validation.quality.dihedral.bins;
  report.valid = validation.valid();
  for (const Finding& f : validation.findings) {
    const std::string text =
        fmt::format("{}: {}{}{}", f.check, f.count,
                    f.examples.empty() ? "" : ", first: ", f.examples.empty() ? "" : f.examples.front());
    if (f.severity == Severity::warning)
      report.warnings.push_back(text);
    else
      report.errors.push_back({ErrorCode::invalid_mesh, text});
  }
}

std::map<std::string, std::string> entities_in_words(const Model& model) {
  std::map<std::string, std::string> words;
  const auto add = [&](const char* type, const Label& label, const char* kind, const std::string& called) {
    const std::string plain = fmt::format("{} {}", type, label.cad_id);
    words[plain] = fmt::format("{} ({}{})", plain, kind, called);
  };
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const ModelFace& face = model.faces[FaceId(f)];
    add("face", face.label, name(face.surface->kind()), ", " + model.face_name(FaceId(f)));
  }
  for (std::size_t e = 0; e < model.edges.size(); ++e) {
    const ModelEdge& edge = model.edges[EdgeId(e)];
    add("edge", edge.label, edge.curve ? name(edge.curve->kind()) : "pole", ", " + model.edge_name(EdgeId(e)));
  }
  for (std::size_t s = 0; s < model.solids.size(); ++s)
    add("solid", model.solids[SolidId(s)].label, "", model.solid_name(SolidId(s)));
  return words;
}

std::string crossing_hint(const RecoveryFailure& failure, const Model& model) {
  const std::vector<std::vector<SolidId>> parts = parts_of(model);
  const auto part_of = [&](FaceId f) {
    const ModelFace& face = model.faces[f];
    const SolidId solid = face.front.valid() ? face.front : face.back;
    return std::find_if(parts.begin(), parts.end(), [&](const std::vector<SolidId>& part) {
      return std::find(part.begin(), part.end(), solid) != part.end();
    });
  };
  const bool of_two = std::any_of(failure.faces.begin(), failure.faces.end(),
                                  [&](FaceId f) { return part_of(f) != part_of(failure.faces.front()); });
  return of_two ? "these faces of two solids must not cross: mend the solids, or mesh them apart with --conformal off"
                : "mend the body: these faces must not cross";
}

Error to_error(const RecoveryFailure& failure, const Model& model, const Settings& settings,
               const std::optional<FaceGap>& gap) {
  Error error;
  error.code = failure.proved ? ErrorCode::self_intersection : ErrorCode::recovery_failed;
  std::string faces, sizes;
  const auto out = [&](double length) { return model.frame.length_to_cad(length) * settings.unit_scale; };
  for (FaceId f : failure.faces) {
    const std::string entity = fmt::format("face {}", model.faces[f].label.cad_id);
    if (std::find(error.entities.begin(), error.entities.end(), entity) != error.entities.end()) continue;
    error.entities.push_back(entity);
    faces += fmt::format("{}{}", faces.empty() ? "" : ", ", model.face_name(f));
    sizes += fmt::format(" --face-size {}={:.3g}", model.faces[f].label.cad_id, out(failure.size));
  }
  const Vec3 p = out_point(failure.where, model, settings);
  error.where = p;
  error.message =
      fmt::format("{} ({}) at ({:.6g}, {:.6g}, {:.6g}) {}", failure.what, faces, p.x, p.y, p.z, settings.unit);
  if (gap) {
    const Vec3 q = out_point(gap->where, model, settings);
    error.message += fmt::format("; {} and {} come within {:.3g} {} at ({:.6g}, {:.6g}, {:.6g})", error.entities[0],
                                 error.entities[1], out(gap->length), settings.unit, q.x, q.y, q.z);
  }
  if (const auto off = gap_of_input(failure, model)) {
    error.code = ErrorCode::bad_face;
    error.message += fmt::format(": {} {}, by {:.3g} {}, more than the size at which this happens", off->entity,
                                 off->what, out(off->amount), settings.unit);
    error.hint = "repair it in the CAD system, or export with a tighter tolerance";
  } else if (failure.proved || (failure.crossing && failure.size <= 0)) {
    error.hint = crossing_hint(failure, model);
  } else if (failure.size > 0) {
    error.hint = fmt::format("a size of {:.3g} {} there may do:{}", out(failure.size), settings.unit, sizes);
  }
  return error;
}

}  // namespace curvetet
