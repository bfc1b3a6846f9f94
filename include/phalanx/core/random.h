// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace phalanx {

/// Pseudorandom numbers by SplitMix64 (Steele, Lea & Flood 2014). A seed gives the same numbers with every
/// standard library. Real-time: O(1), no allocation.
class Random {
 public:
  explicit constexpr Random(std::uint64_t seed) noexcept : state_(seed) {}

  /// Returns a uniform number in [0, 1).
  [[nodiscard]] constexpr double uniform() noexcept {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1.0p-53;
  }
  /// Returns a uniform number in [low, high).
  [[nodiscard]] constexpr double between(double low, double high) noexcept {
    return low + (high - low) * uniform();
  }
  /// Returns a normal number with mean 0 and standard deviation 1 (Box & Muller 1958). Uses
  /// two uniform numbers.
  [[nodiscard]] double normal() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace phalanx
