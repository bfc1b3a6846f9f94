// SPDX-License-Identifier: Apache-2.0
// View of one digit's state, shared by both methods of finding the GDP.
#pragma once

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"

namespace phalanx {

/// Result of a test whether a digit goes through the object. It is computed at most once a tick, and
/// in few ticks.
enum class Through { kUnknown, kNo, kYes };

/// State of one digit while its tick is computed.
struct DigitTick {
  int digit;
  DigitAngles hcp_from;  ///< q_hcp of the last tick [rad]
  DigitAngles hcp;       ///< q_hcp of this tick [rad]
  const DigitPose& hcp_pose;
  DigitAngles angle;    ///< q_gdp [rad]
  DigitPose pose;       ///< at `angle`
  bool lagged = false;  ///< the GDP was not at the HCP when the tick began
  /// d of each segment's record at the tick's start, 0 without a force [m].
  std::array<double, kSegmentsPerDigit> pushed{};
  int fixed = 0;  ///< number of joints, counted from the palm, that stay for the rest of the tick
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

/// Computes depth and points of a record of segment k between the GDP and the HCP `hcp_angle`
/// with poses `hcp`.
void measure(const ContactModel& model, const DigitTick& tick, int k, const DigitAngles& hcp_angle,
             const DigitPose& hcp, ContactRecord& record) noexcept;

/// Calls measure() at the end of the tick. Before that, the d0 of a fading record shrinks according to the
/// HCP's motion since the last measurement: docs/architecture.md "The GDP, exactly", Hops.
void follow(const ContactModel& model, const DigitTick& tick, int k, ContactRecord& record) noexcept;

/// Shrinkage of a fading d0 per distance that the contact's point moves on the HCP [-].
inline constexpr double kFade = 0.2;

/// @returns true if a segment nearer the palm than k pushes between the GDP and the HCP `hcp_angle`
/// with poses `hcp`
[[nodiscard]] bool nearer_pushes(const ContactModel& model, const DigitTick& tick, int k,
                                 const DigitAngles& hcp_angle, const DigitPose& hcp,
                                 const GdpState& state) noexcept;

/// Moves the digit in sliding mode and sets its contact points and records.
void advance_sliding(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

/// Returns the greatest depth on [0, 1] of the parabola that starts at 0 with downward rate `closing` and has
/// depth `end` at 1.
[[nodiscard]] double deepest(double closing, double end) noexcept;

/// Returns the number of joints that pushing records (d > 0) hold: those up to the most distal such segment.
/// See docs/architecture.md "The GDP, exactly", 1
[[nodiscard]] int joints_held(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

/// Gives segment k a record of its contact at `tick.pose`, if a pair of triangles is nearer than `cap` [m].
/// @param s       time within the tick, 0 at its start, 1 at its end; determines the offset d0
/// @param motion  motion of the stopped segment, of which only surfaces that it runs into count; else null
void make_record(const ContactModel& model, DigitTick& tick, int k, double s, double cap,
                 const SegmentMotion* motion, GdpState& state) noexcept;

/// Moves one digit. See docs/architecture.md "The GDP, exactly", 2-4.
void advance_continuous(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

/// Moves one digit. S1 fig. 4.
void advance_trajectory(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

}  // namespace phalanx
