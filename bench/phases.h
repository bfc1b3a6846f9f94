// SPDX-License-Identifier: Apache-2.0
// What the hand is doing at a tick, by the GDP's distance and depth after it.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "phalanx/step/haptic_step.h"
#include "replay.h"

namespace phalanx::bench {

enum class Phase {
  kFree,      ///< every moving segment is more than 20 mm from the object
  kNear,      ///< some segment is nearer, none has a contact
  kTouching,  ///< some segment has a contact record, none is more than 3 mm deep
  kDeep,      ///< some segment is more than 3 mm deep
  // Of contacts that slide, in place of the last two:
  kOneSegment,    ///< one segment has a contact
  kFewSegments,   ///< two to five
  kManySegments,  ///< six to ten
  kMostSegments,  ///< eleven to fifteen
};
inline constexpr std::size_t kPhases = 8;
inline constexpr std::array<std::string_view, kPhases> kPhaseName = {
    "free", "near", "touching", "deep", "1 segment", "2 to 5", "6 to 10", "11 to 15"};
inline constexpr double kFreeDistance = 20e-3;  ///< [m]
inline constexpr double kDeepDepth = 3e-3;      ///< [m]

/// One phase a tick of a motion. Set-up only.
/// @param states  replay()'s
/// @param mode    of the replay: contacts that slide are counted
[[nodiscard]] std::vector<Phase> phases_of(const HapticModel& model, const std::vector<GdpValues>& states,
                                           ContactMode mode);

}  // namespace phalanx::bench
