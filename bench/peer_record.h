// SPDX-License-Identifier: Apache-2.0
// Which of the pairs near a stopped segment is its contact.
#pragma once

#include <vector>

#include "peer_engine.h"
#include "peer_motion.h"

namespace phalanx::bench {

/// Pairs whose distance is within this of the least tie for the contact [m].
inline constexpr double kTie = 5e-6;

/// The contact among `pairs`: the nearest one not farther than `cap`. For the segment that stopped, walls
/// that it does not run into do not count: pairs that face more than 30 degrees away from the fastest closing
/// pair within the cap and close less than half as fast.
/// @param pairs  all pairs up to cap + kTie
/// @param field  how the segment was moving if it is the one that stopped, else null
/// @param tied   becomes the pairs that tie, the nearest one first
/// @returns whether there is any
[[nodiscard]] bool choose_contact(const std::vector<ClosePair>& pairs, double cap, const SegmentField* field,
                                  std::vector<ClosePair>& tied);

}  // namespace phalanx::bench
