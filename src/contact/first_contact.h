// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contact/gdp_digit.h"

namespace phalanx {

/// Distances at which a segment stops [m].
struct StopBand {
  double margin;  ///< a pair at this distance or less that closes stops the segment
  double floor;   ///< no pair comes nearer than this; below the margin by less than 10 nm
};
/// Returns the stop band of a margin [m].
[[nodiscard]] constexpr StopBand stop_band(double margin) noexcept { return {margin, margin - 5e-9}; }

/// Straight line in joint space that the free joints follow; fixed joints have rate 0.
struct Path {
  DigitAngles from;  ///< at s = 0 [rad]
  DigitAngles rate;  ///< dq/ds [rad]
  DigitAngles end;   ///< at s = 1 [rad]
  /// The near pairs of the segments at s = 0 (GdpState::near) are the pairs to search, where they suffice.
  bool near_known = false;

  /// Returns the digit's angles at s [rad]: for s >= 1 exactly `end`; joints before `fixed` stay at `now`.
  [[nodiscard]] DigitAngles at(double s, const DigitAngles& now, int fixed) const noexcept;
  /// Returns the first segment that moves, or kSegmentsPerDigit if none does.
  [[nodiscard]] int first_moving() const noexcept;
};

/// End of a motion along the path.
struct Stop {
  double s = 1.0;
  int segment = -1;  ///< most distal blocked segment; -1: the path's end was reached
};

/// Moves the digit along its path from s to the first stop: where a pair of triangles is within the margin
/// and closing. Sets tick.angle and tick.pose to the stop, and removes the records of segments that move.
/// The method is conservative advancement of each pair by itself. Let a corner be at height z above the plane
/// between a pair's closest points, close at speed v and recede with acceleration a. Over a step h it keeps
/// at least z - v h + a h^2 / 2 - J h^3 / 6. See docs/contact.md.
/// @param evaluations  number of poses evaluated in this tick. At kMaxEvaluations the digit stops early with
/// kSearchExhausted, and the result is its most distal segment. A segment that is blocked where it last
/// stopped (GdpState::near) is found without a pose.
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] Stop first_contact(const ContactModel& model, const Path& path, double s, int& evaluations,
                                 DigitTick& tick, GdpState& state) noexcept;

/// Limit of evaluated poses for all stops of a digit in one tick.
inline constexpr int kMaxEvaluations = 1000;

}  // namespace phalanx
