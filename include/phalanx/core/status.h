// SPDX-License-Identifier: Apache-2.0
// What one step wants to be known about itself: bits, never text, so that the loop body stays free of
// allocation.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace phalanx {

/// One bit per condition. Several may hold at once.
enum class Status : std::uint32_t {
  kOk = 0,
  kSampleNotFinite = 1U << 0,   ///< an angle was NaN or infinite; its last good value was used
  kSampleOutOfRange = 1U << 1,  ///< an angle was outside the range of motion; it was clamped
  kSampleJump = 1U << 2,  ///< an angle moved faster than limits.joint_speed; it was slewed at that speed
  kTimeNotIncreasing =
      1U << 3,  ///< the sample's time did not increase (or was not finite); its angles were not used
  kStartInside =
      1U << 4,  ///< a digit started inside (or behind) the object; no force until it has been clear
  kSlid =
      1U << 5,  ///< a contact's tangential offset exceeds contact.slid_mm: static grasping no longer holds
  kSearchExhausted =
      1U << 6,  ///< the advance ran out of iterations and stopped the digit early, without penetration
  kForceLimited = 1U << 7,       ///< the fingertip cap changed what was sent
  kTorqueLimited = 1U << 8,      ///< the joint torque limit acted
  kTorqueRateLimited = 1U << 9,  ///< the torque-rate limit acted
  kCommandNotFinite = 1U << 10,  ///< a torque came out not finite and was set to zero
  kTrajectoryExhausted =
      1U << 11,             ///< gdp.method "trajectory": no free pose among the recorded angles; the GDP held
  kSampleStale = 1U << 12,  ///< no wholly good sample for 50 ms; forces decay to zero until one comes
  kOscillating = 1U << 13,  ///< the force of a segment oscillates (force/oscillation.h)
};
inline constexpr int kStatusBits = 14;

[[nodiscard]] constexpr Status operator|(Status a, Status b) noexcept {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Status& operator|=(Status& a, Status b) noexcept { return a = a | b; }
/// Whether any bit of `bits` is set in `status`.
[[nodiscard]] constexpr bool has(Status status, Status bits) noexcept {
  return (static_cast<std::uint32_t>(status) & static_cast<std::uint32_t>(bits)) != 0;
}

/// Name of bit number `bit` (0 .. kStatusBits-1) as it appears in files: "sample_not_finite", ...
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
