// SPDX-License-Identifier: Apache-2.0
// Whole frames over a wire: a UDP socket or a serial line. The host's link thread and the simulated
// controller both use it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "phalanx/device/device.h"

namespace phalanx {

/// Address of a peer: for UDP its address and port, packed; 0 if there is only one peer (serial).
using Peer = std::uint64_t;

/// Non-blocking transport of frames, for one thread.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Fetches the next received frame. A frame that is larger than `out` is dropped and counted. So are bytes
  /// that are not a frame of the wire (COBS, Consistent Overhead Byte Stuffing).
  /// @returns the frame's size; 0: none for now
  [[nodiscard]] virtual std::size_t receive(std::span<std::uint8_t> out, Peer& from) noexcept = 0;
  /// Sends a frame. @returns true if the system took it; a full buffer drops it
  virtual bool send(std::span<const std::uint8_t> frame, Peer to) noexcept = 0;
  /// Sends bytes of a serial line as they are, without COBS: for tests of a receiver.
  /// @returns true if the system took all of them; false on another wire
  virtual bool send_bytes(std::span<const std::uint8_t> bytes) noexcept {
    static_cast<void>(bytes);
    return false;
  }
  /// Waits until something can be received, at most `seconds` of real time. @returns true if so
  virtual bool wait(double seconds) noexcept = 0;
  /// @returns true if the wire itself is gone (unplugged).
  [[nodiscard]] virtual bool lost() const noexcept = 0;
  /// @returns how many pieces were not frames.
  [[nodiscard]] virtual std::uint64_t dropped() const noexcept = 0;
  /// @returns the address by which another finds it: "udp:127.0.0.1:40123", "serial:/dev/pts/3".
  [[nodiscard]] virtual std::string address() const = 0;
};

/// Opens a client's socket to "HOST:PORT". The peer of its frames is always 0.
/// @throws DeviceError if there is no such host; std::invalid_argument if it is not HOST:PORT
[[nodiscard]] std::unique_ptr<Transport> connect_udp(const std::string& host_and_port);
/// Opens a server's socket on "ADDRESS:PORT" (port 0: any free one).
/// @throws DeviceError if the port is in use or there is no such address; std::invalid_argument if it
/// is not ADDRESS:PORT
[[nodiscard]] std::unique_ptr<Transport> listen_udp(const std::string& address_and_port);
/// Opens a serial port, raw, 8N1 (8 data bits, no parity, 1 stop bit), at `baud`.
/// @throws DeviceError if there is no such port, no permission (group dialout), or it is in use
[[nodiscard]] std::unique_ptr<Transport> open_serial(const std::string& port, unsigned baud = 2000000);
/// Opens the controller's end of a new pseudo-terminal; the host opens address().
/// @throws DeviceError
[[nodiscard]] std::unique_ptr<Transport> open_pseudo_terminal();

}  // namespace phalanx
