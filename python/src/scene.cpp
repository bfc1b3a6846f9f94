// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <utility>

#include "arrays.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/core/number_range.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/data_paths.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx::python {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 8;  // nesting of a value; no key has more than 3

std::string number_text(double number) {
  if (!std::isfinite(number)) return std::isnan(number) ? "nan" : number < 0.0 ? "-inf" : "inf";
  const std::string text = shortest_text(number);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

/// Writes a value of Python as TOML. @throws py::type_error for other types, or nesting that is too deep
std::string toml_value(const std::string& key, const py::handle& value, int depth = 0) {
  const py::object path = py::module_::import("os").attr("PathLike");
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return toml_string(value.cast<std::string>());
  if (py::isinstance(value, path)) return toml_string(read_path(value).string());
  if (PyFloat_Check(value.ptr()) != 0) return number_text(value.cast<double>());
  if (PyLong_Check(value.ptr()) != 0) return py::str(value).cast<std::string>();
  if (depth < kDeepest) {
    if (py::hasattr(value, "tolist")) return toml_value(key, value.attr("tolist")(), depth + 1);  // NumPy
    std::string text;
    if (py::isinstance<py::dict>(value)) {
      for (const auto& [name, part] : py::reinterpret_borrow<py::dict>(value)) {
        if (!py::isinstance<py::str>(name))
          throw py::type_error(fmt::format("{}: a key of a dict is a text, not {}", key,
                                           py::str(py::type::handle_of(name)).cast<std::string>()));
        text += fmt::format("{} {} = {}", text.empty() ? "" : ",", toml_string(name.cast<std::string>()),
                            toml_value(key, part, depth + 1));
      }
      return "{" + text + " }";
    }
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
      for (const py::handle part : value)
        text += (text.empty() ? "" : ", ") + toml_value(key, part, depth + 1);
      return "[" + text + "]";
    }
  }
  throw py::type_error(
      fmt::format("{}: give a number, a flag, a text, a path, or a list or dict of these, "
                  "not {}",
                  key, py::str(py::type::handle_of(value)).cast<std::string>()));
}

/// Reads a value as a file states it.
py::object from_toml(const std::string& text) {
  return py::module_::import("tomllib").attr("loads")("value = " + text)["value"];
}

/// @returns true if setting one key may depend on what the other has set
bool related(const std::string& a, const std::string& b) {
  const std::string& shorter = a.size() < b.size() ? a : b;
  const std::string& longer = a.size() < b.size() ? b : a;
  return longer.starts_with(shorter + ".") || (pattern_of(a) != a && pattern_of(b) != b);
}

/// Adds an override, or replaces the value of an earlier one where that gives the same scene.
void add_override(Overrides& overrides, const std::string& key, std::string value) {
  for (auto it = overrides.rbegin(); it != overrides.rend(); ++it) {
    if (it->first == key) {
      it->second = std::move(value);
      return;
    }
    if (related(it->first, key)) break;
  }
  overrides.emplace_back(key, std::move(value));
}

/// @returns the value of a key: as stated, else its default; None if it has none
/// @throws py::key_error for an unknown key
py::object value_of(const Scene& scene, const std::string& key) {
  const Overrides values = scene.with_values().values;
  const auto stated = [&](const std::string& path) {
    return std::find_if(values.rbegin(), values.rend(), [&](const auto& v) { return v.first == path; });
  };
  if (const auto it = stated(key); it != values.rend()) return from_toml(it->second);
  const SceneKey* row = find_scene_key(pattern_of(key));
  if (row == nullptr) {
    std::vector<std::string> known;
    for (const SceneKey& each : scene_keys()) known.push_back(each.path);
    throw py::key_error(fmt::format("{}: there is no such key, and the scene does not state it; {}", key,
                                    did_you_mean(key, known)));
  }
  std::string kind = "teapot";
  if (row->is_of_objects()) {
    const auto it = stated(key.substr(0, key.rfind('.')) + ".kind");
    if (it == values.rend()) throw py::key_error(key + ": the scene states no such object");
    kind = from_toml(it->second).cast<std::string>();
  }
  const std::optional<KeyValue>& value = row->default_for(kind);
  return value ? from_toml(value_text(*row, *value)) : py::none();
}

