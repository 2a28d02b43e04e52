// One run on a thread of its own, so that the caller's thread can listen to Ctrl-C and call back.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>

#include "curvetet/error.h"
#include "mesh_arrays.h"

namespace curvetet::python {

/// Throws curvetet.Error with all that the error says.
[[noreturn]] void raise(const Error& error, const pybind11::dict& report);

/// Meshes. `progress` and `log` are called from the caller's thread, or are None.
MadeMesh run_mesh(const std::filesystem::path& path, const pybind11::dict& options, bool keep_invalid,
                  const pybind11::object& progress, const pybind11::object& log);

}  // namespace curvetet::python
