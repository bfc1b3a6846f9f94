// SPDX-License-Identifier: Apache-2.0
// Channels of a simulated exoskeleton's sensors, as its controller describes them over the link.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {

/// Makes one angle channel per joint of the device, one motor channel per motor, and one torque channel per
/// joint with a torque sensor. One count of an angle is its sensor's least significant bit, or 10 urad
/// without one. One count of a motor is 1 um, and of a torque 0.1 mNm. The valid range of an angle is its
/// joint's range of motion, extended by 20 degrees on either side.
/// @throws std::invalid_argument if there are more than kMaxChannels. Set-up only.
[[nodiscard]] std::vector<DeviceChannel> simulated_channels(const Exoskeleton& exoskeleton,
                                                            const HandParameters& hand);

/// Writes the raw counts of the tick that `device` began last. Real-time.
void read_raw(const SimulatedExoskeleton& device, const std::vector<DeviceChannel>& channels,
              std::array<std::int32_t, kMaxChannels>& raw) noexcept;

}  // namespace phalanx
