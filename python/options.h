// From keyword arguments to curvetet::Options.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "curvetet/options.h"

namespace curvetet::python {

/// Keys are the names of Options' members; sizes of entities are mappings. TypeError for an unknown key or a value of
/// the wrong type; ValueError for an unknown word. Ranges are the library's business. `size_callback` is wrapped: it
/// takes the interpreter's lock, and what it raises goes to `on_raise`, after which it returns 0.
Options options_from(const pybind11::dict& given, const std::function<void(pybind11::error_already_set)>& on_raise);

}  // namespace curvetet::python
