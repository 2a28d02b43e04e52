// CLI11 describes and parses; what it cannot express (which format an output gets, that outputs differ from the input,
// sizes of named entities) is checked here, before any work. Ranges of numbers are the library's business.
#include "arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>

#include "curvetet/curvetet.h"
#include "own_program.h"

namespace curvetet::cli {

namespace {

constexpr const char* kFooter =
    R"(Lengths are in the unit of the output: --unit, by default mm; for BREP files, which carry no unit, --input-unit.

Examples:
  curvetet mesh bracket.step -o bracket.msh
  curvetet mesh bracket.step -o bracket.msh -o bracket.vtu --size 5 --report bracket.json
  curvetet mesh pump.step -o pump.msh --size 4 --face-size inlet=1 --face-size 12=0.5
  curvetet mesh bracket.step -o bracket.msh --size 5 --min-feature 0.05
  curvetet info bracket.step
  curvetet check bracket.msh bracket.step
  curvetet picture bracket.msh -o bracket.png --cut x=0.5
  curvetet mesh bracket.step -o bracket.msh --dossier why
  curvetet replay why/replay.bin
  curvetet batch parts/ --out meshes --jobs 4 --time-limit 120 -- --size D/20

Exit codes:
  0   done, and the mesh is valid
  2   the command line is wrong
  3   the input cannot be meshed, or a file cannot be read or written
  4   cancelled, or out of time or memory
  5   a mesh was made but is not valid (written only with --keep-invalid)
  70  internal error)";

constexpr std::size_t kLeastMemory = std::size_t{64} << 20U;

/// What the options of `mesh` say before they are checked together.
struct RawMesh {
  std::string size;
  std::vector<std::string> outputs, face_sizes, edge_sizes, solid_sizes;
  std::string format, recovery = "conjoint";
  bool parametric = false, no_gaps = false, no_refine = false, no_improve = false, no_isolate = false;
};

struct RawReplay {
  std::string size, recovery;
  std::vector<std::string> outputs, face_sizes, edge_sizes, solid_sizes;
};

struct RawPicture {
  std::string cut, size;
};

bool read_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// An empty value, as an unset variable of a script gives, would pass for an option that was not given.
CLI::Validator not_empty() {
  return {[](std::string& text) { return text.empty() ? std::string("an empty value") : std::string(); }, ""};
}

[[noreturn]] void refuse(const std::string& message) { throw CLI::ValidationError(message); }

void add_local_sizes(const std::vector<std::string>& texts, LocalSize::Kind kind, std::vector<LocalSize>& sizes) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    LocalSize local{kind, text.substr(0, equals), 0};
    if (equals == std::string::npos || equals == 0 || !read_number(text.substr(equals + 1), local.size)) {
      refuse(fmt::format("'{}' is not of the form ID_OR_NAME=SIZE", text));
    }
    sizes.push_back(local);
  }
}

bool is_msh(MeshFormat format) {
  return format == MeshFormat::msh41_binary || format == MeshFormat::msh41_ascii || format == MeshFormat::msh22;
}

/// The ending decides; --format chooses among the kinds of .msh, and decides where the ending is unknown.
WriteOptions write_options(const std::string& path, const RawMesh& raw) {
  WriteOptions options;
  options.parametric_nodes = raw.parametric;
  const Result<MeshFormat> by_ending = format_of(path);
  if (raw.format.empty()) {
    if (!by_ending) refuse(by_ending.error().message + "; " + by_ending.error().hint + ", or say --format");
    options.format = by_ending.value();
    return options;
  }
  const Result<MeshFormat> named = format_named(raw.format);
  if (!named) refuse(named.error().message + "; " + named.error().hint);
  const bool ending_leaves_choice = !by_ending || by_ending.value() == MeshFormat::msh41_binary;
  const bool named_fits = !by_ending || is_msh(named.value());
  options.format = ending_leaves_choice && named_fits ? named.value() : by_ending.value();
  return options;
}

/// The same place on the disk, whether it exists yet or not.
std::string place_of(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored).string();
}

/// Nothing is written over the input or over another output.
void refuse_collisions(const MeshCommand& command) {
  std::set<std::string> taken{place_of(command.input)};
  for (const Output& output : command.outputs) {
    if (!taken.insert(place_of(output.path)).second) refuse(output.path + " is named twice, or is the input itself");
  }
  if (!command.report.empty() && !taken.insert(place_of(command.report)).second) {
    refuse(command.report + " is named twice, or is the input itself");
  }
  if (const std::string& folder = command.options.dossier; !folder.empty() && taken.contains(place_of(folder)))
    refuse(folder + " is named twice, or is the input itself");
}

