// SPDX-License-Identifier: Apache-2.0
// The state of a station that other threads read: plain values, copied.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/station/deadline_statistics.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// State after the newest step.
struct StationView {
  double time = 0.0;          ///< the host's clock [s]
  std::uint64_t tick = 0;     ///< number of the step, as in StepRecord::command
  std::uint64_t station = 0;  ///< StationOptions::number
  Snapshot snapshot;
  double stiffness = 0.0;  ///< stiffness of the force law at this step [N/m]
  double duration = 0.0;   ///< from the start of the step until the command was handed to the device [s]
  JointArray sent{};       ///< torques after the safety gate [Nm]
  SafetyState state = SafetyState::kWaiting;
  /// Number of this period of SafetyState::kRunning, unique in the process; 0 in other states. A stop, a
  /// fault or an exchange ends it.
  std::uint64_t running = 0;
  FaultEvent fault;                  ///< the present fault; kNone: no fault
  double factor = 0.0;               ///< factor of the ramps on the step's torques, 0 .. 1 [-]
  bool at_rest = true;               ///< the torque sent is zero for every joint
  bool degraded = false;             ///< a step ended too late in the last second
  bool ending = false;               ///< shut_down() was called
  std::uint64_t resets_refused = 0;  ///< resets refused because the cause was still there
  bool changing = false;             ///< a change is on its way
  DeviceState device = DeviceState::kConnecting;
  bool estop = false;
  bool oscillates = false;  ///< the force oscillates: it fades, or waits until it is quiet
  LinkStatistics link;
  std::uint64_t records_lost = 0;  ///< StepRecords that were not fetched in time
};

/// Requests of other threads that a step serves, as bits.
struct StepRequest {
  enum : unsigned {
    kStop = 1,
    kResume = 2,
    kReset = 4,
    kEnd = 8,       ///< ramps to zero for good
    kWithdraw = 16  ///< ends the present period of SafetyState::kRunning
  };
};

/// All that a step depends on, besides its samples, the station's set-up and the steps before. With these a
/// replay makes the step again, to the last bit.
struct StepInput {
  double time = 0.0;                            ///< the host's clock at the start of the step [s]
  bool late = false;                            ///< the step before ended after this one was due
  unsigned requests = 0;                        ///< bits of StepRequest
  Fault connection_at_requests = Fault::kNone;  ///< Device::connection_fault() when they were served
  unsigned openings = 0;                        ///< digits whose opening was confirmed: bit d for digit d
  bool waits = false;                           ///< another rendering waited for the torque to come to rest
  std::uint64_t exchanged =
      0;                      ///< number of the change whose rendering is in force from this step on; 0: none
  std::uint64_t changed = 0;  ///< number of the change whose parameters it begins to go over to; 0: none
  Fault connection = Fault::kNone;  ///< Device::connection_fault() after the samples had been fetched
};

/// One step, for recordings, logs and fault reports.
struct StepRecord {
  std::uint64_t station = 0;  ///< StationOptions::number
  StepInput input;
  DeviceCommand command;              ///< that left for the device; it is sent once a sample has come
  std::uint64_t hash = 0;             ///< of angles, forces and command (StationStep::hash())
  double lateness = 0.0;              ///< lateness of the waking-up [s]
  double duration = 0.0;              ///< from the start until the command was handed to the device [s]
  std::uint32_t samples = 0;          ///< number of new samples at this step
  std::uint32_t sample_sequence = 0;  ///< sequence number of the newest sample
  std::uint64_t sample_time_us = 0;   ///< time of the newest sample, the device's clock [us]
  SafetyState state = SafetyState::kWaiting;
  Fault fault = Fault::kNone;
  double factor = 0.0;
  Status status = Status::kOk;
  double stiffness = 0.0;  ///< stiffness of the force law at this step [N/m]
  JointArray angle{};      ///< HCP [rad]
  DigitArray force{};      ///< sum of the magnitudes on each digit [N]

  // What exercises observe besides (StationStep::describe()). It enters neither the hash nor a recording: a
  // replay makes it.
  AngleOrigins angle_origin{};           ///< of `angle`
  DigitArray measured_force{};           ///< of a force sensor at each tip; NaN: the device has none [N]
  std::array<bool, kDigits> touching{};  ///< a segment of the digit has a contact
  std::array<bool, kDigits> slips{};     ///< a segment of the digit in contact slips
  /// Share of `force` that ramps and all torque limits leave of it on the way to the device, 0 .. 1: `factor`
  /// where no limit acts. With a limit, the share s whose torques s tau come closest to the sent ones [-]
  DigitArray sent_share{};
  /// Force that was sent over the depth, at the digit's deepest contact; NaN without contact or below
  /// kLeastDepth [N/m]
  DigitArray sent_stiffness{};
  DigitArray depth{};  ///< of that contact in the object [m]; NaN like sent_stiffness
  std::array<std::array<double, 3>, kDigits>
      pad{};  ///< middle of each digit's pad on the measured hand, W [m]

  static constexpr double kLeastDepth = 0.3e-3;  ///< below which a stiffness is not stated [m]
};

/// Report of one fault: the last 2 s before the torque had come to rest.
struct FaultReport {
  FaultEvent event;
  DeviceInfo device;
  std::vector<DeviceSample> samples;
  std::vector<StepRecord> steps;
  LinkStatistics link;
  AngleOrigins angle_origin{};  ///< of StepRecord::angle
};

}  // namespace phalanx
