// SPDX-License-Identifier: Apache-2.0
// What the files of the Python module share. Each bind_ function adds one concept to phalanx._core.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <string>

namespace phalanx::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_scene(py::module_& module);
void bind_run(py::module_& module);
void bind_stepper(py::module_& module);
void bind_laboratory(py::module_& module);
void bind_recording(py::module_& module);

/// Calls a Python function from code that runs without the global interpreter lock (GIL).
/// Before the call it lets Python handle signals, so that Ctrl-C ends a long call.
/// @param function  None: signals only
/// @throws py::error_already_set with what the function or a signal's handler raised
template <class... Arguments>
void call_python(const py::object& function, const Arguments&... arguments) {
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!function.is_none()) function(arguments...);
}

/// Checks that an optional argument can be called.
/// @throws py::type_error naming the argument
inline void check_function(const py::object& function, const char* name) {
  if (!function.is_none() && PyCallable_Check(function.ptr()) == 0)
    throw py::type_error(std::string(name) + ": give a function, or None");
}

/// Reads a path: a text or an object of os.PathLike.
/// @throws py::error_already_set with a TypeError for others
inline std::filesystem::path read_path(const py::handle& path) {
  return py::module_::import("os").attr("fsencode")(path).cast<std::string>();
}

/// Makes an object that its constructor fills, as pybind11 does.
inline PyObject* new_object(PyTypeObject* type, PyObject* arguments, PyObject* names) {
  return py::detail::pybind11_object_new(type, arguments, names);
}

/// Closes the two ways on which Python makes an object that C++ has not constructed, whose use would crash:
/// copying and pickling, and a call of Class.__new__. Python refuses the latter for a class whose function for
/// new objects is not that of its base.
template <class Class>
void close_class(Class& bound) {
  reinterpret_cast<PyTypeObject*>(bound.ptr())->tp_new = &new_object;
  const auto refuse = [](const py::object& self, const py::args&) -> py::object {
    throw py::type_error("cannot copy or pickle a " +
                         py::type::handle_of(self).attr("__name__").template cast<std::string>());
  };
  bound.def("__reduce_ex__", refuse);
  bound.def("__reduce__", refuse);
}

}  // namespace phalanx::python
