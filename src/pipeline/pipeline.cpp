// The stages in the order of the paper's Fig. 1 and DESIGN's list. This function reads like that list; what a stage
// promised is checked before the next one starts.
#include "pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "boundary/classify.h"
#include "cad/load.h"
#include "pipeline/assemble.h"
#include "pipeline/body_mesher.h"
#include "pipeline/join_parts.h"
#include "pipeline/report_builder.h"
#include "pipeline/settings.h"
#include "quality/validate_parts.h"
#include "volume/improve.h"
#include "volume/refine.h"

namespace curvetet {

const char* version() { return "0.1.0"; }

namespace {

std::string file_hash(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  char buffer[1 << 16];
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0)
    for (std::streamsize i = 0; i < in.gcount(); ++i)
      hash = (hash ^ static_cast<unsigned char>(buffer[i])) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

/// The stages from sizes to the finished mesh, for a whole body or a part of one.
class BodyRun {
 public:
  BodyRun(const Source& source, const Model& model, const Settings& settings, const Options& options, StageClock& clock,
          Context& context, Report& report)
      : source_(source),
        model_(model),
        settings_(settings),
        options_(options),
        clock_(clock),
        context_(context),
        report_(report) {}

  Result<Mesh> operator()() {
    const Status boundary = mesh_boundary_stages();
    if (!boundary.ok()) return boundary.error();
    const Status volume = mesh_volume_stages();
    if (!volume.ok()) return volume.error();
    BodyMesh& body = *body_.mesh;
    report_body(report_, model_, settings_, body_, locked_facets(*body.tets, model_.faces.size()));
    report_fineness(report_, model_, settings_, sizes_, body);
    return assemble(*body.conjoint, settings_);
  }

 private:
  Status mesh_boundary_stages() {
    clock_.start("size field", 0.05, 0.1);
    auto sizes = make_size_field(model_, settings_.sizing, context_);
    if (!sizes.ok()) return sizes.error();
    sizes_ = std::move(sizes.value());
    auto body = mesh_body(model_, sizes_, settings_, options_, clock_, context_);
    if (!body.ok()) return body.error();
    body_ = std::move(body.value());
    report_reductions(report_, model_, settings_, sizes_);
    report_.rounds = std::max(report_.rounds, body_.rounds);
    report_recovery(report_, body_);
    if (body_.failures.empty()) return Done{};
    for (const RecoveryFailure& f : body_.failures) report_.errors.push_back(to_error(f, model_, settings_));
    confirm_crossing();
    return report_.errors.front();
  }

  /// The CAD kernel is asked about the first crossing only: it reads the body again for that.
  void confirm_crossing() {
    const auto failure =
        std::find_if(body_.failures.begin(), body_.failures.end(), [](const RecoveryFailure& f) { return f.crossing; });
    if (failure == body_.failures.end() || failure->proved) return;
    std::vector<std::uint32_t> faces;
    for (const FaceId f : failure->faces) faces.push_back(model_.faces[f].label.cad_id);
    const Result<Model> again = source_.load(faces, context_);
    if (again || again.error().code != ErrorCode::self_intersection) return;
    // What is proved is told first.
    const auto error = report_.errors.begin() + (failure - body_.failures.begin());
    error->code = again.error().code;
    error->message += "; " + again.error().message;
    error->hint = again.error().hint;
    std::rotate(report_.errors.begin(), error, error + 1);
  }

  Status mesh_volume_stages() {
    BodyMesh& body = *body_.mesh;
    if (options_.refine_interior) {
      clock_.start("interior points", 0.55, 0.75);
      RefineOptions refine;
      refine.radius_edge = options_.radius_edge;
      auto refined = refine_interior(*body.tets, body.vertices, sizes_, refine, context_);
      if (!refined.ok()) return refined.error();
      report_.unmet_tets += refined.value().unmet;
    }
    if (options_.improve) {
      clock_.start("improvement", 0.75, 0.92);
      auto improved = improve(*body.tets, body.vertices, ImproveOptions{}, context_);
      if (!improved.ok()) return improved.error();
    }
    return Done{};
  }

  const Source& source_;
  const Model& model_;
  const Settings& settings_;
  const Options& options_;
  StageClock& clock_;
  Context& context_;
  Report& report_;
  SizeField sizes_;
  BodyMesherResult body_;
};

class Run {
 public:
  Run(const Source& source, const Options& options, Context& context, Report& report)
      : source_(source), options_(options), context_(context), report_(report), clock_(context) {}

