// SPDX-License-Identifier: Apache-2.0
// The newest value from one thread to another; neither ever waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace phalanx {

/// Three places: one that the writer fills, one that the reader looks at, one between them that they swap.
/// One writing thread, one reading thread. Real-time on both sides if T's assignment is.
template <class T>
class Latest {
 public:
  Latest() = default;
  explicit Latest(const T& first) : place_{first, first, first} {}

  void write(const T& value) noexcept {
    place_[mine_] = value;
    mine_ = between_.exchange(static_cast<std::uint8_t>(mine_ | kNew), std::memory_order_acq_rel) & kIndex;
  }

  /// Takes the newest value, if one has come since the last call. @returns whether
  bool update() noexcept {
    if ((between_.load(std::memory_order_acquire) & kNew) == 0) return false;
    theirs_ = between_.exchange(theirs_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// What the last update() found; T's first value before that.
  [[nodiscard]] const T& value() const noexcept { return place_[theirs_]; }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kNew = 4;
  std::array<T, 3> place_{};
  std::uint8_t mine_ = 0;                  ///< the writer's
  std::atomic<std::uint8_t> between_ = 1;  ///< with kNew if it holds what the reader has not seen
  std::uint8_t theirs_ = 2;                ///< the reader's
};

}  // namespace phalanx
