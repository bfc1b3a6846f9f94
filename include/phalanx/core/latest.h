// SPDX-License-Identifier: Apache-2.0
// The newest value, passed from one thread to another; neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace phalanx {

/// Triple buffer: one slot that the writer fills, one that the reader uses, and one between them that they
/// exchange. For one writing and one reading thread. Real-time on both sides if T's assignment is.
template <class T>
class Latest {
 public:
  Latest() = default;
  explicit Latest(const T& first) : place_{first, first, first} {}

  /// Publishes a value. It takes the place of one that was not read. For the writing thread.
  void write(const T& value) noexcept {
    place_[mine_] = value;
    mine_ = between_.exchange(static_cast<std::uint8_t>(mine_ | kNew), std::memory_order_acq_rel) & kIndex;
  }

  /// Takes the newest value, if one has come since the last call. For the reading thread. @returns true if so
  bool update() noexcept {
    if ((between_.load(std::memory_order_acquire) & kNew) == 0) return false;
    theirs_ = between_.exchange(theirs_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// @returns the value that the last update() took; T's first value before that. It is valid and constant until
  /// the next update(). For the reading thread.
  [[nodiscard]] const T& value() const noexcept { return place_[theirs_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kNew = 4;
  std::array<T, 3> place_{};
  std::uint8_t mine_ = 0;                  ///< the writer's slot
  std::atomic<std::uint8_t> between_ = 1;  ///< the slot between; kNew is set if the reader has not taken it
  std::uint8_t theirs_ = 2;                ///< the reader's slot
};

}  // namespace phalanx
