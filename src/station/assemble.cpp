// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/assemble.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "phalanx/device/press_plan.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/device_file.h"
#include "phalanx/scene/patient_file.h"

namespace phalanx {

SimulatedDeviceSettings simulated_settings(const SceneDescription& scene, const HapticModel& model) {
  SimulatedDeviceSettings settings;
  settings.exoskeleton = load_device(scene);
  settings.patient = load_patient(scene);
  settings.plan = plan_press(model, build_motion(scene), settings.exoskeleton, settings.patient);
  settings.hand = model.hand.parameters();
  settings.wall = model.force.stiffness;
  settings.host_rate_hz = model.rate_hz;
  settings.seed = scene.seed;
  settings.torque_limit = scene.limits.joint_torque;
  settings.torque_rate = scene.limits.torque_rate;
  return settings;
}

StationModel make_station_model(const SceneDescription& scene, const std::string& clinician) {
  StationModel out;
  check_station_rate(scene.rate_hz);
  out.safety = make_safety_settings(scene.limits, clinician);
  out.model = std::make_unique<HapticModel>(build_model(scene));
  return out;
}

BlendedParameters blended_of(const SceneDescription& scene) noexcept {
  return {.stiffness = scene.force.stiffness,
          .damping = scene.force.damping,
          .smoothing = scene.smoothing.enabled,
          .min_rate = scene.smoothing.min_rate,
          .max_rate = scene.smoothing.max_rate};
}

ChannelMap make_channel_map(const SceneDescription& scene, std::vector<DeviceChannel> channels,
                            const HandParameters& hand) {
  return {std::move(channels), followers_of(load_device(scene)), hand};
}

std::vector<MotorWitness> make_witnesses(const SceneDescription& scene,
                                         const std::vector<DeviceChannel>& channels,
                                         const SafetySettings& safety) {
  return motor_witnesses(load_device(scene), channels, safety.joint_torque);
}

ChangeKind change_kind(const std::string& key) {
  if (changes_in_contact(key)) return ChangeKind::kInContact;
  constexpr std::array<std::string_view, 10> kFixed = {"limits", "rate_hz", "seconds", "seed",    "mirror",
                                                       "hand",   "motion",  "device",  "patient", "profile"};
  const std::string first = key.substr(0, key.find('.'));
  return std::find(kFixed.begin(), kFixed.end(), first) != kFixed.end() ? ChangeKind::kNewStation
                                                                        : ChangeKind::kAtZeroTorque;
}

}  // namespace phalanx