void read_size(const std::string& text, Options& options) {
  if (text.empty()) return;
  double value = 0;
  const bool part = text.rfind("D/", 0) == 0;
  if (!read_number(std::string_view(text).substr(part ? 2 : 0), value))
    refuse(fmt::format("--size takes a length, or a part of the diagonal as D/20, not '{}'", text));
  if (part) {
    options.size_divisor = value;
  } else {
    options.size = value;
  }
}

void refuse_little_memory(const Options& options) {
  if (options.memory_limit != 0 && options.memory_limit < kLeastMemory)
    refuse("--memory-limit must be at least 64M: the program itself needs some");
}

void finish_mesh(const RawMesh& raw, MeshCommand& command) {
  read_size(raw.size, command.options);
  bool format_used = raw.format.empty();
  for (const std::string& path : raw.outputs) {
    command.outputs.push_back({path, write_options(path, raw)});
    format_used = format_used || command.outputs.back().options.format == format_named(raw.format).value();
  }
  if (!format_used) refuse(fmt::format("--format {} does not fit the ending of any output", raw.format));
  refuse_collisions(command);
  add_local_sizes(raw.face_sizes, LocalSize::Kind::face, command.options.local_sizes);
  add_local_sizes(raw.edge_sizes, LocalSize::Kind::edge, command.options.local_sizes);
  add_local_sizes(raw.solid_sizes, LocalSize::Kind::solid, command.options.local_sizes);
  Options& options = command.options;
  refuse_little_memory(options);
  options.recovery = raw.recovery == "paper" ? RecoveryMode::paper : RecoveryMode::conjoint;
  options.gaps = !raw.no_gaps;
  options.refine_interior = !raw.no_refine;
  options.improve = !raw.no_improve;
  options.isolate_cad = !raw.no_isolate;
  options.cad_helper = own_program();
}

void finish_replay(const RawReplay& raw, ReplayCommand& command) {
  Options sizes;
  read_size(raw.size, sizes);
  ReplayChanges& changes = command.changes;
  if (!raw.size.empty()) {
    changes.size = sizes.size;
    if (!sizes.size) changes.size_divisor = sizes.size_divisor;
  }
  add_local_sizes(raw.face_sizes, LocalSize::Kind::face, changes.local_sizes);
  add_local_sizes(raw.edge_sizes, LocalSize::Kind::edge, changes.local_sizes);
  add_local_sizes(raw.solid_sizes, LocalSize::Kind::solid, changes.local_sizes);
  if (!raw.recovery.empty()) changes.recovery = raw.recovery == "paper" ? RecoveryMode::paper : RecoveryMode::conjoint;
  for (const std::string& path : raw.outputs) command.mesh.outputs.push_back({path, write_options(path, {})});
  refuse_collisions(command.mesh);
  refuse_little_memory(command.mesh.options);
}

void finish_picture(const RawPicture& raw, PictureCommand& command) {
  if (!raw.cut.empty()) {
    const std::size_t axis = std::string_view("xyz").find(raw.cut[0]);
    PictureCut cut;
    if (axis == std::string_view::npos || raw.cut.size() < 3 || raw.cut[1] != '=' ||
        !read_number(std::string_view(raw.cut).substr(2), cut.fraction) || !(cut.fraction >= 0 && cut.fraction <= 1)) {
      refuse(fmt::format("--cut takes x, y or z and a fraction of the box from 0 to 1, as x=0.5, not '{}'", raw.cut));
    }
    cut.axis = static_cast<int>(axis);
    command.options.cut = cut;
  }
  if (!raw.size.empty()) {
    const std::size_t times = raw.size.find('x');
    double width = 0, height = 0;
    if (times == std::string::npos || !read_number(std::string_view(raw.size).substr(0, times), width) ||
        !read_number(std::string_view(raw.size).substr(times + 1), height) || !(width >= 16 && width <= 8192) ||
        !(height >= 16 && height <= 8192)) {
      refuse(fmt::format("--size takes width and height from 16 to 8192 pixels, as 1200x900, not '{}'", raw.size));
    }
    command.options.width = static_cast<int>(width);
    command.options.height = static_cast<int>(height);
  }
}

