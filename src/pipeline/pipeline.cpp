// The stages in the order of the paper's Fig. 1 and DESIGN's list. This function reads like that list; what a stage
// promised is checked before the next one starts.
#include "pipeline/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <utility>

#include "base/fnv.h"
#include "boundary/classify.h"
#include "cad/kept_body.h"
#include "cad/load.h"
#include "pipeline/assemble.h"
#include "pipeline/body_mesher.h"
#include "pipeline/dossier.h"
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
  Fnv1a hash;
  char buffer[1 << 16];
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0)
    hash.add(std::string_view(buffer, static_cast<std::size_t>(in.gcount())));
  return fmt::format("{:016x}", hash.value());
}

/// What a run leaves for its dossier, whatever becomes of it.
struct Trace {
  OuterLoop loop;
  std::optional<Mesh> spot;  ///< of the failure that is told first
};

/// The stages from sizes to the finished mesh, for a whole body or a part of one.
class BodyRun {
 public:
  BodyRun(const Source& source, const Model& model, const Settings& settings, const Options& options, Trace& trace,
          StageClock& clock, Context& context, Report& report)
      : source_(source),
        model_(model),
        settings_(settings),
        options_(options),
        trace_(trace),
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
    if (!loop_fits())
      return Error{ErrorCode::file_unreadable, "the state of " + source_.name + " names faces that it has not"};
    auto body = mesh_body(model_, sizes_, settings_, options_, trace_.loop, clock_, context_);
    if (!body.ok()) return body.error();
    body_ = std::move(body.value());
    report_reductions(report_, model_, settings_, sizes_);
    report_.rounds = std::max(report_.rounds, body_.rounds);
    report_recovery(report_, body_);
    if (body_.failures.empty()) return Done{};
    for (const RecoveryFailure& f : body_.failures)
      report_.errors.push_back(to_error(f, model_, settings_, gap_between(model_, *body_.mesh, f, reach(f))));
    const RecoveryFailure& first = told_first();
    if (!options_.dossier.empty()) trace_.spot = spot_of(model_, settings_, *body_.mesh, first, reach(first));
    return report_.errors.front();
  }

  /// How far from the place of a failure something still belongs to it.
  double reach(const RecoveryFailure& failure) const {
    constexpr double kSizes = 4;
    return kSizes * sizes_.at(failure.where);
  }

  /// An outer loop that was read from a file is to be of this body.
  bool loop_fits() const {
    const auto known = [&](FaceId f) { return !f.valid() || f.value() < model_.faces.size(); };
    for (const std::vector<SizeSource>& asked : trace_.loop.asked)
      for (const SizeSource& s : asked)
        if (!known(s.face) || !known(s.other)) return false;
    return true;
  }

  /// The first failure, or a crossing that the CAD kernel confirms. It is asked about the first one only: it reads the
  /// body again for that.
  const RecoveryFailure& told_first() {
    const auto failure =
        std::find_if(body_.failures.begin(), body_.failures.end(), [](const RecoveryFailure& f) { return f.crossing; });
    if (failure == body_.failures.end() || failure->proved) return body_.failures.front();
    std::vector<std::uint32_t> faces;
    for (const FaceId f : failure->faces) faces.push_back(model_.faces[f].label.cad_id);
    const Result<Model> again = source_.load(faces, context_);
    if (again || again.error().code != ErrorCode::self_intersection) return body_.failures.front();
    // What is proved is told first.
    const auto error = report_.errors.begin() + (failure - body_.failures.begin());
    error->code = again.error().code;
    error->message += "; " + again.error().message;
    error->hint = crossing_hint(*failure, model_);
    std::rotate(report_.errors.begin(), error, error + 1);
    return *failure;
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
  Trace& trace_;
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
    Result<Mesh> mesh = apart() ? mesh_parts() : mesh_one(model_, settings_, 0);
    if (!mesh.ok()) return mesh.error();
    return finish(std::move(mesh.value()));
  }

  /// To be called when the run is over: times, and the dossier if it failed.
  void end() {
    clock_.stop();
    report_.stages = clock_.times();
    report_.peak_bytes = peak_resident_memory();
    // Linux keeps the two by counters that are exact to some pages only.
    for (const StageTime& stage : report_.stages) report_.peak_bytes = std::max(report_.peak_bytes, stage.bytes);
    const bool failed = !report_.errors.empty() && !context_.cancelled();
    if (failed && !options_.dossier.empty()) leave_dossier();
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
    is_ready_ = true;
    return Done{};
  }

  Result<Mesh> mesh_one(const Model& model, const Settings& settings, std::size_t part) {
    trace_.loop = part == source_.loop.part ? source_.loop : OuterLoop{part, {}};
    return BodyRun(source_, model, settings, options_, trace_, clock_, context_, report_)();
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
      Result<Mesh> made = mesh_one(part.model, settings, i);
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

  /// Whatever happens here, the run's own error stays what it is.
  void leave_dossier() {
    // Time that is up must not keep the dossier from being written.
    const auto deadline = std::exchange(context_.deadline, std::nullopt);
    const Status written = try_dossier();
    context_.deadline = deadline;
    if (written) {
      context_.log(LogLevel::info, "what failed, and how to repeat it, is in " + options_.dossier);
      return;
    }
    const Error& error = written.error();
    report_.warnings.push_back(fmt::format("the dossier is not complete: {} [{}]", error.message, name(error.code)));
    context_.log(LogLevel::warning, report_.warnings.back());
  }

  Status try_dossier() {
    try {
      return write_dossier(failed_run(), options_.dossier);
    } catch (const std::exception& error) {
      return Error{ErrorCode::internal, error.what()};
    }
  }

  FailedRun failed_run() {
    FailedRun run{.report = report_};
    if (is_ready_) run.in_words = entities_in_words(model_);
    run.spot = std::move(trace_.spot);
    run.parts = [&](const std::vector<std::string>& names) { return source_.parts(names, context_); };
    if (!is_ready_)
      run.no_state = "the run ended before there was an attempt to repeat";
    else if (options_.size_callback)
      run.no_state = "sizes came from a function of the caller, which no file can hold";
    else
      keep_state(run);
    return run;
  }

  void keep_state(FailedRun& run) {
    Result<std::string> body = source_.body();
    if (!body) {
      run.no_state = body.error().message;
      return;
    }
    run.state = State{report_.version, source_.name, options_, trace_.loop, report_.errors.front()};
    run.state->size = model_.frame.length_to_cad(settings_.size) * settings_.unit_scale;
    run.state->body = std::move(body.value());
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
  bool is_ready_ = false;  ///< loaded, and the options fit the body
  Trace trace_;
};

}  // namespace

