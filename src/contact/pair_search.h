// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contact/first_contact.h"
#include "phalanx/contact/pair_list.h"

namespace phalanx {

/// Moving segment and object: input of the pair search.
struct PairSearch {
  PlacedSegment segment;
  const ObjectTree& object;
  SegmentMotion motion;
  StopBand band;
};

/// Appends the pairs of the digit's segment k that may come within the margin before s reaches `horizon`, all
/// due at s. If the list is full, the pairs that are safe for longest are dropped.
/// @param s  path parameter of the segment's pose
/// @returns the horizon up to which the list is complete
/// Real-time: no allocation, lock, throw or I/O.
[[nodiscard]] double gather_pairs(const PairSearch& search, double s, double horizon, int k,
                                  PairList& list) noexcept;

/// Appends those candidates of the digit's segment k that may come within the margin before s reaches `horizon`, all
/// due at s.
/// @pre the candidates cover the margin and the segment's way up to the horizon at its pose. Real-time.
void gather_candidates(const PairSearch& search, double s, double horizon, double reach,
                       CandidatePairs& candidates, PairList& list) noexcept;

/// Computes how far each due pair of segment k, or every pair if `all` is set, may advance.
/// @returns true if one of them blocks the segment. Real-time.
[[nodiscard]] bool evaluate_pairs(const PairSearch& search, double s, double horizon, int k, bool all,
                                  PairList& list) noexcept;

/// @returns true if a pair of those near the segment at its pose blocks it.
/// @pre `near` holds all pairs within the margin. Real-time.
[[nodiscard]] bool is_blocked(const PairSearch& search, const NearPairs& near) noexcept;

/// Returns the s at which the next pair is due, or 1e300 if the list is empty. Real-time.
[[nodiscard]] double least_until(const PairList& list) noexcept;
/// @returns true if a pair may be within the margin at the horizon. Real-time.
[[nodiscard]] bool any_near(const PairList& list) noexcept;

}  // namespace phalanx