/// A repeatable option that takes one value each time, so that it never swallows the input.
void add_repeatable(CLI::App& app, const std::string& name, std::vector<std::string>& values, const std::string& type,
                    const std::string& help, bool required = false) {
  app.add_option(name, values, help)->allow_extra_args(false)->type_name(type)->required(required);
}

constexpr const char* kSizes = "Sizes";

CLI::Option* add_size(CLI::App& app, std::string& size, const std::string& otherwise) {
  return app
      .add_option("--size", size,
                  "largest edge length; D/20: a twentieth of the body's diagonal, likewise any part; " + otherwise)
      ->check(not_empty())
      ->type_name("LENGTH")
      ->group(kSizes);
}

template <class Raw>
void describe_local_sizes(CLI::App& app, Raw& raw) {
  add_repeatable(app, "--face-size", raw.face_sizes, "ID_OR_NAME=LENGTH", "size on a face; may be repeated");
  add_repeatable(app, "--edge-size", raw.edge_sizes, "ID_OR_NAME=LENGTH", "size on an edge; may be repeated");
  add_repeatable(app, "--solid-size", raw.solid_sizes, "ID_OR_NAME=LENGTH", "size in a solid; may be repeated");
  for (const char* name : {"--face-size", "--edge-size", "--solid-size"}) app.get_option(name)->group(kSizes);
}

void describe_sizes(CLI::App& app, RawMesh& raw, Options& options) {
  const std::string group = kSizes;
  const auto length = [&](const char* name, std::optional<double>& value, const char* help) {
    app.add_option(name, value, help)->check(not_empty())->type_name("LENGTH")->group(group);
  };
  add_size(app, raw.size, "default: D/10");
  length("--min-size", options.min_size,
         "floor of derived sizes; default: a thousandth of the size, a fiftieth for the curvature of free forms");
  app.add_option("--curvature", options.curvature, "elements per full turn of a curve or surface; 0: off")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->group(group);
  length("--chord-height", options.chord_height, "largest distance of a chord to its arc; default: off");
  app.add_option("--grading", options.grading, "growth of the size per length")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->group(group);
  app.add_flag("--no-gaps", raw.no_gaps, "do not look at gaps and thin walls when choosing sizes")->group(group);
  describe_local_sizes(app, raw);
}

void describe_stages(CLI::App& app, RawMesh& raw, Options& options) {
  const std::string group = "Stages";
  app.add_option("--recovery", raw.recovery, "how faces are recovered: conjoint, or the paper to the letter")
      ->check(CLI::IsMember({"conjoint", "paper"}))
      ->type_name("MODE")
      ->capture_default_str()
      ->group(group);
  app.add_flag("--no-refine", raw.no_refine, "no points inside the solids")->group(group);
  app.add_flag("--no-improve", raw.no_improve, "leave the quality of the tetrahedra as it is")->group(group);
  app.add_option("--radius-edge", options.radius_edge,
                 "bound on circumradius over shortest edge, away from the boundary")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->group(group);
}

void add_overlaps(CLI::App& app, Overlaps& overlaps) {
  const std::map<std::string, Overlaps> names{{"refuse", Overlaps::refuse}, {"split", Overlaps::split}};
  app.add_option("--overlaps", overlaps,
                 "solids that overlap: refuse (default), or split, so that what they have in common is a solid of its "
                 "own")
      ->transform(CLI::CheckedTransformer(names).description(""))
      ->type_name("MODE");
}

void add_conformal(CLI::App& app, Conformal& conformal) {
  const std::map<std::string, Conformal> names{
      {"auto", Conformal::automatic}, {"off", Conformal::off}, {"strict", Conformal::strict}};
  app.add_option("--conformal", conformal,
                 "solids that touch: auto (default) joins them where the CAD kernel can, strict refuses where it "
                 "cannot, off meshes solids that share no face apart, even if they overlap")
      ->transform(CLI::CheckedTransformer(names).description(""))
      ->type_name("MODE");
}

void add_min_feature(CLI::App& app, double& length, const std::string& unit) {
  app.add_option(
         "--min-feature", length,
         "edges shorter and faces narrower than this are suppressed where that leaves a sound body, and listed, "
         "as --min-feature 0.05; at most a tenth of the body's diagonal; in " +
             unit + "; default: 0, off")
      ->check(not_empty())
      ->type_name("LENGTH");
}

constexpr const char* kLimits = "Limits";

