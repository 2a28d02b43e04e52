// A mesh as numpy arrays.
#pragma once

#include <pybind11/pybind11.h>

#include "curvetet/curvetet.h"

namespace curvetet::python {

/// What `curvetet.mesh` returns.
struct MadeMesh {
  Mesh mesh;
  pybind11::dict report;
};

/// Registers Mesh. Points and elements are read-only views of the mesh's own memory; ids are copies.
void register_mesh(pybind11::module_& module);

}  // namespace curvetet::python
