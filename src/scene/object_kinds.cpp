// SPDX-License-Identifier: Apache-2.0
#include "scene/object_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/mesh/import_cache.h"
#include "phalanx/mesh/objects.h"
#include "phalanx/mesh/primitives.h"
#include "scene/text_file.h"

namespace phalanx {
namespace {

/// Imports the mesh of a file, in metres.
TriangleMesh import_object(const ObjectDescription& object, const ObjectInputs& inputs) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(object.file, ignored))
    throw SceneError("object file: " + why_no_file(object.file));
  ImportedMesh imported = import_and_check(
      object.file, {.size = object.size, .unit = object.unit, .triangles = object.decimate_to},
      inputs.imports);
  const MeshFinding units = imported.report.finding(FindingKind::kUnits);
  if (units.found == 0) return std::move(imported.mesh);
  const double scale = imported.report.scale;
  const std::string_view unit = probable_unit(units.size, scale);
  const std::size_t index = inputs.index;
  const std::string typed =
      unit.empty()        ? fmt::format("--set objects.{}.size_mm=100", index)
      : object.size > 0.0 ? fmt::format("--set objects.{0}.unit={1} --set objects.{0}.size_mm=0", index, unit)
                          : fmt::format("--set objects.{}.unit={}", index, unit);
  throw SceneError(
      fmt::format("{}: {}; type {}", object.file.string(), unit_advice(units.size, scale), typed));
}

using O = const ObjectDescription&;
using I = const ObjectInputs&;

std::vector<ObjectKind> make_kinds() {
  return {
      {"teapot", {"size_mm", "triangles"}, [](O o, I) { return make_teapot(o.size, o.triangles); }},
      {"sphere", {"diameter_mm", "triangles"}, [](O o, I) { return make_sphere(o.diameter, o.triangles); }},
      {"box", {"extent_mm", "triangles"}, [](O o, I) { return make_box(o.extent, o.triangles); }},
      {"cylinder",
       {"diameter_mm", "length_mm", "triangles"},
       [](O o, I) { return make_cylinder(o.diameter, o.length, o.triangles); }},
      {"torus",
       {"ring_diameter_mm", "tube_diameter_mm", "triangles"},
       [](O o, I) { return make_torus(o.ring_diameter, o.tube_diameter, o.triangles); }},
      {"mug",
       {"diameter_mm", "length_mm", "triangles"},
       [](O o, I) { return make_mug(o.diameter, o.length, o.triangles); }},
      {"bottle",
       {{"diameter_mm", 65.0}, {"length_mm", 205.0}, "triangles"},
       [](O o, I) { return make_bottle(o.diameter, o.length, o.triangles); }},
      {"key",
       {{"length_mm", 57.0}, "breadth_mm", "thickness_mm", "triangles"},
       [](O o, I) { return make_key(o.length, o.breadth, o.thickness, o.triangles); }},
      {"pen",
       {{"diameter_mm", 10.0}, {"length_mm", 140.0}, "triangles"},
       [](O o, I) { return make_pen(o.diameter, o.length, o.triangles); }},
      {"cup",
       {{"diameter_mm", 75.0}, {"length_mm", 90.0}, "triangles"},
       [](O o, I) { return make_cup(o.diameter, o.length, o.triangles); }},
      {"therapy_ball",
       {{"diameter_mm", 70.0}, "bump_mm", "triangles"},
       [](O o, I) { return make_therapy_ball(o.diameter, o.bump, o.triangles); }},
      {"putty_bar",
       {{"extent_mm", Vec3(100, 35, 30)}, "triangles"},
       [](O o, I) { return make_putty_bar(o.extent, o.triangles); }},
      {"peg",
       {{"diameter_mm", 9.0}, {"length_mm", 32.0}, "head_diameter_mm", "triangles"},
       [](O o, I) { return make_peg(o.diameter, o.length, o.head_diameter, o.triangles); }},
      {"jar",
       {{"diameter_mm", 80.0}, {"length_mm", 110.0}, "lid_diameter_mm", "triangles"},
       [](O o, I) { return make_jar(o.diameter, o.length, o.lid_diameter, o.triangles); }},
      {"tap_handle",
       {"diameter_mm", {"length_mm", 50.0}, "triangles"},
       [](O o, I) { return make_tap_handle(o.diameter, o.length, o.triangles); }},
      {"file", {"file", "size_mm", "unit", "decimate_to"}, import_object},
  };
}

}  // namespace

const std::vector<ObjectKind>& object_kinds() {
  static const std::vector<ObjectKind> kKinds = make_kinds();
  return kKinds;
}

std::vector<std::string> object_kind_names() {
  std::vector<std::string> names;
  for (const ObjectKind& kind : object_kinds()) names.push_back(kind.name);
  return names;
}

TriangleMesh make_object(const ObjectDescription& object, const ObjectInputs& inputs) {
  const auto& kinds = object_kinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const ObjectKind& k) { return k.name == object.kind; });
  if (kind == kinds.end()) {
    throw SceneError(
        fmt::format("objects[].kind = \"{}\": is no kind of object; see `phalanx scene keys`", object.kind));
  }
  return kind->make(object, inputs);
}

}  // namespace phalanx