void describe_limits(CLI::App& app, Options& options) {
  app.add_option("--threads", options.threads, "0: all cores; the mesh does not depend on it")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->group(kLimits);
  app.add_option("--time-limit", options.time_limit, "seconds for the whole run")
      ->check(not_empty())
      ->type_name("SECONDS")
      ->group(kLimits);
  app.add_option("--memory-limit", options.memory_limit, "bytes of memory for the program's data, as 800M or 4G")
      ->transform(CLI::AsSizeValue(false))
      ->option_text("BYTES")
      ->group(kLimits);
}

void describe_units_and_limits(CLI::App& app, RawMesh& raw, Options& options) {
  app.add_option("--unit", options.unit, "unit of the output: um, mm, cm, m, inch, ft; default: mm, or --input-unit")
      ->type_name("UNIT")
      ->group("Units");
  app.add_option("--input-unit", options.input_unit, "unit of an input that carries none (BREP); default: mm")
      ->type_name("UNIT")
      ->group("Units");
  app.add_flag("--no-isolate", raw.no_isolate, "read the CAD file in this process, not in a helper")->group(kLimits);
  app.add_option("--seed", options.seed, "of the random choices; same seed, same mesh")
      ->type_name("NUMBER")
      ->capture_default_str()
      ->group(kLimits);
  describe_limits(app, options);
}

CLI::App* describe_mesh(CLI::App& app, RawMesh& raw, MeshCommand& command) {
  CLI::App* mesh = app.add_subcommand("mesh", "Mesh a CAD file (STEP, IGES or BREP)");
  mesh->add_option("INPUT", command.input, "STEP, IGES or BREP file")->required()->type_name("FILE");
  add_repeatable(*mesh, "-o,--output", raw.outputs, "FILE",
                 "mesh to write, by its ending: .msh (Gmsh 4.1), .msh2 (Gmsh 2.2), .vtu, .mesh (Medit), .stl; may be "
                 "repeated",
                 true);
  mesh->add_option("--format", raw.format, "for .msh or an unknown ending: msh, msh-ascii, msh22, vtu, mesh, stl")
      ->type_name("FORMAT");
  mesh->add_flag("--parametric", raw.parametric,
                 ".msh: boundary nodes with their parameters as Gmsh's parametric nodes");
  mesh->add_option("--report", command.report, "JSON report, also written when meshing fails")->type_name("FILE");
  mesh->add_option("--dossier", command.options.dossier,
                   "folder for what a failed run leaves: words, the CAD faces, the surface meshes of the spot, and the "
                   "state for replay")
      ->check(not_empty())
      ->type_name("DIR");
  mesh->add_flag("--keep-invalid", command.keep_invalid, "write the mesh even if the final check finds it invalid");
  add_conformal(*mesh, command.options.conformal);
  add_overlaps(*mesh, command.options.overlaps);
  add_min_feature(*mesh, command.options.min_feature, "the unit of the output");
  CLI::Option* quiet = mesh->add_flag("-q,--quiet", command.quiet, "say nothing but errors")->option_text(" ");
  mesh->add_flag("-v,--verbose", command.verbose, "say more")->excludes(quiet)->option_text(" ");
  describe_sizes(*mesh, raw, command.options);
  describe_stages(*mesh, raw, command.options);
  describe_units_and_limits(*mesh, raw, command.options);
  return mesh;
}

CLI::App* describe_replay(CLI::App& app, RawReplay& raw, ReplayCommand& command) {
  CLI::App* replay =
      app.add_subcommand("replay",
                         "Make the last attempt of a failed run again, from the replay.bin of its dossier, and say "
                         "whether it fails alike; "
                         "with other sizes, recovery or seed from the first attempt. Exit codes as of mesh");
  MeshCommand& mesh = command.mesh;
  ReplayChanges& changes = command.changes;
  replay->add_option("FILE", mesh.input, "replay.bin of a dossier")->required()->type_name("FILE");
  add_repeatable(*replay, "-o,--output", raw.outputs, "FILE",
                 "mesh to write if it succeeds now, by its ending; may be repeated");
  replay->add_option("--report", mesh.report, "JSON report, also written when meshing fails")->type_name("FILE");
  replay->add_option("--dossier", mesh.options.dossier, "folder for what this run leaves if it fails")
      ->check(not_empty())
      ->type_name("DIR");
  replay->add_flag("--keep-invalid", mesh.keep_invalid, "write the mesh even if the final check finds it invalid");
  CLI::Option* quiet = replay->add_flag("-q,--quiet", mesh.quiet, "say nothing but errors")->option_text(" ");
  replay->add_flag("-v,--verbose", mesh.verbose, "say more")->excludes(quiet)->option_text(" ");
  add_size(*replay, raw.size, "default: as in the run");
  replay->add_option("--min-size", changes.min_size, "floor of derived sizes")
      ->check(not_empty())
      ->type_name("LENGTH")
      ->group(kSizes);
  replay->add_option("--curvature", changes.curvature, "elements per full turn of a curve or surface; 0: off")
      ->type_name("NUMBER")
      ->group(kSizes);
  describe_local_sizes(*replay, raw);
  replay->add_option("--recovery", raw.recovery, "how faces are recovered: conjoint, or the paper to the letter")
      ->check(CLI::IsMember({"conjoint", "paper"}))
      ->type_name("MODE");
  replay->add_option("--seed", changes.seed, "of the random choices")->type_name("NUMBER");
  describe_limits(*replay, mesh.options);
  return replay;
}

