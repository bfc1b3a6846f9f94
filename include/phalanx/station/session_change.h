// SPDX-License-Identifier: Apache-2.0
// What a recording needs besides the steps: the stations that a session began, and their changes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/device.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/safety_settings.h"

namespace phalanx {

struct SessionGeometry;

/// Source of the hand's motion.
enum class HandSource { kDevice, kPatient, kSliders };

/// What a station is made of, besides scene and geometry.
struct StationSetup {
  HandSource source = HandSource::kPatient;
  DeviceInfo device;
  std::vector<DeviceChannel> channels;  ///< with the calibration
  JointFollowers followers;
  std::vector<MotorWitness> witnesses;
  std::string calibration;  ///< its file; empty: none
  std::string range;        ///< file of the patient's own range of motion; empty: none
  std::string clinician;    ///< SessionSettings::clinician
  std::string patient;      ///< SafetySettings::patient
};

/// A station that begins, or other parameters or another model for the running one.
struct SessionChange {
  std::uint64_t station = 0;   ///< StepRecord::station of the steps that it is for
  std::uint64_t number = 0;    ///< StepInput::changed or exchanged; 0: a station begins
  std::uint64_t model_of = 0;  ///< number of the change whose geometry it is with; 0: the station's first
  /// Of a station that begins: StationView::station and tick at the end of the one before it; 0: there was none.
  std::uint64_t last_station = 0;
  std::uint64_t last_tick = 0;
  std::string scene;
  Overrides values;                                 ///< SessionInfo::values
  std::shared_ptr<const SessionGeometry> geometry;  ///< null: that of `model_of`
  std::optional<StationSetup> setup;                ///< of a station that begins
  std::uint64_t recording = 0;                      ///< StationOrder::recording of a station that begins
};

}  // namespace phalanx
