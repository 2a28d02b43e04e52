// The extension behind the package curvetet; its Python side has the words for users.
#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include "curvetet/curvetet.h"
#include "mesh_arrays.h"
#include "run.h"

namespace py = pybind11;

PYBIND11_MODULE(_curvetet, module) {
  module.doc() = "Implementation of the package curvetet.";
  module.attr("__version__") = curvetet::version();
  py::register_exception_translator(
      [](std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11 says so
        try {
          if (thrown) std::rethrow_exception(thrown);
        } catch (const curvetet::InternalError& error) {
          PyErr_SetString(py::module_::import("curvetet").attr("InternalError").ptr(), error.what());
        }
      });
  curvetet::python::register_mesh(module);
  module.def("mesh", &curvetet::python::run_mesh);
}
