// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace phalanx {

/// Hash of numbers that changes if any bit of any of them does: FNV-1a (Fowler, Noll, Vo) with 64 bits, over words of
/// 64 bits. Not for cryptography. Real-time: O(1) an addition, no allocation, lock, throw or I/O.
class BitHash {
 public:
  constexpr void add(std::uint64_t word) noexcept {
    value_ = (value_ ^ word) * 0x100000001b3ULL;
    value_ ^= value_ >> 29U;  // words, not bytes: brings the upper bits down
  }
  /// Adds the bits of a number: 0 and -0 differ, and so do two kinds of NaN.
  constexpr void add(double value) noexcept { add(std::bit_cast<std::uint64_t>(value)); }
  [[nodiscard]] constexpr std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace phalanx