  Result<Mesh> operator()() {
    const Status options = check_options(options_);
    if (!options.ok()) return options.error();
    if (options_.time_limit)
      context_.deadline =
          std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                 std::chrono::duration<double>(*options_.time_limit));
    if (options_.threads > 0) context_.threads = options_.threads;
    context_.seed = options_.seed;
    const Status loaded = load();
    if (!loaded.ok()) return loaded.error();
    Result<Mesh> mesh =
        apart() ? mesh_parts() : BodyRun(source_, model_, settings_, options_, clock_, context_, report_)();
    if (!mesh.ok()) return mesh.error();
    return finish(std::move(mesh.value()));
  }

  void keep_times() {
    clock_.stop();
    report_.stages = clock_.times();
  }

 private:
  bool apart() const { return options_.conformal == Conformal::off; }

  Status load() {
    clock_.start("load", 0, kLoadDone);
    auto model = source_.load({}, context_);
    if (!model.ok()) return model.error();
    model_ = std::move(model.value());
    if (source_.hash) report_.input_hash = source_.hash();
    auto settings = resolve(options_, model_);
    if (!settings.ok()) return settings.error();
    settings_ = std::move(settings.value());
    report_input(report_, model_, settings_, options_);
    return Done{};
  }

  /// Parts that share nothing, one after the other: each as if it were alone.
  Result<Mesh> mesh_parts() {
    const std::vector<std::vector<SolidId>> parts = parts_of(model_);
    Mesh mesh = empty_mesh(model_, settings_);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double share = (kVolumeDone - kLoadDone) / static_cast<double>(parts.size());
      clock_.set_span(kLoadDone + static_cast<double>(i) * share, share);
      const Part part = make_part(model_, parts[i]);
      const Settings settings = settings_of(part, settings_);
      Result<Mesh> made = BodyRun(source_, part.model, settings, options_, clock_, context_, report_)();
      if (!made.ok()) return made.error();
      append(mesh, made.value(), part);
    }
    clock_.set_span(0, 1);
    sort_entities(report_, mesh);
    return mesh;
  }

  Result<Mesh> finish(Mesh mesh) {
    clock_.start("validation", kVolumeDone, 1);
    const ValidationReport validation =
        (apart() ? validate_parts : validate)(mesh, &model_, settings_.unit_scale, context_);
    if (!validation.valid() && context_.should_stop()) return context_.stop_error("validation");
    report_mesh(report_, mesh, validation);
    context_.progress("done", 1);
    return mesh;
  }

  // Shares of the run.
  static constexpr double kLoadDone = 0.05, kVolumeDone = 0.92;

  const Source& source_;
  const Options& options_;
  Context& context_;
  Report& report_;
  StageClock clock_;
  Model model_;
  Settings settings_;
};

}  // namespace

Result<MeshOutput> mesh_source(const Source& source, const Options& options, Context& context,
                               Report* report_on_failure) {
  Report report;
  report.version = version();
  report.input = source.name;
  Run run(source, options, context, report);
  Result<Mesh> made = run();
  run.keep_times();
  if (made.ok()) return MeshOutput{std::move(made.value()), std::move(report)};
  if (report.errors.empty()) report.errors.push_back(made.error());
  const Error error = made.error();
  if (report_on_failure != nullptr) *report_on_failure = std::move(report);
  return error;
}

Result<MeshOutput> mesh(const Input& input, const Options& options, Context& context, Report* report_on_failure) {
  Source source;
  source.name = input.path;
  source.hash = [&] { return file_hash(input.path); };
  LoadOptions load;
  load.input_unit = options.input_unit;
  load.isolate = options.isolate_cad;
  load.helper = options.cad_helper;
  load.joining = {options.conformal, options.overlaps};
  if (options.time_limit) load.isolate_time_limit = std::max(load.isolate_time_limit, *options.time_limit);
  source.load = [&](const std::vector<std::uint32_t>& suspects, Context& while_loading) {
    load.suspects = suspects;
    return load_model(input.path, load, while_loading);
  };
  return mesh_source(source, options, context, report_on_failure);
}

}  // namespace curvetet
