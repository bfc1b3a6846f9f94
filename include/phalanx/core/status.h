// SPDX-License-Identifier: Apache-2.0
// Status of one step: bits, not text, so that the loop body allocates nothing. GDP, the graphic display
// position, is the shown hand (docs/glossary.md).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace phalanx {

/// Conditions of one step, one bit each. Several may hold at once.
enum class Status : std::uint32_t {
  kOk = 0,
  kSampleNotFinite = 1U << 0,   ///< an angle was NaN or infinite; its last good value was used
  kSampleOutOfRange = 1U << 1,  ///< an angle was outside the range of motion; it was clamped
  kSampleJump = 1U << 2,  ///< an angle moved faster than limits.joint_speed; it was slewed at that speed
  /// The sample's time did not increase or was not finite. Its angles were not used.
  kTimeNotIncreasing = 1U << 3,
  /// A digit started inside or behind the object, and has not been clear since. It gives no force, unless a person
  /// has confirmed its opening (force/opening.h).
  kStartInside = 1U << 4,
  /// A contact's tangential offset exceeds contact.slid_mm: static grasping no longer holds.
  kSlid = 1U << 5,
  /// The contact search reached a limit of its work and stopped the digit early, without penetration.
  kSearchExhausted = 1U << 6,
  kForceLimited = 1U << 7,       ///< the fingertip cap changed the force sent
  kTorqueLimited = 1U << 8,      ///< the joint torque limit acted
  kTorqueRateLimited = 1U << 9,  ///< the torque-rate limit acted
  kCommandNotFinite = 1U << 10,  ///< a torque was not finite; it was set to zero
  /// GdpMethod::kTrajectory found no free pose among the recorded angles. The GDP kept its pose.
  kTrajectoryExhausted = 1U << 11,
  /// No sample was wholly good for 50 ms. Forces decay to zero until one comes.
  kSampleStale = 1U << 12,
  kOscillating = 1U << 13,  ///< the force of a segment oscillates (force/oscillation.h)
};
inline constexpr int kStatusBits = 14;

[[nodiscard]] constexpr Status operator|(Status a, Status b) noexcept {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Status& operator|=(Status& a, Status b) noexcept { return a = a | b; }
/// @returns true if any bit of `bits` is set in `status`
[[nodiscard]] constexpr bool has(Status status, Status bits) noexcept {
  return (static_cast<std::uint32_t>(status) & static_cast<std::uint32_t>(bits)) != 0;
}

/// Returns the name of bit number `bit` as it appears in files: "sample_not_finite", ...
/// @pre 0 <= bit < kStatusBits
[[nodiscard]] constexpr std::string_view status_name(int bit) noexcept {
  constexpr std::array<std::string_view, kStatusBits> kNames = {
      "sample_not_finite",   "sample_out_of_range", "sample_jump",
      "time_not_increasing", "start_inside",        "slid",
      "search_exhausted",    "force_limited",       "torque_limited",
      "torque_rate_limited", "command_not_finite",  "trajectory_exhausted",
      "sample_stale",        "oscillating"};
  return kNames[static_cast<std::size_t>(bit)];
}

}  // namespace phalanx
