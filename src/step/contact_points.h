// SPDX-License-Identifier: Apache-2.0
// What the snapshot holds of sliding mode: contact points, friction and slip.
#pragma once

#include <array>

#include "phalanx/contact/gdp.h"
#include "phalanx/force/force_stage.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// The shown hand of the last tick, from which slip is counted.
struct LastHand {
  explicit LastHand(const Snapshot& last) noexcept : pose(last.gdp_pose) {
    for (std::size_t s = 0; s < in_contact.size(); ++s) in_contact[s] = last.segment[s].contact;
  }

  std::array<Pose, kSegments> pose;  ///< X_WS
  std::array<bool, kSegments> in_contact{};
};

/// Writes the contact points of sliding mode, and what they add up to for their segments. The other fields of
/// `out` are those of this tick, and its list of points is empty. Real-time: O(1), no allocation, lock, throw or
/// I/O.
void record_contact_points(const HapticParameters& parameters, const GdpState& gdp, const ForceState& force,
                           const LastHand& last, Snapshot& out) noexcept;

}  // namespace phalanx
