// SPDX-License-Identifier: Apache-2.0
// Wire and clock of a conformance test. Its tests have a controller in memory, with a clock of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace phalanx {

/// Sender of a frame. Over UDP each has a socket; on a serial line both share the line.
enum class ConformSender { kHost, kOtherHost };

/// Frames to and from the controller under test, with the time at which they come.
class ConformPort {
 public:
  ConformPort() = default;
  ConformPort(const ConformPort&) = delete;
  ConformPort& operator=(const ConformPort&) = delete;
  virtual ~ConformPort() = default;

  /// @returns the host's time [s].
  [[nodiscard]] virtual double now() const = 0;
  virtual void send(std::span<const std::uint8_t> frame, ConformSender sender) = 0;
  /// Sends bytes of a serial line as they are, without an encoding. @pre serial()
  virtual void send_bytes(std::span<const std::uint8_t> bytes) = 0;
  /// Waits for the next frame, at most until `until` [s].
  /// @returns the frame's size; 0: none came
  virtual std::size_t receive(double until, std::span<std::uint8_t> out, ConformSender& to) = 0;
  [[nodiscard]] virtual bool serial() const = 0;
  /// @returns how many bytes a second the line carries in each direction; 0: not limited.
  [[nodiscard]] virtual double bytes_per_second() const = 0;
};

}  // namespace phalanx
