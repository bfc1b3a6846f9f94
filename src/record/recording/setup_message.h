// SPDX-License-Identifier: Apache-2.0
// What a station is made of, between the session's types and proto/phalanx/recording.proto.
#pragma once

#include <memory>

#include "phalanx/force/haptic_parameters.h"
#include "phalanx/recording.pb.h"
#include "phalanx/station/session.h"
#include "phalanx/step/haptic_step.h"
#include "station/station_step.h"

namespace phalanx {

/// Writes a station that begins, or a change of the running one. `out` is cleared first.
void write_change(const SessionChange& change, const std::string& device_spec, wire::Setup& out);
void write_change(const SessionChange& change, wire::Change& out);

/// Writes the beginning of a program's own steps. `out` is cleared first.
void write_own_setup(const SessionGeometry& geometry, const std::string& scene, const Overrides& values,
                     wire::Setup& out);

/// Makes a model of the numbers of a recording. Set-up only.
/// @throws std::invalid_argument if numbers are missing, or as HandModel and ObjectModel
[[nodiscard]] std::shared_ptr<const HapticModel> read_model(const wire::Model& model);

/// @returns the parameters of the scene's values. @throws SceneError if this version does not understand them
[[nodiscard]] HapticParameters read_parameters(const wire::Change& change);

/// Makes the step of a recorded station. Set-up only. @throws as the others
[[nodiscard]] std::unique_ptr<StationStep> read_station(const wire::Setup& setup,
                                                        const std::shared_ptr<const HapticModel>& model);

/// @returns how the recorded device's raw values become angles. Set-up only. @throws std::invalid_argument as ChannelMap
[[nodiscard]] ChannelMap read_channel_map(const wire::Setup& setup);

/// @returns the motors that the safety gate of the recorded station compares sensors with. Set-up only.
/// @throws std::invalid_argument if one is of no channel, or has a linkage that check_linkage() refuses
[[nodiscard]] std::vector<MotorWitness> read_witnesses(const wire::Setup& setup);

/// @returns the device of a recorded station
[[nodiscard]] DeviceInfo read_device(const wire::Setup& setup);

}  // namespace phalanx
