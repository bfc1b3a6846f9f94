// SPDX-License-Identifier: Apache-2.0
// Leads a wearer through the poses of a calibration. Reads the device's samples and never commands it.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "phalanx/device/calibration.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// The wearer's side: a terminal, or a script.
class CalibrationConsole {
 public:
  CalibrationConsole() = default;
  CalibrationConsole(const CalibrationConsole&) = delete;
  CalibrationConsole& operator=(const CalibrationConsole&) = delete;
  virtual ~CalibrationConsole() = default;

  virtual void say(const std::string& line) = 0;
  /// The next line that is typed; none: there will be no more. Until it comes, `live` is called again and
  /// again for a line that shows what the device reads now.
  virtual std::optional<std::string> answer(const std::function<std::string()>& live) = 0;
};

struct CalibrationDialogue {
  double measure_for = 1.0;  ///< of each pose [s]
  CalibrationLimits limits;
};

/// Poses one after the other: Enter measures, `s` skips, `b` goes back by one, `q` ends. Then fits all
/// channels and says a table; where a channel is refused, poses may be measured again by their numbers.
/// @param device  open, with at least one channel that poses can calibrate
/// @returns device, serial and channels; date and version are the caller's
/// @throws CalibrationError: nothing to calibrate, ended early, or a fit that remains refused; DeviceError:
/// no samples, or the device was lost.
[[nodiscard]] Calibration calibrate_by_poses(Device& device, const Clock& clock, const HandParameters& hand,
                                             CalibrationConsole& console,
                                             const CalibrationDialogue& settings = {});

}  // namespace phalanx
