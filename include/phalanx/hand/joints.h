// SPDX-License-Identifier: Apache-2.0
// The hand's 20 joints and 16 segments: numbers, names, and which joint moves which segment. Joints have
// anatomical names: metacarpophalangeal (MCP), carpometacarpal (CMC), and interphalangeal (IP), which is
// proximal (PIP) or distal (DIP) in fingers. S2 is a paper, listed in docs/architecture.md.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace phalanx {

inline constexpr int kDigits = 5;
inline constexpr int kJointsPerDigit = 4;
inline constexpr int kSegmentsPerDigit = 3;
inline constexpr int kAbductionJoint = 1;  ///< within a digit, the joint that moves it sideways
inline constexpr int kJoints = kDigits * kJointsPerDigit;
inline constexpr int kSegments = kDigits * kSegmentsPerDigit + 1;
/// Number of the palm: the last segment, fixed in the world.
inline constexpr int kPalm = kSegments - 1;

enum class Digit { kThumb, kIndex, kMiddle, kRing, kLittle };
enum class Handedness { kRight, kLeft };

/// Values of all joints, in the order of joint_name(): from thumb to little finger, in each from palm to tip
/// (flexion, abduction, two hinges). Angles are in rad, with flexion and abduction (spreading) positive.
/// Torques are in Nm.
using JointArray = std::array<double, kJoints>;
/// Angles of one digit's joints in the same order [rad].
using DigitAngles = std::array<double, kJointsPerDigit>;

/// Returns the number of joint `i` (0: flexion, 1: abduction, 2 and 3: hinges) of a digit.          S2 fig. 1
[[nodiscard]] constexpr int joint_index(int digit, int i) noexcept { return digit * kJointsPerDigit + i; }
/// Returns the angles of one digit out of the whole hand's [rad]. Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] constexpr DigitAngles digit_angles(const JointArray& angle, int digit) noexcept {
  DigitAngles out{};
  for (int i = 0; i < kJointsPerDigit; ++i)
    out[static_cast<std::size_t>(i)] = angle[static_cast<std::size_t>(joint_index(digit, i))];
  return out;
}
/// Returns the number of segment `k` (0: nearest the palm, 2: distal) of a digit.
[[nodiscard]] constexpr int segment_index(int digit, int k) noexcept { return digit * kSegmentsPerDigit + k; }
[[nodiscard]] constexpr int digit_of_joint(int joint) noexcept { return joint / kJointsPerDigit; }
/// Returns the digit of a segment, or -1 for the palm.
[[nodiscard]] constexpr int digit_of_segment(int segment) noexcept {
  return segment == kPalm ? -1 : segment / kSegmentsPerDigit;
}
/// Returns the segment (0 to 2) of a digit that joint `i` moves. Both axes of a finger's MCP joint (the
/// thumb's CMC joint) move the first segment.
[[nodiscard]] constexpr int segment_in_digit_of_joint(int i) noexcept { return i < 2 ? 0 : i - 1; }
/// Returns how many of a digit's joints, counted from the palm, move its segment k: 2, 3 or 4.
[[nodiscard]] constexpr int joints_that_move(int k) noexcept { return k + 2; }

/// A digit's chain turns about six axes, numbered from palm to tip: the metacarpal's, flexion, abduction,
/// pronation, hinge, hinge. Four are its joints. The metacarpal's and pronation are coupled: they follow from
/// the joints' angles (DigitCoupling).
inline constexpr int kAxesPerDigit = 6;
inline constexpr int kMetacarpalAxis = 0;
inline constexpr int kPronationAxis = 3;
/// Returns the number of the axis of a digit's joint `i`.
[[nodiscard]] constexpr int axis_of_joint(int i) noexcept { return i < 2 ? i + 1 : i + 2; }
/// Returns how many of a digit's axes, counted from the palm, move its segment k: 4, 5 or 6.
[[nodiscard]] constexpr int axes_that_move(int k) noexcept { return k + 4; }

/// Returns the name of a joint in files: "index_mcp_flexion", ... Real-time.
/// @pre 0 <= joint < kJoints
[[nodiscard]] std::string_view joint_name(int joint) noexcept;
/// Returns the WebXR hand joint name of the segment's frame: "index-finger-phalanx-proximal", ... The
/// palm's is "wrist". Real-time.
/// @pre 0 <= segment < kSegments
[[nodiscard]] std::string_view segment_name(int segment) noexcept;
/// Returns "thumb", "index", "middle", "ring" or "little". Real-time.
/// @pre 0 <= digit < kDigits
[[nodiscard]] std::string_view digit_name(int digit) noexcept;
/// Returns the joint or the segment of this name, if there is one. Real-time.
[[nodiscard]] std::optional<int> find_joint(std::string_view name) noexcept;
[[nodiscard]] std::optional<int> find_segment(std::string_view name) noexcept;

}  // namespace phalanx
