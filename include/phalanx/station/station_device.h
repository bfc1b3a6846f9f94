// SPDX-License-Identifier: Apache-2.0
// The device of a station, connected and calibrated.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/station/safety_settings.h"

namespace phalanx {

/// A device, open, with the channels that its calibration says.
struct OpenDevice {
  std::unique_ptr<Device> device;
  std::vector<DeviceChannel> channels;
};

struct WiredDeviceSettings {
  std::string spec;         ///< its address: open_device.h
  std::string calibration;  ///< its file; empty: the device's own numbers
  bool ask_for_realtime = true;
};

/// Opens a device on a wire and tells it limits and calibration.
/// @param hand   the wearer's (a right hand's numbers)
/// @param clock  of the process; outlives the device
/// @throws DeviceError, CalibrationError, SceneError or std::invalid_argument, each saying what to do. Set-up
/// only.
[[nodiscard]] OpenDevice open_wired_device(const WiredDeviceSettings& settings, const SafetySettings& safety,
                                           const HandParameters& hand, const Clock& clock);

}  // namespace phalanx
