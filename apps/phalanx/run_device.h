// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/scene/scene.h"
#include "phalanx/station/assemble.h"
#include "run_options.h"

namespace phalanx {

/// A device, open, with the channels that its calibration says.
struct OpenDevice {
  std::unique_ptr<Device> device;
  std::vector<DeviceChannel> channels;
};

/// The device of `phalanx run --device`, connected and calibrated.
/// @param clock  of the process; must outlive the device
/// @throws DeviceError, CalibrationError, SceneError or std::invalid_argument, each saying what to do.
[[nodiscard]] OpenDevice open_station_device(const RunOptions& options, const SceneDescription& scene,
                                             const StationModel& made, const Clock& clock);

}  // namespace phalanx
