// SPDX-License-Identifier: Apache-2.0
// The contacts of one digit as walls for the device's controller.
#pragma once

#include "phalanx/force/force_stage.h"

namespace phalanx {

/// Fills the digit's walls from forces that digit_forces() has just computed; a contact that has just let go
/// stays a wall of force 0 as long as the finger is within 10 mm above and 3 mm beside it, for 0.25 s at
/// most. Real-time: O(1), no allocation.
void make_walls(const ForceModel& model, const GdpState& contacts, const HandPoses& hcp, int digit,
                bool stale, ForceState& state) noexcept;

/// Whether a contact of the digit that has let go is still kept.
[[nodiscard]] bool remembers_walls(int digit, const ForceState& state) noexcept;

/// No wall of the digit is sent at this tick; what is remembered of them stays.
void withhold_walls(int digit, ForceState& state) noexcept;

void clear_walls(int digit, ForceState& state) noexcept;

}  // namespace phalanx
