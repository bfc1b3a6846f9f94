// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "phalanx/contact/object_model.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/motion.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/scene.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

class ImportCache;

/// Options of resolve(): files that it reads besides those of the objects, and a cache of meshes.
struct ResolveOptions {
  HandDetail hand = HandDetail::kCollision;
  bool device = false;  ///< the simulated exoskeleton and patient
  bool motion = false;
  /// ResolvedScene::planned of an earlier scene: taken where it fits, instead of planning again; null: none
  const Overrides* planned = nullptr;
  ImportCache* imports = nullptr;  ///< for the mesh files of the hand and the objects; null: none
};

/// A scene with the contents of the files that it names. What is made of it opens no file.
struct ResolvedScene {
  SceneDescription description;            ///< with wrist and motion of the planned grasp
  Overrides planned;                       ///< values of the grasp that resolve() has planned; empty: none
  std::optional<GraspType> planned_type;   ///< of the grasp that was searched for here; empty: it was stated
  LoadedHand hand;                         ///< as much of it as ResolveOptions::hand asks for
  bool mirrored = false;                   ///< hand and world are the mirror image of the description
  Pose X_WH;                               ///< pose of the palm, mirrored if the scene is
  TriangleMesh world;                      ///< mesh of all objects, as make_world_mesh() [m]
  std::vector<ObjectFriction> friction;    ///< of the objects in it
  std::optional<Exoskeleton> exoskeleton;  ///< with ResolveOptions::device, as `patient`
  std::optional<PatientParameters> patient;
  std::optional<Motion> motion;  ///< with ResolveOptions::motion
};

/// Reads the files that the scene names and `options` asks for, each once.
/// @throws SceneError or std::invalid_argument as load_hand(), make_world_mesh(), load_device(),
/// load_patient() and build_motion(), or SceneError naming the condition that no grasp of grasp.type fulfils. Set-up
/// only; where it plans a grasp it takes seconds, on all cores.
[[nodiscard]] ResolvedScene resolve(const SceneDescription& description, const ResolveOptions& options);

/// Builds the model of a resolved scene, whose meshes it takes. It opens no file.
/// @throws std::invalid_argument as HandModel and ObjectModel. Set-up only.
[[nodiscard]] HapticModel build_model(ResolvedScene scene);

}  // namespace phalanx
