// SPDX-License-Identifier: Apache-2.0
// Opening the device of a station, with its calibration.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/station/safety_settings.h"

namespace phalanx {

/// An open device with its calibrated channels.
struct OpenDevice {
  std::unique_ptr<Device> device;
  std::vector<DeviceChannel> channels;
};

/// Settings of a device on a wire.
struct WiredDeviceSettings {
  std::string spec;         ///< address, see open_device.h
  std::string calibration;  ///< calibration file; empty: the device's own values
  bool ask_for_realtime = true;
  std::optional<double> watchdog = {};  ///< DeviceInfo::watchdog of a glove's firmware [s]
  bool force_feedback = true;           ///< false: a glove that only senses (DeviceInfo::actuated)
};

/// Opens a device on a wire, and gives it the limits and the calibration.
/// @param hand   the wearer's hand, as a right hand
/// @param clock  the process's clock; outlives the device
/// @throws DeviceError, CalibrationError, SceneError or std::invalid_argument; each names the
/// remedy. Set-up only.
[[nodiscard]] OpenDevice open_wired_device(const WiredDeviceSettings& settings, const SafetySettings& safety,
                                           const HandParameters& hand, const Clock& clock);

}  // namespace phalanx
