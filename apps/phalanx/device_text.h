// SPDX-License-Identifier: Apache-2.0
// A device's channels and states in words, for the screen and for CSV headers.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/device/device.h"

namespace phalanx {

[[nodiscard]] std::string_view state_name(DeviceState state) noexcept;
/// "angle", "torque", "force", "motor", "curl", "splay".
[[nodiscard]] std::string_view kind_name(ChannelKind kind) noexcept;
/// What it measures: "index_pip_flexion", "thumb", "motor 3".
[[nodiscard]] std::string place_name(const DeviceChannel& channel);
/// The unit of shown(): "deg", "Nm", "N", "mm"; empty for curl and splay.
[[nodiscard]] std::string_view shown_unit(ChannelKind kind) noexcept;
/// Raw counts as people read them: degrees and millimetres in place of rad and m.
[[nodiscard]] double shown(const DeviceChannel& channel, std::int32_t raw) noexcept;
/// false: an open or shorted sensor.
[[nodiscard]] bool in_range(const DeviceChannel& channel, std::int32_t raw) noexcept;
/// "fault_name: what it means; what to do".
[[nodiscard]] std::string fault_text(Fault fault);

/// From here on, Ctrl-C and SIGTERM only make interrupted() true.
void watch_for_interrupt();
[[nodiscard]] bool interrupted() noexcept;

}  // namespace phalanx
