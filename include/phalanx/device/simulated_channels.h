// SPDX-License-Identifier: Apache-2.0
// The sensors of a simulated exoskeleton as channels: what its controller would say of itself over the link.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "phalanx/device/device.h"
#include "phalanx/device/simulated_exoskeleton.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// One angle channel per joint of the device (a count is its sensor's least significant bit, 10 urad where it
/// has none), one motor channel per motor (1 um a count), one torque channel per joint with a torque sensor
/// (0.1 mNm a count). The valid range of an angle is its joint's range of motion and 20 degrees on either
/// side.
/// @throws std::invalid_argument if these are more than kMaxChannels. Set-up only.
[[nodiscard]] std::vector<DeviceChannel> simulated_channels(const Exoskeleton& exoskeleton,
                                                            const HandParameters& hand);

/// Raw counts of the tick that `device` began last. Real-time.
void read_raw(const SimulatedExoskeleton& device, const std::vector<DeviceChannel>& channels,
              std::array<std::int32_t, kMaxChannels>& raw) noexcept;

}  // namespace phalanx
