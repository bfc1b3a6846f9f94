// SPDX-License-Identifier: Apache-2.0
// From a resolved scene to the model, the settings and the simulated device of a Station. Opens no file.
#pragma once

#include <string>

#include "phalanx/scene/resolved_scene.h"
#include "phalanx/simulation/simulated_device.h"
#include "phalanx/station/station_model.h"

namespace phalanx {

/// Makes the simulated exoskeleton and patient of a scene, who squeezes again and again. Set-up only.
/// @param scene  resolved with its device and its motion (ResolveOptions)
/// @throws std::invalid_argument: the motion meets nothing
[[nodiscard]] SimulatedDeviceSettings simulated_settings(const ResolvedScene& scene,
                                                         const HapticModel& model);

/// Makes the station's model of a resolved scene. Set-up only.
/// @throws as make_station_model() of a SceneDescription
[[nodiscard]] StationModel make_station_model(const ResolvedScene& scene, const std::string& clinician);

}  // namespace phalanx
