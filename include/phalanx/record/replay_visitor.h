// SPDX-License-Identifier: Apache-2.0
// What a replay shows of the steps that it makes again, for what is computed from a recording.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "phalanx/device/device.h"
#include "phalanx/station/station_view.h"

namespace phalanx {

/// A station of a recording, as it began.
struct ReplayedStation {
  std::uint64_t number = 0;  ///< StepRecord::station
  std::string scene;         ///< its name or file
  DeviceInfo device;
  std::string calibration;  ///< path of its file; empty: the device's own values
  double rate_hz = 0.0;     ///< of the loop
};

/// Receiver of what replay() makes again, in the order of the file. The functions of this class do nothing.
class ReplayVisitor {
 public:
  ReplayVisitor() = default;
  ReplayVisitor(const ReplayVisitor&) = delete;
  ReplayVisitor& operator=(const ReplayVisitor&) = delete;
  virtual ~ReplayVisitor() = default;

  virtual void station(const ReplayedStation& /*begun*/) {}
  /// Gets a step that was made again: StationStep::describe(), with its input, command and number of samples.
  /// It also gets the device's samples of this step, and the time since the beginning of the recording, as in
  /// its exports [s].
  virtual void step(const StepRecord& /*record*/, std::span<const DeviceSample> /*samples*/,
                    double /*time*/) {}
  /// Gets a step that is in the file and cannot be made again, since steps before it are missing.
  virtual void unknown_step(std::uint64_t /*station*/, std::uint64_t /*tick*/) {}
  /// Gets a step whose bits differ from the recorded ones; step() gets it, too.
  virtual void different(std::uint64_t /*station*/, std::uint64_t /*tick*/, const std::string& /*what*/) {}
  /// Gets steps that the file does not have.
  virtual void missing(std::uint64_t /*station*/, std::uint64_t /*first*/, std::uint64_t /*last*/) {}
};

}  // namespace phalanx
