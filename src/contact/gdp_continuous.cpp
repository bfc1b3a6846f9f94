// SPDX-License-Identifier: Apache-2.0
// The continuous GDP: first time of contact along the path from the GDP to the HCP.
#include <algorithm>
#include <cmath>

#include "contact/first_contact.h"
#include "contact/gdp_digit.h"

namespace phalanx {
void advance_continuous(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  const double margin = model.parameters.margin;
  double s = 0.0;
  int evaluations = 0;
  Path path{tick.angle, {}, tick.hcp};
  for (int i = 0; i < kJointsPerDigit; ++i) path.rate[idx(i)] = tick.hcp[idx(i)] - tick.angle[idx(i)];
  while (tick.fixed < kJointsPerDigit) {
    for (int i = 0; i < tick.fixed; ++i) path.rate[idx(i)] = 0.0;
    if (path.first_moving() == kSegmentsPerDigit) break;

    const Stop stop = first_contact(model, path, s, evaluations, tick, state);
    if (stop.segment < 0) break;
    s = stop.s;
    // The segment is blocked, but the HCP has left its record, or d0 leaves no depth and no nearer segment
    // pushes: the contact has hopped. Without a new record a finger in a corner would rest against the second
    // wall without force.
    ContactRecord& record = record_of(state, tick, stop.segment);
    if (record.active) {
      follow(model, tick, stop.segment, record);
      const bool left = record.penetration <= 0.0;
      if (left || (!(record.depth > 0.0) &&
                   !nearer_pushes(model, tick, stop.segment, tick.hcp, tick.hcp_pose, state)))
        record.active = false;
    }
    const bool exhausted = has(tick.status, Status::kSearchExhausted);
    const SegmentMotion motion = segment_motion(model.hand, tick.digit, tick.pose, path.rate, stop.segment);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if (record_of(state, tick, k).active) continue;
      // Segments within the margin get a record. The stopping segment gets one in any case. After an
      // exhausted search it uses its nearest pair alone, because finding what it runs into would
      // need all pairs.
      const bool stopped = k == stop.segment;
      if (!stopped && state.clearance[idx(segment_index(tick.digit, k))].bound() > margin) continue;
      const double cap = stopped && exhausted ? 1.0 : std::nextafter(margin, 1.0);
      make_record(model, tick, k, s, cap, stopped && !exhausted ? &motion : nullptr, state);
    }
    tick.fixed = joints_that_move(stop.segment);
  }
}

}  // namespace phalanx
