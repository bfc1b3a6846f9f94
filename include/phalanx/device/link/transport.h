// SPDX-License-Identifier: Apache-2.0
// Whole frames over a wire: a UDP socket or a serial line. Used by the host's link thread and by the
// simulated controller alike.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "phalanx/device/device.h"

namespace phalanx {

/// A peer: for UDP its address and port, packed; 0 where there is only one (serial).
using Peer = std::uint64_t;

/// Non-blocking. One thread uses it.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// The next frame that has come in. @returns its size; 0: none for now. What is larger than `out` or not
  /// a frame of the wire (COBS) is dropped and counted.
  [[nodiscard]] virtual std::size_t receive(std::span<std::uint8_t> out, Peer& from) noexcept = 0;
  /// @returns whether it was handed to the system; a full buffer drops it
  virtual bool send(std::span<const std::uint8_t> frame, Peer to) noexcept = 0;
  /// Waits until something can be received, at most `seconds` of real time. @returns whether
  virtual bool wait(double seconds) noexcept = 0;
  /// The wire itself is gone (unplugged).
  [[nodiscard]] virtual bool lost() const noexcept = 0;
  /// Pieces that were not frames.
  [[nodiscard]] virtual std::uint64_t dropped() const noexcept = 0;
  /// How another finds it: "udp:127.0.0.1:40123", "serial:/dev/pts/3".
  [[nodiscard]] virtual std::string address() const = 0;
};

/// A client's socket to "HOST:PORT". Peer of its frames is always 0. @throws DeviceError: no such host;
/// std::invalid_argument: not HOST:PORT.
[[nodiscard]] std::unique_ptr<Transport> connect_udp(const std::string& host_and_port);
/// A server's socket on "ADDRESS:PORT" (port 0: any free one). @throws DeviceError: port in use, no such
/// address; std::invalid_argument: not ADDRESS:PORT.
[[nodiscard]] std::unique_ptr<Transport> listen_udp(const std::string& address_and_port);
/// A serial port, raw, 8N1, at `baud`. @throws DeviceError: no such port, no permission (group dialout), in
/// use.
[[nodiscard]] std::unique_ptr<Transport> open_serial(const std::string& port, unsigned baud = 2000000);
/// The controller's end of a new pseudo-terminal; address() is what the host opens. @throws DeviceError.
[[nodiscard]] std::unique_ptr<Transport> open_pseudo_terminal();

}  // namespace phalanx
