// SPDX-License-Identifier: Apache-2.0
// What is published about the size and the motion of adult hands: the one place that holds these numbers.
#pragma once

#include <span>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Mean and standard deviation of one measure over one group of people [m].
struct Norm {
  std::string_view group;  ///< "men", "women", "adults"
  double mean = 0.0;
  double sd = 0.0;
};

/// What a profile may state.
struct PlausibleRange {
  double min = 0.0;
  double max = 0.0;
  std::string_view source;  ///< who measured it, or "our own bounds"
};

/// How many standard deviations from the mean are believed.
inline constexpr double kPlausibleDeviations = 4.0;

/// Hand length: wrist crease to the tip of the middle finger [m].
[[nodiscard]] std::span<const Norm> hand_length_norms() noexcept;
/// Hand breadth at the metacarpals, without the thumb [m].
[[nodiscard]] std::span<const Norm> hand_breadth_norms() noexcept;
/// Bone length of a segment of a digit, from joint to joint; a distal phalanx without its soft tip [m].
[[nodiscard]] Norm segment_length_norm(int segment) noexcept;
/// Length of the metacarpal of a digit [m]. (The thumb's is a segment of its own.)
[[nodiscard]] Norm metacarpal_length_norm(int digit) noexcept;

/// From the lowest mean - 4 SD to the highest mean + 4 SD over the groups [m].
[[nodiscard]] PlausibleRange plausible_hand_length() noexcept;
[[nodiscard]] PlausibleRange plausible_hand_breadth() noexcept;
[[nodiscard]] PlausibleRange plausible_segment_length(int segment) noexcept;
/// Length of the palm relative to the base hand's: that of the middle metacarpal relative to its mean [-].
[[nodiscard]] PlausibleRange plausible_palm_ratio() noexcept;
/// Breadth of a segment relative to the base hand's [-]: our own bounds.
[[nodiscard]] PlausibleRange plausible_breadth_ratio() noexcept;
/// Angle of a joint, anatomically possible at all [rad]: our own bounds.
[[nodiscard]] PlausibleRange plausible_angle(int joint) noexcept;

}  // namespace phalanx
