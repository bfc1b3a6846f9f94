// SPDX-License-Identifier: Apache-2.0
// What a station says of itself to whoever looks: plain values, copied.
#pragma once

#include <cstdint>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/station/deadline_statistics.h"
#include "phalanx/station/safety.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Of the newest step.
struct StationView {
  double time = 0.0;  ///< the host's clock [s]
  Snapshot snapshot;
  double stiffness = 0.0;  ///< of the law at this step [N/m]
  double duration = 0.0;   ///< of the step, until the command was handed to the device [s]
  JointArray sent{};       ///< torques that left, after Safety [Nm]
  SafetyState state = SafetyState::kWaiting;
  FaultEvent fault;                  ///< that it is in; its fault is kNone: in none
  double factor = 0.0;               ///< of the ramps, on the step's torques, 0 .. 1 [-]
  bool at_rest = true;               ///< what leaves is zero for every joint
  bool degraded = false;             ///< a step ended too late in the last second
  bool ending = false;               ///< shut_down() has been asked for
  std::uint64_t resets_refused = 0;  ///< because the cause was still there
  bool changing = false;             ///< a change is on its way
  DeviceState device = DeviceState::kConnecting;
  bool estop = false;
  bool oscillates = false;  ///< Safety::oscillates(): the force fades, or waits until it is quiet
  LinkStatistics link;
  std::uint64_t records_lost = 0;  ///< StepRecords that nobody fetched in time
};

/// One step, for logs and fault reports.
struct StepRecord {
  std::uint64_t tick = 0;
  double time = 0.0;                  ///< the host's clock when the step began [s]
  double lateness = 0.0;              ///< of waking up [s]
  double duration = 0.0;              ///< until the command was handed to the device [s]
  bool overrun = false;               ///< the step before ended after this one was due
  std::uint32_t samples = 0;          ///< new ones at this step
  std::uint32_t sample_sequence = 0;  ///< of the newest
  std::uint64_t sample_time_us = 0;   ///< of it, the device's clock
  SafetyState state = SafetyState::kWaiting;
  Fault fault = Fault::kNone;
  double factor = 0.0;
  Status status = Status::kOk;
  double stiffness = 0.0;  ///< of the law at this step [N/m]
  JointArray angle{};      ///< HCP [rad]
  JointArray torque{};     ///< sent [Nm]
  DigitArray force{};      ///< sum of the magnitudes on each digit [N]
};

/// Everything about one fault: the last 2 s before the torque had come to rest.
struct FaultReport {
  FaultEvent event;
  DeviceInfo device;
  std::vector<DeviceSample> samples;
  std::vector<StepRecord> steps;
  LinkStatistics link;
};

}  // namespace phalanx
