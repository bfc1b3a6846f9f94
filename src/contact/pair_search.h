// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contact/first_contact.h"
#include "phalanx/contact/pair_list.h"

namespace phalanx {

/// A moving segment and the object.
struct PairSearch {
  PlacedSegment segment;
  const ObjectTree& object;
  SegmentMotion motion;
  StopBand band;
};

/// Appends the pairs of the digit's segment k that may come within the margin before s reaches `horizon`, all
/// due at s. Where the list runs over, those that are safe for longest are dropped.
/// @param s  of the segment's pose
/// @returns the horizon up to which the list is complete. Real-time.
[[nodiscard]] double gather_pairs(const PairSearch& search, double s, double horizon, int k,
                                  PairList& list) noexcept;

/// Finds out how far each pair of the segment k that is due (or, by choice, every pair) may go on.
/// @returns whether one of them blocks the segment. Real-time.
[[nodiscard]] bool evaluate_pairs(const PairSearch& search, double s, double horizon, int k, bool all,
                                  PairList& list) noexcept;

/// The s at which the next pair is due; 1e300 if there is none. Real-time.
[[nodiscard]] double least_until(const PairList& list) noexcept;
/// Whether a pair may be within the margin at the horizon. Real-time.
[[nodiscard]] bool any_near(const PairList& list) noexcept;

}  // namespace phalanx