Error error_of(const std::exception& thrown, const Options& options) {
  if (dynamic_cast<const std::bad_alloc*>(&thrown) == nullptr)
    return {ErrorCode::internal, thrown.what(), {}, {}, "please report it, with the input and the options"};
  if (options.memory_limit == 0) return {ErrorCode::internal, "out of memory", {}, {}, "ask for a larger size"};
  return {ErrorCode::memory_limit,
          "the memory limit was reached",
          {},
          {},
          "raise the memory limit, or ask for a larger size"};
}

Result<MeshOutput> mesh_source(const Source& source, const Options& options, Context& context,
                               Report* report_on_failure) {
  Report report;
  report.version = version();
  report.input = source.name;
  Run run(source, options, context, report);
  Result<Mesh> made = Error{};
  try {
    made = run();
  } catch (const std::exception& thrown) {
    report.errors.insert(report.errors.begin(), error_of(thrown, options));
    run.end();
    throw;
  }
  if (!made.ok() && report.errors.empty()) report.errors.push_back(made.error());
  run.end();
  if (made.ok()) return MeshOutput{std::move(made.value()), std::move(report)};
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
  load.min_feature = {options.min_feature, options.unit};
  if (options.time_limit) load.isolate_time_limit = std::max(load.isolate_time_limit, *options.time_limit);
  KeptBody kept;
  source.load = [&](const std::vector<std::uint32_t>& suspects, Context& while_loading) {
    load.suspects = suspects;
    const bool keep = suspects.empty() && !options.dossier.empty();
    return load_model(input.path, load, while_loading, keep ? &kept : nullptr);
  };
  source.body = [&] { return pack_body(kept); };
  source.parts = [&](const std::vector<std::string>& parts, Context& while_reading) {
    return brep_of_parts(input.path, load, parts, while_reading);
  };
  return mesh_source(source, options, context, report_on_failure);
}

}  // namespace curvetet