CLI::App* describe_info(CLI::App& app, InfoCommand& command) {
  CLI::App* info = app.add_subcommand("info", "List the solids, faces and edges of a CAD file, with ids and names");
  info->add_option("INPUT", command.input, "STEP, IGES or BREP file")->required()->type_name("FILE");
  info->add_flag("--json", command.json, "as JSON");
  info->add_option("--input-unit", command.input_unit, "unit of an input that carries none (BREP)")->type_name("UNIT");
  add_conformal(*info, command.joining.conformal);
  add_overlaps(*info, command.joining.overlaps);
  add_min_feature(*info, command.min_feature, "mm, or for BREP files in --input-unit");
  info->add_flag("!--no-isolate", command.isolate, "read the CAD file in this process, not in a helper")
      ->option_text(" ");
  return info;
}

CLI::App* describe_check(CLI::App& app, CheckCommand& command) {
  CLI::App* check = app.add_subcommand("check", "Check a mesh, alone or against its CAD file; exit code 5 if invalid");
  check->add_option("MESH", command.mesh, ".msh, .vtu (of curvetet) or .mesh file")->required()->type_name("FILE");
  check->add_option("CAD", command.cad, "STEP, IGES or BREP file that the mesh was made from")->type_name("FILE");
  check->add_flag("--json", command.json, "as JSON");
  check
      ->add_option("--unit-scale", command.unit_scale,
                   "length in the mesh of a unit of the CAD file; default: from the units of both")
      ->check(not_empty())
      ->type_name("NUMBER");
  check->add_option("--input-unit", command.input_unit, "unit of a CAD file that carries none (BREP)")
      ->type_name("UNIT");
  add_conformal(*check, command.joining.conformal);
  add_overlaps(*check, command.joining.overlaps);
  add_min_feature(*check, command.min_feature, "the unit of the mesh, as when it was made");
  check->add_flag("!--no-isolate", command.isolate, "read the CAD file in this process, not in a helper")
      ->option_text(" ");
  check->add_option("--threads", command.threads, "0: all cores")->type_name("NUMBER")->check(CLI::Range(0, 4096));
  return check;
}

CLI::App* describe_picture(CLI::App& app, RawPicture& raw, PictureCommand& command) {
  CLI::App* picture = app.add_subcommand("picture", "Draw a mesh to a PNG file");
  picture->add_option("MESH", command.mesh, ".msh, .vtu (of curvetet) or .mesh file")->required()->type_name("FILE");
  picture->add_option("-o,--output", command.output, "PNG file to write")->required()->type_name("FILE");
  picture->add_option("--cut", raw.cut, "cut across an axis at a fraction of the box, as x=0.5")
      ->type_name("AXIS=FRACTION");
  picture->add_option("--size", raw.size, "width and height in pixels")->default_str("1200x900")->type_name("WxH");
  return picture;
}

