// SPDX-License-Identifier: Apache-2.0
// The text lines that LucidGloves and other OpenGloves firmware speaks ("alpha" encoding), and the host's
// answers.
//   glove -> host   A0B512C4095D0E0F2047G2047P0(AB)2047(BB)2047...\n      a key, then a number
//   host -> glove   A0B1000C0D0E0\n                                       where each finger is to stop
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Largest number of the wider firmware (12 bit); the narrower one has 10 bit.
inline constexpr int kGloveWide = 4095;
inline constexpr int kGloveNarrow = 1023;
/// Joints of a digit that a glove may send one by one: base, middle, tip.
inline constexpr int kGloveJoints = 3;
/// A digit's numbers: 0 curl `A`, 1 splay `(AB)`, 2.. joints `(AAA)`, `(AAB)`, `(AAC)`.
inline constexpr int kGloveKeysPerDigit = 2 + kGloveJoints;
inline constexpr int kGloveKeys = kDigits * kGloveKeysPerDigit;

[[nodiscard]] constexpr std::size_t glove_curl_key(int digit) noexcept {
  return static_cast<std::size_t>(digit) * std::size_t{kGloveKeysPerDigit};
}
[[nodiscard]] constexpr std::size_t glove_splay_key(int digit) noexcept { return glove_curl_key(digit) + 1; }
[[nodiscard]] constexpr std::size_t glove_joint_key(int digit, int joint) noexcept {
  return glove_curl_key(digit) + 2 + static_cast<std::size_t>(joint);
}

/// What one line said.
struct GloveLine {
  std::array<std::int32_t, kGloveKeys> value{};  ///< counts, 0 .. 4095; where `has`
  std::array<bool, kGloveKeys> has{};
  /// The largest number of the line, whatever its key (a joystick at rest is at half of the full scale).
  std::int32_t largest = 0;
  int clamped = 0;  ///< numbers below 0 or above 4095 of the keys above; they were set to the nearer bound
  /// A key twice, or a parenthesis that does not close: two lines that ran together, or a damaged one. Its
  /// numbers must not be used.
  bool damaged = false;

  /// At least one number, and none of a damaged line.
  [[nodiscard]] bool usable() const noexcept;
};

/// Reads a line without its line end. Buttons, joystick and keys that nobody knows are skipped. Any bytes of
/// any length are allowed. Real-time: O(size), no allocation, lock, throw or I/O.
[[nodiscard]] GloveLine parse_glove_line(std::string_view line) noexcept;

/// Where each digit is to stop: 0 free .. 1000 stops the finger when it is fully open.
using GloveStops = std::array<int, kDigits>;

/// Room for the longest answer, "A1000B1000C1000D1000E1000\n".
inline constexpr std::size_t kGloveAnswerSize = 5 * kDigits + 1;

/// "A%dB%dC%dD%dE%d\n", always all five; a stop outside 0 .. 1000 becomes the nearer bound.
/// @returns how much of `out` it fills. Real-time.
[[nodiscard]] std::size_t format_glove_answer(const GloveStops& stops,
                                              std::array<char, kGloveAnswerSize>& out) noexcept;

}  // namespace phalanx
