// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/build_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/motion_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/scene/scene_grasp.h"
#include "scene/object_kinds.h"

namespace phalanx {

namespace {

/// @returns M X M with M = diag(-1, 1, 1): only signs change.
Pose mirrored(Pose X) {
  X.p.x() = -X.p.x();
  for (const auto& [row, column] : {std::pair{0, 1}, {0, 2}, {1, 0}, {2, 0}})
    X.R(row, column) = -X.R(row, column);
  return X;
}

/// Sum of the triangles of all objects; it grows as they become known.
class TriangleCount {
 public:
  void add(std::size_t index, std::size_t triangles) {
    count_ += triangles;
    if (count_ <= kMostSceneTriangles) return;
    throw SceneError(fmt::format(
        "objects[{}]: with its {} triangles the scene's objects have {} together, and at most {} "
        "are allowed; make it coarser (triangles, or decimate_to for a file) or leave objects out",
        index, triangles, count_, kMostSceneTriangles));
  }

 private:
  std::size_t count_ = 0;
};

/// @returns true if the world is mirrored. Scenes with a profile are laid out for a right hand.
bool is_mirrored(const SceneDescription& scene, Handedness of_hand) {
  return scene.hand.profile.empty() ? scene.mirror : of_hand == Handedness::kLeft;
}

/// @param friction  receives the friction of each object; may be null
TriangleMesh world_mesh(const SceneDescription& scene, bool mirrored, ImportCache* imports,
                        std::vector<ObjectFriction>* friction) {
  TriangleCount count;
  // The number of triangles of generated objects is known, and checked before they are made.
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].kind != "file") count.add(i, static_cast<std::size_t>(scene.objects[i].triangles));
  }
  TriangleMesh world;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const TriangleMesh mesh = make_object(scene.objects[i], {.index = i, .imports = imports});
    if (scene.objects[i].kind == "file") count.add(i, mesh.triangles.size());
    if (friction != nullptr)
      friction->push_back({static_cast<int>(world.triangles.size()), scene.objects[i].friction});
    append(world, mesh, scene.objects[i].pose);
  }
  if (mirrored) mirror(world);
  return world;
}

/// Plans the scene's grasp, of its type or, if it allows them, of the first other type of which there is one.
PlannedGrasp find_scene_grasp(ResolvedScene& scene) {
  const GraspDescription& grasp = scene.description.grasp;
  const GraspType stated = grasp.type.value();
  const auto find = [&](GraspType type) {
    scene.planned_type = type;
    return search_grasp(scene, type, {});
  };
  GraspSearch search = find(stated);
  if (search.grasp) return *std::move(search.grasp);
  std::string problem = no_grasp_text(search, stated, scene.hand.parameters.name);
  std::string others;
  for (std::size_t i = 0; grasp.other_types && i < grasp_type_names().size(); ++i) {
    const auto type = static_cast<GraspType>(i);
    if (type == stated) continue;
    search = find(type);
    if (search.grasp) return *std::move(search.grasp);
    others += fmt::format("{}{}: none fulfils \"{}\"", others.empty() ? ". Other types: " : "; ",
                          grasp_rule(type).name, grasp_condition_text(search.obstacle()));
  }
  if (!others.empty())
    others +=
        "; choose another size, other directions, or grasp.type = \"none\" with a wrist and motion of your "
        "own";
  throw SceneError(fmt::format("{}: {}{}", grasp.stated_at, problem, others));
}

/// Plans the scene's grasp and stores it in the description, unless that states it.
void plan_scene_grasp(ResolvedScene& scene, const Overrides* planned) {
  SceneDescription& description = scene.description;
  const GraspDescription& grasp = description.grasp;
  const std::string checksum = grasp_checksum(grasp, scene.hand, scene.world, scene.mirrored);
  if (checksum == grasp.planned_for) return;
  if (scene.world.triangles.empty())
    throw SceneError(fmt::format("{}: the scene has no object to hold; add one to objects, or state \"none\"",
                                 grasp.stated_at));
  const std::pair<std::string, std::string> fits("grasp.planned_for", toml_string(checksum));
  if (planned != nullptr && std::find(planned->begin(), planned->end(), fits) != planned->end()) {
    scene.planned = *planned;
  } else {
    scene.planned = grasp_values(find_scene_grasp(scene), scene.mirrored, checksum);
  }
  // What a scene would read that states these values, to the last bit.
  const SceneDescription stated = SceneFile("", "planned grasp", {}).scene(scene.planned);
  description.hand.pose = stated.hand.pose;
  description.motion.script.posture = stated.motion.script.posture;
  description.grasp.planned_for = checksum;
}

