// SPDX-License-Identifier: Apache-2.0
// The method of the paper S1 (docs/architecture.md) to the letter, kept as the papers' row and as a
// comparator. It samples the pose of each tick, so that it can step over thin objects.
#include <algorithm>
#include <cmath>

#include "contact/gdp_digit.h"

namespace phalanx {
namespace {

/// @returns true if segment k at tick.pose touches the object
bool touches(const ContactModel& model, const DigitTick& tick, int k, GdpState& state) noexcept {
  const double cap = std::nextafter(model.parameters.margin, 1.0);
  const PlacedSegment placed{model.trees[idx(segment_index(tick.digit, k))], tick.pose.segment[idx(k)],
                             state.scratch};
  return distance(placed, model.object.tree(), cap) < cap;
}

/// Sets the digit's pose with the joints from tick.fixed on at `angle`.
void pose_at(const ContactModel& model, const DigitAngles& angle, DigitTick& tick) noexcept {
  std::copy(angle.begin() + tick.fixed, angle.end(), tick.angle.begin() + tick.fixed);
  model.hand.digit_pose(tick.digit, tick.angle, tick.pose);
}

}  // namespace

void advance_trajectory(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  AngleRing& recorded = state.recorded[idx(tick.digit)];
  const DigitAngles before = tick.angle;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    // Joints that no pushing record holds follow the HCP, and their records are removed.
    if (joints_that_move(k) > tick.fixed) record_of(state, tick, k).active = false;
  }
  while (tick.fixed < kJointsPerDigit) {
    pose_at(model, tick.hcp, tick);
    int hit = -1;  // S1 fig. 4: distal first, then middle, then proximal
    for (int k = kSegmentsPerDigit - 1; k >= 0 && hit < 0; --k) {
      if (joints_that_move(k) > tick.fixed && touches(model, tick, k, state)) hit = k;
    }
    if (hit < 0) break;

    bool found = false;
    for (int age = 0; age < recorded.size() && !found; ++age) {
      pose_at(model, recorded.back(age), tick);
      found = !touches(model, tick, hit, state);
    }
    if (!found) {
      pose_at(model, before, tick);
      tick.status |= Status::kTrajectoryExhausted;
    }
    // The contact point is where the two are closest at that pose, even if the tick has left them far apart.
    make_record(model, tick, hit, 1.0, 1.0, nullptr, state);
    tick.fixed = joints_that_move(hit);
  }
  recorded.push(tick.hcp);
}

}  // namespace phalanx
