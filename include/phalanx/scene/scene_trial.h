// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "phalanx/scene/scene.h"
#include "phalanx/simulation/trial_setup.h"

namespace phalanx {

struct ResolvedScene;

/// Makes the set-up of a trial of a scene, with the device and the patient that it names.
/// @throws SceneError or std::invalid_argument if scene, device or patient cannot be loaded, or no digit
/// meets the object. Set-up only.
[[nodiscard]] std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene);

/// Makes the set-up of a scene that was resolved with its device and its motion. It opens no file.
/// @throws std::invalid_argument as above. Set-up only.
[[nodiscard]] std::shared_ptr<const TrialSetup> make_trial_setup(ResolvedScene scene);

}  // namespace phalanx
