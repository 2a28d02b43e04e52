#include "options.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace py = pybind11;

namespace curvetet::python {

namespace {

using Setter = std::function<void(Options&, const py::handle&)>;

/// A value of Python as a member's type; the error names the argument.
template <class T>
T as(const std::string& name, const py::handle& value) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + " cannot be " + py::repr(value).cast<std::string>());
  }
}

template <class T>
Setter member(const std::string& name, T Options::*place) {
  return [name, place](Options& options, const py::handle& value) { options.*place = as<T>(name, value); };
}

template <class T>
Setter optional_member(const std::string& name, std::optional<T> Options::*place) {
  return [name, place](Options& options, const py::handle& value) { options.*place = as<T>(name, value); };
}

template <class Word>
Setter word(const std::string& name, Word Options::*place, std::map<std::string, Word> words) {
  return [=](Options& options, const py::handle& value) {
    const auto found = words.find(as<std::string>(name, value));
    if (found == words.end()) throw py::value_error(name + " cannot be " + py::repr(value).cast<std::string>());
    options.*place = found->second;
  };
}

Setter local_sizes(const std::string& name, LocalSize::Kind kind) {
  return [=](Options& options, const py::handle& value) {
    if (!py::isinstance<py::dict>(value)) throw py::type_error(name + " must map ids or names to sizes");
    for (const auto& [which, size] : py::reinterpret_borrow<py::dict>(value))
      options.local_sizes.push_back({kind, py::str(which).cast<std::string>(), as<double>(name, size)});
  };
}

const std::map<std::string, Setter>& setters() {
  static const std::map<std::string, Setter> table = {
      {"size", optional_member("size", &Options::size)},
      {"size_divisor", member("size_divisor", &Options::size_divisor)},
      {"min_size", optional_member("min_size", &Options::min_size)},
      {"curvature", member("curvature", &Options::curvature)},
      {"chord_height", optional_member("chord_height", &Options::chord_height)},
      {"grading", member("grading", &Options::grading)},
      {"gaps", member("gaps", &Options::gaps)},
      {"face_sizes", local_sizes("face_sizes", LocalSize::Kind::face)},
      {"edge_sizes", local_sizes("edge_sizes", LocalSize::Kind::edge)},
      {"solid_sizes", local_sizes("solid_sizes", LocalSize::Kind::solid)},
      {"unit", member("unit", &Options::unit)},
      {"input_unit", member("input_unit", &Options::input_unit)},
      {"conformal",
       word<Conformal>("conformal", &Options::conformal,
                       {{"auto", Conformal::automatic}, {"off", Conformal::off}, {"strict", Conformal::strict}})},
      {"overlaps",
       word<Overlaps>("overlaps", &Options::overlaps, {{"refuse", Overlaps::refuse}, {"split", Overlaps::split}})},
      {"min_feature", member("min_feature", &Options::min_feature)},
      {"recovery", word<RecoveryMode>("recovery", &Options::recovery,
                                      {{"conjoint", RecoveryMode::conjoint}, {"paper", RecoveryMode::paper}})},
      {"refine_interior", member("refine_interior", &Options::refine_interior)},
      {"improve", member("improve", &Options::improve)},
      {"radius_edge", member("radius_edge", &Options::radius_edge)},
      {"time_limit", optional_member("time_limit", &Options::time_limit)},
      {"memory_limit", member("memory_limit", &Options::memory_limit)},
      {"threads", member("threads", &Options::threads)},
      {"seed", member("seed", &Options::seed)},
      {"isolate_cad", member("isolate_cad", &Options::isolate_cad)},
      {"dossier",
       [](Options& options, const py::handle& value) {
         options.dossier = as<std::filesystem::path>("dossier", value).string();
       }},
      {"cad_helper", member("cad_helper", &Options::cad_helper)},
  };
  return table;
}

/// The function is shared, since copies of a Python object need the interpreter's lock and Options may be copied
/// without it.
std::function<double(Point)> size_function(const py::function& function,
                                           std::function<void(py::error_already_set)> on_raise) {
  const std::shared_ptr<py::function> shared(new py::function(function), [](py::function* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
  return [shared, on_raise = std::move(on_raise)](Point p) {
    const py::gil_scoped_acquire lock;
    try {
      return (*shared)(p[0], p[1], p[2]).cast<double>();
    } catch (py::error_already_set& raised) {
      on_raise(std::move(raised));
    } catch (const py::cast_error&) {
      PyErr_SetString(PyExc_TypeError, "size_callback must return a number");
      on_raise(py::error_already_set());
    }
    return 0.0;
  };
}

}  // namespace

Options options_from(const py::dict& given, const std::function<void(py::error_already_set)>& on_raise) {
  Options options;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (name == "size_callback") {
      if (PyCallable_Check(value.ptr()) == 0) throw py::type_error("size_callback cannot be called");
      options.size_callback = size_function(py::reinterpret_borrow<py::function>(value), on_raise);
      continue;
    }
    const auto setter = setters().find(name);
    if (setter == setters().end()) throw py::type_error("unknown option " + name);
    setter->second(options, value);
  }
  return options;
}

}  // namespace curvetet::python
