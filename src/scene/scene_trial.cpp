// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_trial.h"

#include <utility>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"

namespace phalanx {

std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene) {
  ResolvedScene resolved = resolve(scene, {.device = true, .motion = true});
  const Motion motion = resolved.motion.value();
  const Exoskeleton exoskeleton = resolved.exoskeleton.value();
  const PatientParameters patient = resolved.patient.value();
  return std::make_shared<TrialSetup>(
      make_trial_setup(build_model(std::move(resolved)), scene.parameters, exoskeleton, patient, motion));
}

}  // namespace phalanx
