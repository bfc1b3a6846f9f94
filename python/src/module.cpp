// SPDX-License-Identifier: Apache-2.0
// The module phalanx._core: errors, names and version. docs/python.md describes the package.
#include <pybind11/pybind11.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include "binding.h"
#include "phalanx/core/status.h"
#include "phalanx/hand/joints.h"
#include "phalanx/record/made.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/rendering_version.h"

namespace phalanx::python {
namespace {

/// Raises OSError(number, text).
void raise_os_error(const std::system_error& error) {
  const py::tuple arguments = py::make_tuple(error.code().value(), error.what());
  PyErr_SetObject(PyExc_OSError, arguments.ptr());
}

template <class NameOf>
py::tuple names(int count, NameOf name_of) {
  py::tuple all(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all[static_cast<std::size_t>(i)] = py::str(std::string(name_of(i)));
  return all;
}

}  // namespace

void bind_errors(py::module_& module) {
  // Immortal, as the types of a module are.
  static PyObject* const error = PyErr_NewExceptionWithDoc(
      "phalanx.Error", "An error of Phalanx. str() names the place, the value and the remedy.", nullptr,
      nullptr);
  static PyObject* const scene_error = PyErr_NewExceptionWithDoc(
      "phalanx.SceneError", "A scene, or a file that it names, cannot be used.",
      py::make_tuple(py::handle(error), py::handle(PyExc_ValueError)).ptr(), nullptr);
  module.attr("Error") = py::handle(error);
  module.attr("SceneError") = py::handle(scene_error);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const py::builtin_exception&) {
      throw;  // pybind11's own
    } catch (const SceneError& refused) {
      PyErr_SetString(scene_error, refused.what());
    } catch (const std::system_error& failed) {
      raise_os_error(failed);
    } catch (const std::runtime_error& failed) {
      PyErr_SetString(error, failed.what());
    }
  });
}

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of the package phalanx.";
  bind_errors(module);
  module.attr("JOINTS") = names(kJoints, joint_name);
  module.attr("SEGMENTS") = names(kSegments, segment_name);
  module.attr("DIGITS") = names(kDigits, digit_name);
  module.attr("STATUS_BITS") = names(kStatusBits, status_name);
  module.attr("__version__") = PHALANX_VERSION;
  module.attr("RENDERING_VERSION") = kRenderingVersion;
  module.def(
      "made",
      [] {
        const Made made = made_here();
        py::dict about;
        about["commit"] = made.commit;
        about["compiler"] = made.compiler;
        about["build_type"] = made.build_type;
        about["cpu"] = made.cpu;
        return about;
      },
      "Returns commit, compiler and build type of this module, and the processor.");
  bind_scene(module);
  bind_run(module);
  bind_stepper(module);
  bind_laboratory(module);
  bind_recording(module);
}

}  // namespace phalanx::python