CLI::App* describe_batch(CLI::App& app, BatchCommand& command) {
  CLI::App* batch = app.add_subcommand(
      "batch",
      "Mesh many bodies, each in a process of its own; goes on where an earlier one ended. Exit code 5 if any failed");
  batch
      ->add_option("SOURCE", command.source,
                   "folder of CAD files, or a list: in each line a path, relative to the list, and options for "
                   "that body alone, separated by tabs")
      ->required()
      ->type_name("LIST|DIR");
  batch
      ->add_option("--out", command.out,
                   "folder for meshes, reports, results.jsonl (a line for each body) and summary.json")
      ->required()
      ->type_name("DIR")
      ->check(not_empty());
  batch->add_option("--jobs", command.jobs, "bodies at a time; 0: as many as there are cores, which they share")
      ->type_name("NUMBER")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  batch->add_option("--time-limit", command.time_limit, "for each body")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  batch->add_option("--memory-limit", command.memory_limit, "for each body, as 800M or 4G; default: none")
      ->transform(CLI::AsSizeValue(false))
      ->option_text("BYTES");
  batch->add_option("--format", command.format, "ending of the meshes: msh, msh2, vtu, mesh, stl")
      ->check(CLI::IsMember({"msh", "msh2", "vtu", "mesh", "stl"}).description(""))
      ->type_name("FORMAT")
      ->capture_default_str();
  batch
      ->add_option("--dossier", command.dossiers,
                   "folder for dossiers: of each body that fails, in a folder named as its mesh without the ending")
      ->check(not_empty())
      ->type_name("DIR");
  batch->add_flag("--restart", command.restart, "forget what is done already in the folder");
  batch->add_flag("-q,--quiet", command.quiet, "only the summary and errors")->option_text(" ");
  batch->add_option("MESH_OPTIONS", command.mesh_options, "after --: options of mesh for all bodies")->type_name("...");
  return batch;
}

}  // namespace

// Each body's program would refuse them; better once, before any work.
std::optional<std::string> wrong_batch_options(const std::vector<std::string>& options, const std::string& format) {
  for (const std::string& option : options) {
    const std::string word = option.substr(0, option.find('='));
    for (const char* own :
         {"-o", "--output", "--report", "--dossier", "--time-limit", "--memory-limit", "-h", "--help"})
      if (word == own) return word + " cannot be handed to the bodies of a batch";
  }
  CLI::App app;
  RawMesh raw;
  MeshCommand mesh;
  describe_mesh(app, raw, mesh);
  std::vector<std::string> words{"mesh", "INPUT", "-o", "OUTPUT." + format};
  words.insert(words.end(), options.begin(), options.end());
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(words);
    finish_mesh(raw, mesh);
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return std::nullopt;
}

Arguments parse(int argc, char** argv) {
  CLI::App app("curvetet: valid, conformal, labelled tetrahedral meshes of CAD bodies with curved boundaries.");
  app.set_version_flag("--version", std::string("curvetet ") + version());
  app.require_subcommand(1);
  app.footer(kFooter);
  RawMesh raw_mesh;
  RawReplay raw_replay;
  RawPicture raw_picture;
  MeshCommand mesh;
  ReplayCommand replay;
  InfoCommand info;
  CheckCommand check;
  PictureCommand picture;
  BatchCommand batch;
  const CLI::App* mesh_app = describe_mesh(app, raw_mesh, mesh);
  const CLI::App* replay_app = describe_replay(app, raw_replay, replay);
  const CLI::App* info_app = describe_info(app, info);
  const CLI::App* check_app = describe_check(app, check);
  const CLI::App* picture_app = describe_picture(app, raw_picture, picture);
  const CLI::App* batch_app = describe_batch(app, batch);
  for (CLI::App* command : app.get_subcommands({})) command->footer(kFooter);
  Arguments arguments;
  try {
    app.parse(argc, argv);
    if (mesh_app->parsed()) finish_mesh(raw_mesh, mesh);
    if (replay_app->parsed()) finish_replay(raw_replay, replay);
    if (picture_app->parsed()) finish_picture(raw_picture, picture);
    if (batch_app->parsed()) {
      if (const auto wrong = wrong_batch_options(batch.mesh_options, batch.format)) refuse(*wrong);
    }
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app.exit(error, std::cout, std::cerr);
    } else {
      std::cerr << "curvetet: " << error.what() << "\nSee curvetet --help.\n";
      arguments.exit_code = 2;
    }
    return arguments;
  }
  if (mesh_app->parsed()) arguments.mesh = std::move(mesh);
  if (replay_app->parsed()) arguments.replay = std::move(replay);
  if (info_app->parsed()) arguments.info = std::move(info);
  if (check_app->parsed()) arguments.check = std::move(check);
  if (picture_app->parsed()) arguments.picture = std::move(picture);
  if (batch_app->parsed()) arguments.batch = std::move(batch);
  return arguments;
}

}  // namespace curvetet::cli
