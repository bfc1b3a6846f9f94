// SPDX-License-Identifier: Apache-2.0
// The dialogue of a calibration by poses. It reads the device's samples and never commands it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "phalanx/device/calibration.h"
#include "phalanx/device/calibration_session.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Input and output for the person who calibrates: a terminal, or a script.
class CalibrationConsole {
 public:
  CalibrationConsole() = default;
  CalibrationConsole(const CalibrationConsole&) = delete;
  CalibrationConsole& operator=(const CalibrationConsole&) = delete;
  virtual ~CalibrationConsole() = default;

  virtual void say(const std::string& line) = 0;
  /// Waits for the next typed line; none: no more lines will come. While it waits, it calls `live` repeatedly
  /// for a line with the device's present readings.
  virtual std::optional<std::string> answer(const std::function<std::string()>& live) = 0;
};

/// Settings of the dialogue.
struct CalibrationDialogue {
  double measure_for = 1.0;  ///< duration of each pose's measurement [s]
  CalibrationLimits limits = {};
  CalibrationPlan plan = {};
  std::optional<Calibration> earlier = {};  ///< CalibrationSession's
};

/// Leads through the poses: Enter measures, a number is the angle of the pose's joint in degrees, NAME=DEGREES that of
/// one of several joints. `s` skips, `b` goes back by one, `q` ends. It then
/// fits all channels and shows a table. If a channel is refused, poses can be measured again
/// by their numbers.
/// @param device  open, with at least one channel that poses can calibrate
/// @returns device, serial and channels; the caller adds date and version
/// @throws CalibrationError: no channel to calibrate, ended early, or a fit that remains refused;
/// DeviceError: no samples, or the device was lost.
[[nodiscard]] Calibration calibrate_by_poses(Device& device, const Clock& clock, const HandParameters& hand,
                                             CalibrationConsole& console,
                                             const CalibrationDialogue& settings = {});

}  // namespace phalanx
