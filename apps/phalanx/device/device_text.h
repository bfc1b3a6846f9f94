// SPDX-License-Identifier: Apache-2.0
// A device's channels and states in words, for the screen and for CSV headers.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/device/device.h"

namespace phalanx {

/// @returns the state in words.
[[nodiscard]] std::string_view state_name(DeviceState state) noexcept;
/// @returns "angle", "torque", "force", "motor", "curl" or "splay".
[[nodiscard]] std::string_view kind_name(ChannelKind kind) noexcept;
/// @returns the measured place: "index_pip_flexion", "thumb", "motor 3".
[[nodiscard]] std::string place_name(const DeviceChannel& channel);
/// @returns the unit of shown(): "deg", "Nm", "N", "mm"; empty for curl and splay.
[[nodiscard]] std::string_view shown_unit(ChannelKind kind) noexcept;
/// Converts raw counts to a unit for display: degrees and millimetres in place of rad and m.
[[nodiscard]] double shown(const DeviceChannel& channel, std::int32_t raw) noexcept;
/// @returns false for an open or shorted sensor.
[[nodiscard]] bool in_range(const DeviceChannel& channel, std::int32_t raw) noexcept;
/// @returns "fault_name: its meaning; its remedy".
[[nodiscard]] std::string fault_text(Fault fault);

}  // namespace phalanx
