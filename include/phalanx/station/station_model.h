// SPDX-License-Identifier: Apache-2.0
// From a scene to the model, the settings and the simulated device of a Station.
#pragma once

#include <memory>
#include <string>

#include "phalanx/scene/resolved_scene.h"
#include "phalanx/simulation/simulated_device.h"
#include "phalanx/station/station.h"

namespace phalanx {

/// Makes the simulated exoskeleton and patient of a scene, who squeezes again and again.
/// @param scene  resolved with its device and its motion (ResolveOptions)
/// @throws std::invalid_argument: the motion meets nothing
[[nodiscard]] SimulatedDeviceSettings simulated_settings(const ResolvedScene& scene,
                                                         const HapticModel& model);

/// A scene's model and parameters, checked for a station.
struct StationModel {
  std::shared_ptr<const HapticModel> model;
  HapticParameters parameters;
  SafetySettings safety;
};

/// Makes the model, the parameters and the safety settings of a scene. Set-up only.
/// @param clinician  see make_safety_settings()
/// @throws SceneError or std::invalid_argument: the scene, or a limit that a station does not allow.
[[nodiscard]] StationModel make_station_model(const SceneDescription& scene, const std::string& clinician);
/// Makes the same of a resolved scene, without opening a file.
[[nodiscard]] StationModel make_station_model(const ResolvedScene& scene, const std::string& clinician);

}  // namespace phalanx
