// What a run needs to make its last attempt again without the CAD file: the healed body, the options that decide the
// mesh, and where the outer loop stood. One file, replay.bin of a dossier.
//
// It belongs to the pipeline, since only that knows options and outer loop; the body's bytes are cad's (kept_body.h).
//
// Layout: 16 bytes "curvetet replay\n"; u32 version of the layout; u64 length of the JSON; u64 length of the body; u64
// FNV-1a hash of JSON and body; JSON; body. Little-endian.
#pragma once

#include <cstddef>
#include <string>

#include "base/error.h"
#include "curvetet/options.h"
#include "pipeline/body_mesher.h"

namespace curvetet {

struct State {
  std::string version;  ///< of the program that wrote it
  std::string input;    ///< what messages call the body
  Options options;      ///< without limits, threads and what is only about reading
  OuterLoop loop;
  Error failure;       ///< the first error that the run reported
  double size = 0;     ///< largest edge length that was asked for, in the output's unit
  std::string body{};  ///< as pack_body makes it
};

Status write_state(const State& state, const std::string& path);
/// Any file: one that is no state, is damaged or cut short is an error (file_unreadable), as is one of another layout
/// (unknown_format). The hash guards against damage, not against malice: the body goes to OpenCASCADE.
Result<State> read_state(const std::string& path);

}  // namespace curvetet
