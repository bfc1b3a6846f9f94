// SPDX-License-Identifier: Apache-2.0
// Frames through a terminal's file descriptor: COBS, with a buffer for partial writes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/descriptor.h"
#include "phalanx/device/link/phalanx_link.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {

/// Non-blocking descriptor in raw mode; the derived class owns it. Real-time: no allocation, lock or throw.
class SerialLine : public Transport {
 public:
  SerialLine();

  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> out, Peer& from) noexcept override;
  /// Queues a frame whole or not at all, so that the other side never receives half a frame.
  bool send(std::span<const std::uint8_t> frame, Peer to) noexcept override;
  bool send_bytes(std::span<const std::uint8_t> bytes) noexcept override;
  bool wait(double seconds) noexcept override;
  [[nodiscard]] bool lost() const noexcept override { return lost_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return receiver_.dropped + too_large_; }

 protected:
  void use(int descriptor) noexcept { descriptor_ = descriptor; }

 private:
  std::size_t take_buffered(std::span<std::uint8_t> out) noexcept;
  void flush() noexcept;

  int descriptor_ = -1;
  bool lost_ = false;
  std::uint64_t too_large_ = 0;
  phx_receiver receiver_{};
  ReadBuffer<4096> in_;
  /// Bytes that the system has not taken yet. The buffer is short, because waiting commands grow old.
  std::array<std::uint8_t, std::size_t{2} * std::size_t{PHX_COBS_MAX}> out_{};
  std::size_t out_size_ = 0;
};

}  // namespace phalanx
