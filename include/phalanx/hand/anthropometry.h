// SPDX-License-Identifier: Apache-2.0
// Published sizes and motion ranges of adult hands. All such numbers are in this folder's anthropometry.cpp.
#pragma once

#include <span>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Mean and standard deviation (SD) of one measure over one group of people [m].
struct Norm {
  std::string_view group;  ///< "men", "women", "adults"
  double mean = 0.0;
  double sd = 0.0;
};

/// Range of values that a patient's profile may state.
struct PlausibleRange {
  double min = 0.0;
  double max = 0.0;
  std::string_view source;  ///< who measured it, or "our own bounds, ..."
};

/// Half width of a plausible range in standard deviations.
inline constexpr double kPlausibleDeviations = 4.0;

/// Returns the norms of the hand length: from the wrist crease to the tip of the middle finger [m].
[[nodiscard]] std::span<const Norm> hand_length_norms() noexcept;
/// Returns the norms of the hand breadth at the metacarpals, without the thumb [m].
[[nodiscard]] std::span<const Norm> hand_breadth_norms() noexcept;
/// Returns the norm of the bone length of a digit's segment, from joint to joint [m]. A distal phalanx counts
/// without its soft tip.
[[nodiscard]] Norm segment_length_norm(int segment) noexcept;
/// Returns the norm of the length of a digit's metacarpal [m]. The thumb's metacarpal is also a segment.
[[nodiscard]] Norm metacarpal_length_norm(int digit) noexcept;

/// Returns the range from the lowest mean - 4 SD to the highest mean + 4 SD over the groups [m].
[[nodiscard]] PlausibleRange plausible_hand_length() noexcept;
[[nodiscard]] PlausibleRange plausible_hand_breadth() noexcept;
[[nodiscard]] PlausibleRange plausible_segment_length(int segment) noexcept;
/// Returns the range of the palm's length relative to the base hand's [-]. It is that of the middle
/// metacarpal relative to its mean.
[[nodiscard]] PlausibleRange plausible_palm_ratio() noexcept;
/// Returns the range of a segment's breadth relative to the base hand's [-]: our own bounds.
[[nodiscard]] PlausibleRange plausible_breadth_ratio() noexcept;
/// Returns the anatomically possible range of a joint's angle [rad]: our own bounds.
[[nodiscard]] PlausibleRange plausible_angle(int joint) noexcept;

}  // namespace phalanx