constexpr double kMostShare = 2.0;  // of its way that a copied digit goes

/// Lets the digits that the device does not have go along their way in the planned grasp, as the digits that they copy.
void copy_along_grasp(const SceneDescription& description, const HandParameters& hand,
                      Exoskeleton& exoskeleton) {
  const ScriptedMotion& script = description.motion.script;
  const auto way_of = [&](int digit) {
    DigitAngles way{};
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(digit, i));
      const double part = script.closure * script.digit_closure[idx(digit)];
      if (const auto& angle = script.posture[j])
        way[idx(i)] = std::clamp(hand.open_angle[j] + part * (*angle - hand.open_angle[j]), hand.min_angle[j],
                                 hand.max_angle[j]) -
                      hand.open_angle[j];
    }
    return way;
  };
  for (int digit = 0; digit < kDigits; ++digit) {
    DigitCopy& copy = exoskeleton.controller.copy[idx(digit)];
    if (copy.of < 0) continue;
    copy.way = way_of(digit);
    copy.way_of = way_of(copy.of);
    copy.least_share = -kMostShare;
    copy.most_share = kMostShare;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(digit, i));
      const double way = copy.way[idx(i)];
      if (way == 0.0) continue;
      const double to_min = (hand.min_angle[j] - hand.open_angle[j]) / way;
      const double to_max = (hand.max_angle[j] - hand.open_angle[j]) / way;
      copy.least_share = std::max(copy.least_share, std::min(to_min, to_max));
      copy.most_share = std::min(copy.most_share, std::max(to_min, to_max));
    }
  }
}

Motion motion_of(const MotionDescription& motion, const HandParameters& hand) {
  if (motion.file.empty()) return make_motion(motion.script, hand);
  std::optional<SensorMapping> mapping;
  if (!motion.mapping.empty()) mapping = load_mapping_file(motion.mapping);
  return led_in(load_motion(motion.file, mapping, motion.trial, hand.open_angle), hand.open_angle,
                motion.lead_in_s);
}

}  // namespace

TriangleMesh make_object_mesh(const ObjectDescription& object) { return make_object(object, {}); }

TriangleMesh make_world_mesh(const SceneDescription& scene) {
  const bool profile = !scene.hand.profile.empty();
  const Handedness of_hand = profile ? load_hand_numbers(scene.hand).handedness : scene.hand.handedness;
  return world_mesh(scene, is_mirrored(scene, of_hand), nullptr, nullptr);
}

ResolvedScene resolve(const SceneDescription& description, const ResolveOptions& options) {
  ResolvedScene scene;
  scene.description = description;
  if (options.device) {
    scene.exoskeleton = load_device(description);
    scene.patient = load_patient(description);
  }
  scene.hand = load_hand(description.hand, options.hand, options.imports);
  scene.mirrored = is_mirrored(description, scene.hand.handedness);
  scene.world = world_mesh(description, scene.mirrored, options.imports, &scene.friction);
  if (description.grasp.type) {
    plan_scene_grasp(scene, options.planned);
    if (scene.exoskeleton) copy_along_grasp(scene.description, scene.hand.parameters, *scene.exoskeleton);
  }
  const Pose& X_WH = scene.description.hand.pose;
  scene.X_WH = scene.mirrored ? mirrored(X_WH) : X_WH;
  if (options.motion) scene.motion = motion_of(scene.description.motion, scene.hand.parameters);
  return scene;
}

HapticModel build_model(const SceneDescription& scene) { return build_model(resolve(scene, {})); }

HapticModel build_model(ResolvedScene scene) {
  const bool empty = scene.world.triangles.empty();
  return {HandModel(std::move(scene.hand.parameters), scene.hand.handedness, scene.X_WH,
                    std::move(scene.hand.meshes.collision)),
          empty ? ObjectModel()
                : ObjectModel(std::move(scene.world), ObjectModel::kDefaultCreaseAngle,
                              std::move(scene.friction))};
}

Motion build_motion(const SceneDescription& scene) {
  if (scene.grasp.type && scene.motion.file.empty()) return *resolve(scene, {.motion = true}).motion;
  return motion_of(scene.motion, load_hand_numbers(scene.hand).parameters);
}

double simulation_seconds(const SceneDescription& scene, const Motion& motion) {
  return scene.seconds > 0.0 ? scene.seconds : motion.duration();
}

}  // namespace phalanx