std::optional<double> read_friction(const py::object& value) {
  const double coefficient = read_number(value, "friction", between(0.0, 2.0));
  return std::isnan(coefficient) ? std::nullopt : std::optional(coefficient);
}

/// A row of scene_keys(), for Python.
struct KeyRow {
  std::string path, type, unit, range, change, meaning;
  py::object default_value;
};

py::dict key_rows() {
  py::dict rows;
  for (const SceneKey& key : scene_keys()) {
    const SceneKeyText text = text_of(key);
    rows[py::str(key.path)] =
        KeyRow{key.path,
               text.type,
               key.unit,
               text.range,
               text.change,
               text.meaning,
               key.default_value ? from_toml(value_text(key, *key.default_value)) : py::object(py::none())};
  }
  return rows;
}

py::list scene_rows() {
  std::vector<SceneInfo> scenes;
  {
    const py::gil_scoped_release release;
    scenes = list_scenes();
  }
  py::list names;
  for (const SceneInfo& scene : scenes) names.append(py::make_tuple(scene.name, scene.description));
  return names;
}

}  // namespace

Scene::Scene(SceneFile file, std::string origin, const py::dict& set)
    : file_(std::move(file)), origin_(std::move(origin)) {
  set_all(set);
}

SceneDescription Scene::description() const {
  SceneDescription scene = file_.scene(overrides_);
  if (mesh_) {
    scene.objects.clear();
    scene.grasp.type.reset();  // a grasp is planned for the scene's own objects
  }
  return scene;
}

void Scene::set(const std::string& key, const py::handle& value) {
  py::dict one;
  one[py::str(key)] = value;
  set_all(one);
}

void Scene::set_all(const py::dict& values) {
  Overrides changed = overrides_;
  for (const auto& [key, value] : values) {
    if (!py::isinstance<py::str>(key)) throw py::type_error("set: every key must be a text");
    const std::string path = key.cast<std::string>();
    add_override(changed, path, toml_value(path, value));
  }
  static_cast<void>(file_.scene(changed));
  overrides_ = std::move(changed);
}

Scene Scene::with_mesh(TriangleMesh mesh, std::optional<double> friction) const {
  if (mesh.triangles.size() > kMostSceneTriangles)
    throw py::value_error(
        fmt::format("triangles: the mesh has {}, and at most {} are allowed; make it coarser",
                    mesh.triangles.size(), kMostSceneTriangles));
  Scene scene = *this;
  scene.mesh_ = std::make_shared<const Mesh>(Mesh{std::move(mesh), friction});
  return scene;
}

ResolvedScene Scene::resolve(const ResolveOptions& options) const {
  ResolvedScene scene = phalanx::resolve(description(), options);
  if (mesh_) {
    scene.world = mesh_->mesh;
    scene.friction = {{.first_triangle = 0, .coefficient = mesh_->friction}};
  }
  return scene;
}

