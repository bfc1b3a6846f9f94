// SPDX-License-Identifier: Apache-2.0
// The hand's 20 joints and 16 segments: their numbers and names, and which joint moves which segment.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace phalanx {

inline constexpr int kDigits = 5;
inline constexpr int kJointsPerDigit = 4;
inline constexpr int kSegmentsPerDigit = 3;
inline constexpr int kAbductionJoint = 1;  ///< of a digit's joints, the one that moves it sideways
inline constexpr int kJoints = kDigits * kJointsPerDigit;
inline constexpr int kSegments = kDigits * kSegmentsPerDigit + 1;
/// The palm is the last segment. It is fixed in the world.
inline constexpr int kPalm = kSegments - 1;

enum class Digit { kThumb, kIndex, kMiddle, kRing, kLittle };
enum class Handedness { kRight, kLeft };

/// One number per joint, in the order of joint_name(): digit by digit from the thumb, each from the palm to
/// the tip (flexion, abduction, then the two hinges). Angles in rad, flexion and abduction (spreading)
/// positive; torques in Nm.
using JointArray = std::array<double, kJoints>;

/// Joint `i` (0: flexion, 1: abduction, 2, 3: hinges) of a digit. S2 fig. 1.
[[nodiscard]] constexpr int joint_index(int digit, int i) noexcept { return digit * kJointsPerDigit + i; }
/// Segment `k` (0: nearest the palm, 2: distal) of a digit.
[[nodiscard]] constexpr int segment_index(int digit, int k) noexcept { return digit * kSegmentsPerDigit + k; }
[[nodiscard]] constexpr int digit_of_joint(int joint) noexcept { return joint / kJointsPerDigit; }
/// The digit of a segment, -1 for the palm.
[[nodiscard]] constexpr int digit_of_segment(int segment) noexcept {
  return segment == kPalm ? -1 : segment / kSegmentsPerDigit;
}
/// A joint belongs to the segment that it moves: both axes of a finger's MCP (the thumb's CMC) move the first
/// segment.
[[nodiscard]] constexpr int segment_in_digit_of_joint(int i) noexcept { return i < 2 ? 0 : i - 1; }
/// Number of a digit's joints, counted from the palm, that move its segment k: 2, 3, 4.
[[nodiscard]] constexpr int joints_that_move(int k) noexcept { return k + 2; }

/// "index_mcp_flexion", ...
[[nodiscard]] std::string_view joint_name(int joint) noexcept;
/// WebXR hand joint name of the segment's frame: "index-finger-phalanx-proximal", ...; the palm is "wrist".
[[nodiscard]] std::string_view segment_name(int segment) noexcept;
/// "thumb", "index", "middle", "ring", "little".
[[nodiscard]] std::string_view digit_name(int digit) noexcept;
[[nodiscard]] std::optional<int> find_joint(std::string_view name) noexcept;
[[nodiscard]] std::optional<int> find_segment(std::string_view name) noexcept;

}  // namespace phalanx
