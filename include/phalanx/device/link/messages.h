// SPDX-License-Identifier: Apache-2.0
// Between the link's messages (phalanx_link.h) and the types of the Device interface. Nothing here sends.
#pragma once

#include <span>
#include <string>

#include "phalanx/device/device.h"
#include "phalanx/device/link/phalanx_link.h"

namespace phalanx {

/// Fills header.type (PHX_COMMAND, or PHX_COMMAND_WALLS if the command carries walls) and the payload; epoch
/// and sequence are the sender's. A wall that is not active has the stiffness 0. Numbers lose what binary32
/// does not hold. Real-time.
void write_command(const DeviceCommand& command, phx_message& message) noexcept;

/// A PHX_SAMPLE.
/// @param received  the host's clock when it came in [s]
/// Real-time.
[[nodiscard]] DeviceSample read_sample(const phx_message& message, double received) noexcept;

/// PHX_CONFIGURE without epoch and sequence. Channels that the list does not have get gain and offset 0.
/// @param torque_limit  [Nm]
/// @param torque_rate   [Nm/s]
[[nodiscard]] phx_message configure_message(std::span<const DeviceChannel> channels, double torque_limit,
                                            double torque_rate) noexcept;

/// Who a controller says that it is. The link does not carry the model's name: `name` is the serial number.
/// Set-up only.
[[nodiscard]] DeviceInfo device_info(const phx_welcome& welcome);

/// One channel as the link describes it.
[[nodiscard]] phx_channel link_channel(const DeviceChannel& channel) noexcept;

/// Cut to PHX_SERIAL_SIZE, padded with zeros.
void write_serial(const std::string& serial, char (&out)[PHX_SERIAL_SIZE]) noexcept;
[[nodiscard]] std::string read_serial(const char (&serial)[PHX_SERIAL_SIZE]);

}  // namespace phalanx
