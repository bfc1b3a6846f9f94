// SPDX-License-Identifier: Apache-2.0
// Conversion between the link's messages (phalanx_link.h) and the types of the Device interface.
// It sends nothing.
#pragma once

#include <span>
#include <string>

#include "phalanx/device/device.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx {

/// Writes header.type and the payload; the sender sets epoch and sequence. The type is PHX_COMMAND, or
/// PHX_COMMAND_WALLS if the command carries walls. A wall that is not active has the stiffness 0. Numbers are
/// rounded to binary32. Real-time.
void write_command(const DeviceCommand& command, phx_message& message) noexcept;

/// Reads a PHX_SAMPLE. Real-time.
/// @param received  the host's clock at arrival [s]
[[nodiscard]] DeviceSample read_sample(const phx_message& message, double received) noexcept;

/// Makes PHX_CONFIGURE without epoch and sequence. Channels that the list does not have get gain
/// and offset 0.
/// @param torque_limit  [Nm]
/// @param torque_rate   [Nm/s]
[[nodiscard]] phx_message configure_message(std::span<const DeviceChannel> channels, double torque_limit,
                                            double torque_rate) noexcept;

/// @returns the identity that a controller reports. The link does not carry the model's name: `name` is the
/// serial number. Set-up only.
[[nodiscard]] DeviceInfo device_info(const phx_welcome& welcome);

/// @returns one channel in the link's form.
[[nodiscard]] phx_channel link_channel(const DeviceChannel& channel) noexcept;

/// Writes a serial number, cut to PHX_SERIAL_SIZE and padded with zeros.
void write_serial(const std::string& serial, char (&out)[PHX_SERIAL_SIZE]) noexcept;
/// Reads a serial number, without the zeros at its end.
[[nodiscard]] std::string read_serial(const char (&serial)[PHX_SERIAL_SIZE]);

}  // namespace phalanx
