// SPDX-License-Identifier: Apache-2.0
// The dialogue that measures a patient's range of motion. It reads the device's samples and never commands it.
#pragma once

#include <vector>

#include "device/calibration_dialogue.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/device/measured_range.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Leads the patient through the digits: Enter begins and accepts, `r` repeats, `s` leaves a digit out, `b` goes back by
/// one, `q` ends.
/// @param device    open
/// @param channels  its channels with the calibration
/// @returns device, serial and joints; the caller adds the rest
/// @throws CalibrationError: no channel to measure, or ended early; DeviceError: the device was lost.
[[nodiscard]] MeasuredRange measure_range_of_patient(Device& device, std::vector<DeviceChannel> channels,
                                                     const Clock& clock, const HandParameters& hand,
                                                     CalibrationConsole& console);

}  // namespace phalanx
