// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace phalanx::python {
namespace {

std::string shape_text(const py::ssize_t* shape, std::size_t dimensions) {
  std::string text;
  for (std::size_t i = 0; i < dimensions; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : ", ", shape[i] < 0 ? "n" : std::to_string(shape[i]));
  return dimensions == 1 ? "(" + text + ",)" : "(" + text + ")";
}

/// @returns the value as an array of integers or floating-point numbers, in its own type.
py::array numeric_array(const py::handle& value, const char* name, const char* kinds) {
  py::object found;
  if (!value.is_none() && !py::isinstance<py::str>(value) && !py::isinstance<py::bytes>(value))
    found = py::array::ensure(value);
  if (!found)
    throw py::type_error(fmt::format("{}: give an array of numbers, not {}", name,
                                     py::str(py::type::handle_of(value)).cast<std::string>()));
  auto array = py::reinterpret_borrow<py::array>(found);
  if (std::string(kinds).find(array.dtype().kind()) == std::string::npos)
    throw py::type_error(fmt::format("{}: the array's type is {}; give {}", name,
                                     py::str(array.dtype()).cast<std::string>(),
                                     kinds[0] == 'f' ? "real numbers" : "integers"));
  return array;
}

void check_shape(const py::array& array, const char* name, const py::ssize_t* shape, std::size_t dimensions) {
  bool fits = static_cast<std::size_t>(array.ndim()) == dimensions;
  for (std::size_t i = 0; fits && i < dimensions; ++i)
    fits = shape[i] < 0 || array.shape(static_cast<py::ssize_t>(i)) == shape[i];
  if (!fits)
    throw py::value_error(fmt::format("{}: the shape is {}; expected {}", name,
                                      shape_text(array.shape(), static_cast<std::size_t>(array.ndim())),
                                      shape_text(shape, dimensions)));
}

/// Refuses an array before it is copied: a broadcast one may be far larger than the memory.
void check_size(const py::array& array, const char* name) {
  constexpr py::ssize_t kMost = py::ssize_t{1} << 27;  // 1 GiB of doubles
  if (array.size() > kMost)
    throw py::value_error(
        fmt::format("{}: the array has {} numbers, and at most {} are taken", name, array.size(), kMost));
}

}  // namespace

Doubles read_doubles(const py::handle& value, const char* name, std::initializer_list<py::ssize_t> shape,
                     Finite finite) {
  const py::array array = numeric_array(value, name, "fiu");
  check_shape(array, name, shape.begin(), shape.size());
  check_size(array, name);
  Doubles doubles = Doubles::ensure(array);
  if (!doubles) throw py::error_already_set();
  if (finite == Finite::kAny) return doubles;
  for (py::ssize_t i = 0; i < doubles.size(); ++i)
    if (!std::isfinite(doubles.data()[i]))
      throw py::value_error(fmt::format("{}: number {} (counted from 0) is {}; every one must be finite",
                                        name, i, doubles.data()[i]));
  return doubles;
}

JointArray read_joints(const py::handle& value, const char* name, Finite finite) {
  const Doubles doubles = read_doubles(value, name, {kJoints}, finite);
  JointArray joints{};
  std::copy_n(doubles.data(), joints.size(), joints.begin());
  return joints;
}

double read_number(const py::object& value, const char* name, const NumberRange& range) {
  if (value.is_none()) return std::numeric_limits<double>::quiet_NaN();
  if (py::isinstance<py::bool_>(value) ||
      (PyFloat_Check(value.ptr()) == 0 && PyIndex_Check(value.ptr()) == 0))
    throw py::type_error(fmt::format("{}: give a number, not {}", name,
                                     py::str(py::type::handle_of(value)).cast<std::string>()));
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (!range.contains(number))
    throw py::value_error(fmt::format("{} = {}: must be {}", name, number, range.text()));
  return number;
}

TriangleMesh read_mesh(const py::handle& vertices, const py::handle& triangles) {
  const Doubles points = read_doubles(vertices, "vertices", {-1, 3}, Finite::kAny);
  const py::array corners = numeric_array(triangles, "triangles", "iu");
  const py::ssize_t shape[] = {-1, 3};
  check_shape(corners, "triangles", shape, 2);
  check_size(corners, "triangles");
  using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
  const Indices indices = Indices::ensure(corners);
  if (!indices) throw py::error_already_set();
  if (points.shape(0) > std::numeric_limits<std::int32_t>::max())
    throw py::value_error("vertices: more than 32-bit indices reach; make the mesh coarser");
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(points.shape(0)));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    mesh.vertices[i] = Eigen::Map<const Vec3>(points.data() + 3 * i);
  mesh.triangles.resize(static_cast<std::size_t>(indices.shape(0)));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t index = indices.data()[3 * i + k];
      // An index beyond 32 bits stays invalid, so that check_mesh() refuses it.
      mesh.triangles[i][k] = index < 0 || index >= points.shape(0) ? -1 : static_cast<std::int32_t>(index);
      if (mesh.triangles[i][k] < 0)
        throw py::value_error(
            fmt::format("triangles: triangle {} names vertex {}, but there are {} vertices "
                        "(counted from 0)",
                        i, index, points.shape(0)));
    }
  check_mesh(mesh, "mesh");
  return mesh;
}

py::array view_of(char type, Shape shape, Shape strides, const void* data, const py::object& owner) {
  py::array array(py::dtype(std::string(1, type)), std::move(shape), std::move(strides), data, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

py::array take_doubles(std::vector<double> values, Shape shape) {
  Shape strides(shape.size());
  py::ssize_t stride = sizeof(double);
  for (std::size_t i = shape.size(); i-- > 0;) {
    strides[i] = stride;
    stride *= shape[i];
  }
  const auto owned = std::make_shared<const std::vector<double>>(std::move(values));
  return view_of('d', std::move(shape), std::move(strides), owned->data(), shared_owner(owned));
}

py::tuple mesh_views(const TriangleMesh& mesh, const py::object& owner) {
  constexpr py::ssize_t kVertex = sizeof(Vec3);
  constexpr py::ssize_t kCorners = sizeof(Triangle);
  const auto count = [](const auto& list) { return static_cast<py::ssize_t>(list.size()); };
  return py::make_tuple(
      view_of('d', {count(mesh.vertices), 3}, {kVertex, sizeof(double)}, mesh.vertices.data(), owner),
      view_of('i', {count(mesh.triangles), 3}, {kCorners, sizeof(std::int32_t)}, mesh.triangles.data(),
              owner));
}

}  // namespace phalanx::python
