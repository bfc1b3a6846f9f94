// SPDX-License-Identifier: Apache-2.0
// Bookkeeping of a sender's numbered frames: new, late, duplicate or lost.
#pragma once

#include <bit>
#include <cstdint>

namespace phalanx {

/// Window over the last 64 sequence numbers. A number is lost when it leaves the window unseen; a frame that
/// comes late, but within the window, is not lost. Real-time: no allocation, lock, throw or I/O.
class SequenceWindow {
 public:
  enum class Frame { kNew, kLate, kDuplicate };

  /// Takes the number of a received frame. Numbers may wrap around.
  Frame take(std::uint32_t sequence) noexcept {
    if (!begun_) {
      begun_ = true;
      newest_ = sequence;
      return Frame::kNew;
    }
    const auto ahead = static_cast<std::int32_t>(sequence - newest_);
    if (ahead > 0) {
      move(static_cast<std::uint32_t>(ahead));
      return Frame::kNew;
    }
    const std::uint32_t behind = newest_ - sequence;
    if (behind >= kSize) return Frame::kDuplicate;  // or so late that it has been counted as lost
    const std::uint64_t bit = std::uint64_t{1} << behind;
    const bool seen = (seen_ & bit) != 0;
    seen_ |= bit;
    return seen ? Frame::kDuplicate : Frame::kLate;
  }

  /// @returns how many numbers left the window unseen.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  /// @returns how many numbers in the window are unseen: late or lost.
  [[nodiscard]] std::uint64_t missing() const noexcept {
    return kSize - static_cast<std::uint64_t>(std::popcount(seen_));
  }

 private:
  static constexpr std::uint32_t kSize = 64;

  void move(std::uint32_t steps) noexcept {
    if (steps >= kSize) {
      lost_ += missing() + (steps - kSize);
      seen_ = 1;
    } else {
      const std::uint64_t leaving = ~(~std::uint64_t{0} >> steps);
      lost_ += static_cast<std::uint64_t>(std::popcount(~seen_ & leaving));
      seen_ = (seen_ << steps) | 1;
    }
    newest_ += steps;
  }

  bool begun_ = false;
  std::uint32_t newest_ = 0;
  /// Bit i: newest - i has come. Numbers before the first frame count as seen.
  std::uint64_t seen_ = ~std::uint64_t{0};
  std::uint64_t lost_ = 0;
};

}  // namespace phalanx