void bind_scene(py::module_& module) {
  py::class_<KeyRow> row(module, "SceneKey", "A key that a scene may state, as docs/scenes.md lists it.");
  close_class(row);
  row.def_readonly("path", &KeyRow::path, "Name as in a file, such as \"force.law\" or \"objects[].kind\".")
      .def_readonly("type", &KeyRow::type, "number, integer, flag, text, choice, vector, file or name.")
      .def_readonly("unit", &KeyRow::unit, "Unit of its number; empty: none.")
      .def_readonly("range", &KeyRow::range, "The allowed values, in words.")
      .def_readonly("change", &KeyRow::change, "What a change in a running station needs.")
      .def_readonly("meaning", &KeyRow::meaning, "One line.")
      .def_readonly("default", &KeyRow::default_value, "Value of a key that is not stated; None: none.")
      .def("__repr__", [](const KeyRow& self) { return "<SceneKey " + self.path + ": " + self.type + ">"; });

  py::class_<Scene> scene(module, "Scene", R"(A scene: hand, objects, forces and motion.

scene: a name in scenes/ ("grasp_teapot"), or the path of a TOML file.
set: values of further keys, as "--set" on the command line: {"force.stiffness_n_per_mm": 0.9}.

scene[key] reads a value, or its default. scene[key] = value sets it, or raises SceneError and changes
nothing. Units are part of the keys' names; docs/scenes.md lists them, and so does scene_keys().)");
  close_class(scene);
  scene
      .def(py::init([](const py::object& source, const py::dict& set) {
             const std::string name = py::isinstance<py::str>(source)
                                          ? source.cast<std::string>()
                                          : fs::absolute(read_path(source)).string();
             return Scene(SceneFile(name), name, set);
           }),
           py::arg("scene") = "grasp_teapot", py::arg("set") = py::dict())
      .def_static(
          "from_text",
          [](const std::string& text, const fs::path& folder, const py::dict& set) {
            return Scene(SceneFile(text, "text", folder), "text", set);
          },
          py::arg("text"), py::arg("folder") = ".", py::arg("set") = py::dict(),
          "Reads a scene from TOML text. Relative files in it are relative to `folder`.")
      .def_static(
          "from_arrays",
          [](const py::object& vertices, const py::object& triangles, const py::object& friction,
             const py::dict& set) {
            return Scene(SceneFile("", "arrays", "."), "arrays", set)
                .with_mesh(read_mesh(vertices, triangles), read_friction(friction));
          },
          py::arg("vertices"), py::arg("triangles"), py::arg("friction") = py::none(),
          py::arg("set") = py::dict(),
          R"(Makes a scene with one object from arrays.

vertices: (n, 3) positions in the world frame [m].
triangles: (m, 3) indices from 0, counter-clockwise seen from outside.
friction: coefficient of Coulomb friction [-], 0 to 2; None: contact.friction.
set: values of keys, for the hand's place, the forces and the motion.)")
      .def(
          "with_arrays",
          [](const Scene& self, const py::object& vertices, const py::object& triangles,
             const py::object& friction) {
            return self.with_mesh(read_mesh(vertices, triangles), read_friction(friction));
          },
          py::arg("vertices"), py::arg("triangles"), py::arg("friction") = py::none(),
          R"(Returns this scene with one object from arrays in place of its objects.

Arguments as from_arrays(). A planned grasp becomes the wrist and motion that the scene states.)")
      .def("__getitem__", &value_of, py::arg("key"))
      .def("__setitem__", &Scene::set, py::arg("key"), py::arg("value"))
      .def("set", &Scene::set_all, py::arg("values"), "Sets several keys, all or none.")
      .def(
          "stated",
          [](const Scene& self) {
            py::dict values;
            for (const auto& [key, value] : self.with_values().values)
              values[py::str(key)] = from_toml(value);
            return values;
          },
          "Returns every value that the file or a set key states, by its key.")
      .def(
          "copy", [](const Scene& self) { return Scene(self); }, "Returns an independent copy.")
      .def("__copy__", [](const Scene& self) { return Scene(self); })
      .def("__deepcopy__", [](const Scene& self, const py::dict&) { return Scene(self); })
      .def(
          "mesh",
          [](const Scene& self) {
            const auto world = std::make_shared<TriangleMesh>();
            {
              const Scene copy = self;
              const py::gil_scoped_release release;
              *world = copy.resolve({}).world;
            }
            return mesh_views(*world, shared_owner<TriangleMesh>(world));
          },
          "Returns the mesh of all objects: vertices (n, 3) in the world frame [m], triangles (m, 3).")
      .def_property_readonly("name", &Scene::origin, "Name, path, \"text\" or \"arrays\".")
      .def_property_readonly(
          "description", [](const Scene& self) { return self.description().description; }, "One line.")
      .def_property_readonly(
          "rate_hz", [](const Scene& self) { return self.description().parameters.rate_hz; },
          "Steps a second [Hz].")
      .def("__repr__", [](const Scene& self) { return "<Scene " + self.origin() + ">"; });

  module.def("scene_keys", &key_rows, "Returns all keys of a scene, by their name.");
  module.def("scenes", &scene_rows, "Returns name and description of each scene of the program.");
  module.def(
      "data_folder", [] { return data_folder().string(); },
      "Returns the folder that holds scenes/ and assets/.");
}

}  // namespace phalanx::python
