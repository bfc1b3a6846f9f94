// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/station_model.h"

#include <utility>

#include "phalanx/simulation/press_plan.h"
#include "phalanx/station/resolved_station.h"
#include "phalanx/station/station.h"

namespace phalanx {

SimulatedDeviceSettings simulated_settings(const ResolvedScene& scene, const HapticModel& model) {
  SimulatedDeviceSettings settings;
  const HapticParameters& parameters = scene.description.parameters;
  settings.exoskeleton = scene.exoskeleton.value();
  settings.patient = scene.patient.value();
  settings.plan = plan_press(model, parameters, scene.motion.value(), settings.exoskeleton, settings.patient);
  settings.hand = model.hand.parameters();
  settings.wall = parameters.force.stiffness;
  settings.host_rate_hz = parameters.rate_hz;
  settings.seed = scene.description.seed;
  settings.torque_limit = parameters.limits.joint_torque;
  settings.torque_rate = parameters.limits.torque_rate;
  return settings;
}

StationModel make_station_model(const SceneDescription& scene, const std::string& clinician) {
  return make_station_model(resolve(scene, {}), clinician);
}

StationModel make_station_model(const ResolvedScene& scene, const std::string& clinician) {
  const SceneDescription& description = scene.description;
  StationModel out;
  check_station_rate(description.parameters.rate_hz);
  out.parameters = description.parameters;
  out.safety = make_safety_settings(description.parameters.limits, clinician);
  if (!description.hand.profile.empty()) out.safety.patient = "hand.profile = " + description.hand.profile;
  out.model = std::make_shared<const HapticModel>(build_model(scene));
  return out;
}

}  // namespace phalanx
