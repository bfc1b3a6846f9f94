// SPDX-License-Identifier: Apache-2.0
// NumPy arrays from and to C++: checked on the way in, without a copy on the way out.
#pragma once

#include <pybind11/numpy.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "binding.h"
#include "phalanx/core/number_range.h"
#include "phalanx/hand/joints.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::python {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Shape = std::vector<py::ssize_t>;

/// Numbers that an array may hold.
enum class Finite {
  kYes,  ///< NaN and infinity are refused
  kAny,
};

/// Reads an array of real numbers, or a nested sequence of them.
/// @param shape  expected; -1: any length
/// @throws py::type_error for other content than integers and floating-point numbers, py::value_error for
/// another shape, or a number that is not finite. what() begins with `name`
[[nodiscard]] Doubles read_doubles(const py::handle& value, const char* name,
                                   std::initializer_list<py::ssize_t> shape, Finite finite = Finite::kYes);

/// Reads one value for each joint.
/// @throws as read_doubles()
[[nodiscard]] JointArray read_joints(const py::handle& value, const char* name, Finite finite = Finite::kYes);

/// Reads an optional number.
/// @returns NaN for None
/// @throws py::type_error, py::value_error unless it is a number in the range
[[nodiscard]] double read_number(const py::object& value, const char* name, const NumberRange& range);

/// Reads a mesh from vertices (n, 3) [m] and triangles (m, 3), indices counted from 0.
/// @throws py::type_error, py::value_error for other arrays; std::invalid_argument as check_mesh()
[[nodiscard]] TriangleMesh read_mesh(const py::handle& vertices, const py::handle& triangles);

/// @returns a read-only array on memory of C++. It keeps `owner` alive and copies nothing
/// @param type     NumPy's character: 'd' double, '?' bool, 'I' unsigned, 'Q' unsigned long long, 'i' int
/// @param strides  in bytes
[[nodiscard]] py::array view_of(char type, Shape shape, Shape strides, const void* data,
                                const py::object& owner);

/// @returns a capsule that shares the ownership of an object: the owner of a view_of() its memory
template <class T>
[[nodiscard]] py::object shared_owner(std::shared_ptr<const T> object) {
  return py::capsule(new std::shared_ptr<const T>(std::move(object)),
                     [](void* owner) { delete static_cast<std::shared_ptr<const T>*>(owner); });
}

/// @returns an array that takes a vector's memory over, without a copy
[[nodiscard]] py::array take_doubles(std::vector<double> values, Shape shape);

/// @returns the vertices (n, 3) [m] and the triangles (m, 3) of a mesh, on its memory
[[nodiscard]] py::tuple mesh_views(const TriangleMesh& mesh, const py::object& owner);

}  // namespace phalanx::python
