// The command line as structs: what was asked for, before anything is done.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cad/joining.h"
#include "curvetet/error.h"
#include "curvetet/options.h"
#include "io/formats.h"
#include "io/picture.h"

namespace curvetet::cli {

struct Output {
  std::string path;
  WriteOptions options;
};

struct MeshCommand {
  std::string input;
  std::vector<Output> outputs;
  Options options;
  std::string report;  ///< empty: none
  bool quiet = false, verbose = false, keep_invalid = false;
};

/// What a replay is to do otherwise than the run that left the state; nothing: the attempt as it was.
struct ReplayChanges {
  std::optional<double> size, size_divisor;  ///< one of them
  std::optional<double> min_size, curvature;
  std::vector<LocalSize> local_sizes;
  std::optional<RecoveryMode> recovery;
  std::optional<std::uint64_t> seed;
};

struct ReplayCommand {
  MeshCommand mesh;  ///< input is the state; of the options only limits, threads and dossier are meant
  ReplayChanges changes;
};

struct InfoCommand {
  std::string input, input_unit;
  Joining joining;
  double min_feature = 0;
  bool json = false, isolate = true;
};

struct CheckCommand {
  std::string mesh, cad;  ///< cad is empty where the mesh is checked alone
  std::string input_unit;
  Joining joining;
  double min_feature = 0;
  std::optional<double> unit_scale;
  bool json = false, isolate = true;
  int threads = 0;
};

/// Many bodies, each by a program of its own.
struct BatchCommand {
  std::string source;  ///< a list, or a folder
  std::string out;
  int jobs = 1;             ///< at a time; 0: as many as there are cores
  double time_limit = 600;  ///< seconds for each body
  std::size_t memory_limit = 0;
  std::string format = "msh";
  std::string dossiers;  ///< folder for a dossier of each body that fails; empty: none
  std::vector<std::string> mesh_options;
  bool restart = false, quiet = false;
};

struct PictureCommand {
  std::string mesh, output;
  PictureOptions options;
};

/// What to do; exactly one of the commands is set, or none and `exit_code` says how to end (help, version, usage
/// error).
struct Arguments {
  std::optional<MeshCommand> mesh;
  std::optional<InfoCommand> info;
  std::optional<CheckCommand> check;
  std::optional<PictureCommand> picture;
  std::optional<BatchCommand> batch;
  std::optional<ReplayCommand> replay;
  int exit_code = 0;
};

/// What is wrong with options for the meshes of a batch, in words; nothing if they are right.
std::optional<std::string> wrong_batch_options(const std::vector<std::string>& options, const std::string& format);

/// Parses and checks the command line; help goes to standard output, complaints to standard error.
Arguments parse(int argc, char** argv);

}  // namespace curvetet::cli
