// SPDX-License-Identifier: Apache-2.0
// Opening a device by its address, as a user types it, for example
// "udp:192.168.7.2:47800", "serial:/dev/ttyACM0" or "opengloves:/dev/ttyUSB0".
#pragma once

#include <memory>
#include <string>

#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/device/link/link_device.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {

/// The kinds of address, one line each, for help texts.
inline constexpr const char* kDeviceSpecs =
    "udp:HOST:PORT            a controller of the Phalanx link on the network\n"
    "serial:PORT[:BAUD]       the same on a serial port [2000000 baud]\n"
    "opengloves:PORT[:BAUD]   a LucidGloves or OpenGloves glove [115200 baud]";

/// Opens the transport of a controller that speaks the Phalanx link: "udp:HOST:PORT" or "serial:PORT[:BAUD]".
/// @throws std::invalid_argument that lists the possible addresses if `spec` is not one of them; DeviceError
/// if the transport does not open. Set-up only.
[[nodiscard]] std::unique_ptr<Transport> open_transport(const std::string& spec);

/// Makes the device for an address of kDeviceSpecs. The device is not open yet.
/// @param clock     the process's clock; must outlive the device
/// @param settings  for the Phalanx link; a glove uses hello_timeout alone
/// @throws as open_transport().
[[nodiscard]] std::unique_ptr<Device> open_device(const std::string& spec, const Clock& clock,
                                                  const LinkSettings& settings = {});

}  // namespace phalanx
