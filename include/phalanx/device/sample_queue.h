// SPDX-License-Identifier: Apache-2.0
// Samples, passed from the thread that waits for a device to the loop's thread; neither ever waits.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>

#include "phalanx/device/device.h"

namespace phalanx {

/// Ring of fixed size for one writing and one reading thread. Real-time: no allocation, lock, throw or I/O.
class SampleQueue {
 public:
  static constexpr std::size_t kCapacity = 512;  ///< 0.5 s at 1 kHz

  /// Appends a sample; for the writer. @returns true if there was room
  bool push(const DeviceSample& sample) noexcept {
    const std::size_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == kCapacity) return false;
    place_[written % kCapacity] = sample;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  struct Taken {
    std::size_t count = 0;    ///< samples in `out`
    std::size_t dropped = 0;  ///< older samples for which `out` had no room
  };
  /// Takes all samples, oldest first; for the reader. If `out` is too small, it takes the newest ones.
  Taken take(std::span<DeviceSample> out) noexcept {
    std::size_t read = read_.load(std::memory_order_relaxed);
    const std::size_t there = written_.load(std::memory_order_acquire) - read;
    Taken taken{.count = std::min(there, out.size()), .dropped = 0};
    taken.dropped = there - taken.count;
    read += taken.dropped;
    for (std::size_t i = 0; i < taken.count; ++i) out[i] = place_[read++ % kCapacity];
    read_.store(read, std::memory_order_release);
    return taken;
  }

 private:
  std::array<DeviceSample, kCapacity> place_{};
  alignas(64) std::atomic<std::size_t> written_{0};
  alignas(64) std::atomic<std::size_t> read_{0};
};

}  // namespace phalanx
