// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_trial.h"

#include <utility>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"

namespace phalanx {

std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene) {
  return make_trial_setup(resolve(scene, {.device = true, .motion = true}));
}

std::shared_ptr<const TrialSetup> make_trial_setup(ResolvedScene scene) {
  const Motion motion = scene.motion.value();
  const Exoskeleton exoskeleton = scene.exoskeleton.value();
  const PatientParameters patient = scene.patient.value();
  const HapticParameters parameters = scene.description.parameters;
  return std::make_shared<TrialSetup>(
      make_trial_setup(build_model(std::move(scene)), parameters, exoskeleton, patient, motion));
}

}  // namespace phalanx
