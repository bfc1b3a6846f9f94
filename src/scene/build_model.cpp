// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/build_model.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/mesh/import.h"
#include "phalanx/mesh/objects.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/motion_file.h"
#include "scene/folder_names.h"

namespace phalanx {

namespace {

/// The mesh of a file, in metres. @param index  of the object in its scene, for messages
TriangleMesh import_object(const ObjectDescription& object, std::size_t index) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(object.file, ignored))
    throw SceneError("object file: " + why_no_file(object.file));
  ImportedMesh imported = import_and_check(
      object.file, {.size = object.size, .unit = object.unit, .triangles = object.decimate_to});
  const MeshFinding units = imported.report.finding(FindingKind::kUnits);
  if (units.found == 0) return std::move(imported.mesh);
  const double scale = imported.report.scale;
  const std::string_view unit = probable_unit(units.size, scale);
  const std::string typed =
      unit.empty()        ? fmt::format("--set objects.{}.size_mm=100", index)
      : object.size > 0.0 ? fmt::format("--set objects.{0}.unit={1} --set objects.{0}.size_mm=0", index, unit)
                          : fmt::format("--set objects.{}.unit={}", index, unit);
  throw SceneError(
      fmt::format("{}: {}; type {}", object.file.string(), unit_advice(units.size, scale), typed));
}

TriangleMesh make_mesh_of(const ObjectDescription& object, std::size_t index) {
  return object.kind == "file" ? import_object(object, index) : make_object_mesh(object);
}

}  // namespace

TriangleMesh make_object_mesh(const ObjectDescription& object) {
  if (object.kind == "sphere") return make_sphere(object.diameter, object.triangles);
  if (object.kind == "box") return make_box(object.extent, object.triangles);
  if (object.kind == "cylinder") return make_cylinder(object.diameter, object.length, object.triangles);
  if (object.kind == "torus") return make_torus(object.ring_diameter, object.tube_diameter, object.triangles);
  if (object.kind == "mug") return make_mug(object.diameter, object.length, object.triangles);
  if (object.kind == "teapot") return make_teapot(object.size, object.triangles);
  if (object.kind == "bottle") return make_bottle(object.diameter, object.length, object.triangles);
  if (object.kind == "key")
    return make_key(object.length, object.breadth, object.thickness, object.triangles);
  if (object.kind == "pen") return make_pen(object.diameter, object.length, object.triangles);
  if (object.kind == "cup") return make_cup(object.diameter, object.length, object.triangles);
  if (object.kind == "therapy_ball") return make_therapy_ball(object.diameter, object.bump, object.triangles);
  if (object.kind == "putty_bar") return make_putty_bar(object.extent, object.triangles);
  if (object.kind == "peg")
    return make_peg(object.diameter, object.length, object.head_diameter, object.triangles);
  if (object.kind == "jar")
    return make_jar(object.diameter, object.length, object.lid_diameter, object.triangles);
  if (object.kind == "tap_handle") return make_tap_handle(object.diameter, object.length, object.triangles);
  if (object.kind == "file") return import_object(object, 0);
  throw SceneError(
      fmt::format("objects[].kind = \"{}\": nobody knows this kind; see `phalanx scene keys`", object.kind));
}

namespace {

/// Scenes with a profile are laid out for a right hand.
bool is_mirrored(const SceneDescription& scene) {
  if (scene.hand.profile.empty()) return scene.mirror;
  return load_hand_numbers(scene.hand).handedness == Handedness::kLeft;
}

/// M X M with M = diag(-1, 1, 1): only signs change.
Pose mirrored(Pose X) {
  X.p.x() = -X.p.x();
  for (const auto& [row, column] : {std::pair{0, 1}, {0, 2}, {1, 0}, {2, 0}})
    X.R(row, column) = -X.R(row, column);
  return X;
}

}  // namespace

namespace {

/// Triangles of all objects together, as they become known.
class TriangleCount {
 public:
  void add(std::size_t index, std::size_t triangles) {
    count_ += triangles;
    if (count_ <= kMostSceneTriangles) return;
    throw SceneError(fmt::format(
        "objects[{}]: with its {} triangles the scene's objects have {}, and may have {} together; make it "
        "coarser (triangles, or decimate_to for a file) or leave objects out",
        index, triangles, count_, kMostSceneTriangles));
  }

 private:
  std::size_t count_ = 0;
};

}  // namespace

TriangleMesh make_world_mesh(const SceneDescription& scene) {
  TriangleCount count;
  // What is made here says how many it is asked for, and is refused before it is made.
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].kind != "file") count.add(i, static_cast<std::size_t>(scene.objects[i].triangles));
  }
  TriangleMesh world;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const TriangleMesh mesh = make_mesh_of(scene.objects[i], i);
    if (scene.objects[i].kind == "file") count.add(i, mesh.triangles.size());
    append(world, mesh, scene.objects[i].pose);
  }
  if (is_mirrored(scene)) mirror(world);
  return world;
}

HapticModel build_model(const SceneDescription& scene) {
  const HandNumbers hand = load_hand_numbers(scene.hand);
  TriangleMesh world = make_world_mesh(scene);
  const Pose pose = is_mirrored(scene) ? mirrored(scene.hand.pose) : scene.hand.pose;
  HapticModel model(HandModel(hand.parameters, hand.handedness, pose, load_collision_meshes(scene.hand)),
                    world.triangles.empty() ? ObjectModel() : ObjectModel(std::move(world)));
  model.contact = scene.contact;
  model.force = scene.force;
  model.smoothing = scene.smoothing;
  model.stabiliser = scene.stabiliser;
  model.oscillation = scene.oscillation;
  model.limits = scene.limits;
  model.rate_hz = scene.rate_hz;
  return model;
}

Motion build_motion(const SceneDescription& scene) {
  const HandParameters hand = load_hand_numbers(scene.hand).parameters;
  const MotionDescription& motion = scene.motion;
  if (motion.file.empty()) return make_motion(motion.script, hand);
  std::optional<SensorMapping> mapping;
  if (!motion.mapping.empty()) mapping = load_mapping_file(motion.mapping);
  return led_in(load_motion(motion.file, mapping, motion.trial, hand.open_angle), hand.open_angle,
                motion.lead_in_s);
}

double simulation_seconds(const SceneDescription& scene, const Motion& motion) {
  return scene.seconds > 0.0 ? scene.seconds : motion.duration();
}

}  // namespace phalanx
