// SPDX-License-Identifier: Apache-2.0
// From a scene and a device to everything that a Station needs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "phalanx/device/simulated_device.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/station.h"

namespace phalanx {

/// The simulated exoskeleton and patient of a scene, who squeezes again and again.
/// @throws SceneError or std::invalid_argument: device file, patient file, or a motion that meets nothing.
[[nodiscard]] SimulatedDeviceSettings simulated_settings(const SceneDescription& scene,
                                                         const HapticModel& model);

/// The scene's model, its parameters checked for a station.
/// @param clinician  see make_safety_settings()
/// @throws SceneError or std::invalid_argument: the scene, or a limit that a station does not allow.
struct StationModel {
  std::unique_ptr<HapticModel> model;
  SafetySettings safety;
};
[[nodiscard]] StationModel make_station_model(const SceneDescription& scene, const std::string& clinician);

/// What of a scene may change in contact.
[[nodiscard]] BlendedParameters blended_of(const SceneDescription& scene) noexcept;

/// Channels of an open device with the joints that follow them in the scene's device file.
/// @param channels  calibrated ones, or the device's own
[[nodiscard]] ChannelMap make_channel_map(const SceneDescription& scene, std::vector<DeviceChannel> channels,
                                          const HandParameters& hand);

/// What the device's motors say of its joints.
[[nodiscard]] std::vector<MotorWitness> make_witnesses(const SceneDescription& scene,
                                                       const std::vector<DeviceChannel>& channels,
                                                       const SafetySettings& safety);

/// What a change of a scene's key needs in a running station.
enum class ChangeKind {
  kInContact,     ///< goes over smoothly: changes_in_contact()
  kAtZeroTorque,  ///< another model: object, law, stabiliser
  kNewStation,    ///< limits (the controller is told them when its session begins), hand, rate, device,
                  ///< patient, motion
};
[[nodiscard]] ChangeKind change_kind(const std::string& key);

}  // namespace phalanx
