// SPDX-License-Identifier: Apache-2.0
// Our GDP, tick by tick, with what the peers need to begin each tick from our state.
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/gdp.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::bench {

/// The constant side of our contact search.
[[nodiscard]] ContactModel contact_model(const HapticModel& model, const HapticParameters& parameters);

/// What the rules of the GDP speak of, without the scratch memory of a search.
struct GdpValues {
  JointArray angle{};
  HandPoses poses;
  JointArray hcp_angle{};
  std::array<bool, kDigits> started{};
  std::array<bool, kDigits> inside{};
  std::array<ContactRecord, kSegments> record;
};
[[nodiscard]] GdpValues values_of(const GdpState& state);
void set_values(const GdpValues& values, GdpState& state);

/// Every digit has been measured: what step() says from the first whole sample on.
inline constexpr std::array<bool, kDigits> kMeasured = {true, true, true, true, true};

/// A motion played through the GDP alone, at angles that step()'s sample guard lets pass as they are: entry t
/// is the state that tick t began from, the last entry the state at the end.
[[nodiscard]] std::vector<GdpValues> replay(const HapticModel& model, const HapticParameters& parameters,
                                            const std::vector<JointArray>& angle);

/// Plays the motion through step() and holds its GDP against the replay's, bit by bit.
/// @throws std::runtime_error naming the tick at which they part: then the peers would not begin where step()
/// does.
void check_replay(const HapticModel& model, const HapticParameters& parameters,
                  const std::vector<JointArray>& angle, const std::vector<GdpValues>& states);

}  // namespace phalanx::bench
