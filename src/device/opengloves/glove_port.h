// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace phalanx {

/// Opens a glove's serial port: raw, 8N1 (8 data bits, no parity, 1 stop bit), exclusively. @returns its
/// descriptor, which the caller closes.
/// @throws DeviceError: no such port, no permission, in use, not a baud rate of serial ports.
[[nodiscard]] int open_glove_port(const std::string& port, unsigned baud);

/// @returns the serial number of the USB adapter behind a port ("/dev/ttyUSB0", "/dev/serial/by-id/..."),
/// from the kernel; empty if it has none.
[[nodiscard]] std::string usb_serial_number(const std::string& port);

}  // namespace phalanx
