// SPDX-License-Identifier: Apache-2.0
// The text lines of LucidGloves and other OpenGloves firmware ("alpha" encoding), and the host's answers.
//   glove -> host   A0B512C4095D0E0F2047G2047P0(AB)2047(BB)2047...\n      a key, then a number
//   host -> glove   A0B1000C0D0E0\n                                       position at which each finger stops
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Largest number of the wider firmware (12 bits); the narrower one has 10 bits.
inline constexpr int kGloveWide = 4095;
inline constexpr int kGloveNarrow = 1023;
/// Joints of a digit that a glove may send separately: base, middle, tip.
inline constexpr int kGloveJoints = 3;
/// Numbers of a digit: 0 curl `A`, 1 splay `(AB)`, 2.. joints `(AAA)`, `(AAB)`, `(AAC)`.
inline constexpr int kGloveKeysPerDigit = 2 + kGloveJoints;
inline constexpr int kGloveKeys = kDigits * kGloveKeysPerDigit;

/// @returns the index of a digit's curl in GloveLine::value.
[[nodiscard]] constexpr std::size_t glove_curl_key(int digit) noexcept {
  return static_cast<std::size_t>(digit) * std::size_t{kGloveKeysPerDigit};
}
/// @returns the index of a digit's splay.
[[nodiscard]] constexpr std::size_t glove_splay_key(int digit) noexcept { return glove_curl_key(digit) + 1; }
/// @returns the index of a digit's joint: 0 base, 1 middle, 2 tip.
[[nodiscard]] constexpr std::size_t glove_joint_key(int digit, int joint) noexcept {
  return glove_curl_key(digit) + 2 + static_cast<std::size_t>(joint);
}

/// Content of one line.
struct GloveLine {
  std::array<std::int32_t, kGloveKeys> value{};  ///< counts, 0 .. 4095; valid where `has` is true
  std::array<bool, kGloveKeys> has{};
  /// Largest number of the line, of any key (a joystick at rest is at half of the full scale).
  std::int32_t largest = 0;
  int clamped = 0;  ///< numbers of the keys above that were outside 0 .. 4095 and set to the nearer bound
  /// A key occurs twice, or a parenthesis does not close: two joined lines, or a damaged one. Its numbers
  /// must not be used.
  bool damaged = false;

  /// @returns true if there is at least one number and the line is not damaged.
  [[nodiscard]] bool usable() const noexcept;
};

/// Reads a line without its line end. Buttons, joystick and unknown keys are skipped. Any bytes of any length
/// are allowed. Real-time: O(size), no allocation, lock, throw or I/O.
[[nodiscard]] GloveLine parse_glove_line(std::string_view line) noexcept;

/// Stop position of each digit: 0 free .. 1000 stops the finger when it is fully open.
using GloveStops = std::array<int, kDigits>;

/// Size of the longest answer, "A1000B1000C1000D1000E1000\n".
inline constexpr std::size_t kGloveAnswerSize = 5 * kDigits + 1;

/// Writes "A%dB%dC%dD%dE%d\n", always all five; a stop outside 0 .. 1000 becomes the nearer bound.
/// @returns the number of bytes written to `out`. Real-time.
[[nodiscard]] std::size_t format_glove_answer(const GloveStops& stops,
                                              std::array<char, kGloveAnswerSize>& out) noexcept;

}  // namespace phalanx
