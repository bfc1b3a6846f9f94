// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contact/gdp_digit.h"

namespace phalanx {

/// Clearances at which a segment stops [m].
struct StopBand {
  double margin;  ///< a pair at this distance or less that closes is a contact
  double floor;   ///< no pair is let closer than this; below the margin by less than 10 nm
};
[[nodiscard]] constexpr StopBand stop_band(double margin) noexcept { return {margin, margin - 5e-9}; }

/// The straight line in joint space that the free joints follow; fixed joints have rate 0.
struct Path {
  DigitAngles from;  ///< at s = 0 [rad]
  DigitAngles rate;  ///< dq/ds [rad]

  [[nodiscard]] DigitAngles at(double s, const DigitAngles& end, const DigitAngles& now,
                               int fixed) const noexcept;
  /// First segment that moves; kSegmentsPerDigit if none does.
  [[nodiscard]] int first_moving() const noexcept;
};

struct Stop {
  double s = 1.0;
  int segment = -1;  ///< most distal blocked segment; -1: the end of the path was reached
};

/// Moves the digit along its path from s to the first stop: to where a pair of triangles is within the margin
/// and closing. Nothing that moves there keeps a record. tick.angle and tick.pose are left at the stop.
/// Conservative advancement, each pair by itself: over a step h a corner at height z above the plane between
/// a pair's closest points, closing at speed v and receding with acceleration a, keeps at least z - v h + a
/// h^2 / 2 - J h^3 / 6.                                                          docs/contact.md
/// @param evaluations  poses looked at so far in this tick; at kMaxEvaluations the digit stops early, says
///                     kSearchExhausted and returns its most distal segment
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] Stop first_contact(const ContactModel& model, const Path& path, double s, int& evaluations,
                                 DigitTick& tick, GdpState& state) noexcept;

/// For all stops of a digit in one tick.
inline constexpr int kMaxEvaluations = 1000;

}  // namespace phalanx
