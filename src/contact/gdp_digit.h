// SPDX-License-Identifier: Apache-2.0
// What both ways of finding the GDP share: one digit's view of the state.
#pragma once

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"

namespace phalanx {

/// Whether a digit goes through the object: asked at most once a tick, and in few ticks.
enum class Through { kUnknown, kNo, kYes };

/// One digit while its tick is being worked out.
struct DigitTick {
  int digit;
  DigitAngles hcp_from;  ///< q_hcp of the last tick [rad]
  DigitAngles hcp;       ///< q_hcp of this tick [rad]
  const DigitPose& hcp_pose;
  DigitAngles angle;                               ///< q_gdp [rad]
  DigitPose pose;                                  ///< at `angle`
  bool lagged = false;                             ///< the GDP was not at the HCP when the tick began
  std::array<double, kSegmentsPerDigit> pushed{};  ///< d of each segment's record then, 0 without a force [m]
  int fixed = 0;  ///< joints counted from the palm that may not move any more in this tick
  Status status = Status::kOk;
  Through hcp_through = Through::kUnknown;
};

[[nodiscard]] inline const ContactRecord& record_of(const GdpState& state, const DigitTick& tick,
                                                    int k) noexcept {
  return state.record[idx(segment_index(tick.digit, k))];
}
[[nodiscard]] inline ContactRecord& record_of(GdpState& state, const DigitTick& tick, int k) noexcept {
  return state.record[idx(segment_index(tick.digit, k))];
}

/// Depth and points of a record of segment k between the GDP and the HCP `hcp_angle`, whose pose is `hcp`.
void measure(const ContactModel& model, const DigitTick& tick, int k, const DigitAngles& hcp_angle,
             const DigitPose& hcp, ContactRecord& record) noexcept;

/// measure() at the end of the tick, after d0 of a record that fades has shrunk by what the HCP has moved
/// since it was last measured: "The GDP, exactly", Hops.
void follow(const ContactModel& model, const DigitTick& tick, int k, ContactRecord& record) noexcept;

/// By how much a d0 that fades shrinks for each length that the contact's point goes on the HCP [-].
inline constexpr double kFade = 0.2;

/// Whether a segment nearer the palm than k pushes between the GDP and the HCP `hcp_angle`, whose pose is
/// `hcp`.
[[nodiscard]] bool nearer_pushes(const ContactModel& model, const DigitTick& tick, int k,
                                 const DigitAngles& hcp_angle, const DigitPose& hcp,
                                 const GdpState& state) noexcept;

/// The deepest place of the parabola that starts at 0, downwards at the rate `closing`, and is `end` deep
/// at 1.
[[nodiscard]] double deepest(double closing, double end) noexcept;

/// The joints that a pushing record (d > 0) holds: up to the most distal such segment.       "The GDP,
/// exactly", 1
[[nodiscard]] int joints_held(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

/// Gives the segment k a record of its contact at `tick.pose`, if anything is closer than `cap`.
/// @param s  when in the tick this happens: 0 at its start, 1 at its end; decides the offset d0
/// @param motion  how the segment was moving, for the one that stopped: what it moves into decides; else null
void make_record(const ContactModel& model, DigitTick& tick, int k, double s, double cap,
                 const SegmentMotion* motion, GdpState& state) noexcept;

/// Moves one digit. "The GDP, exactly", 2-4.
void advance_continuous(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

/// Moves one digit as S1 fig. 4 says.
void advance_trajectory(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

}  // namespace phalanx
