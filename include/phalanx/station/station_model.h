// SPDX-License-Identifier: Apache-2.0
// From a scene to the model of a Station.
#pragma once

#include <memory>
#include <string>

#include "phalanx/force/haptic_parameters.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// A scene's model and parameters, checked for a station.
struct StationModel {
  std::shared_ptr<const HapticModel> model;
  HapticParameters parameters;
  SafetySettings safety;
};

/// Builds the model of a scene. Set-up only.
/// @param clinician  see make_safety_settings()
/// @throws SceneError or std::invalid_argument: the scene, or a limit that a station does not allow.
[[nodiscard]] StationModel make_station_model(const SceneDescription& scene, const std::string& clinician);

}  // namespace phalanx
