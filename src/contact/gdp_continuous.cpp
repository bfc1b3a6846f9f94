// SPDX-License-Identifier: Apache-2.0
// The continuous GDP: first time of contact along the path from the GDP to the HCP.
#include <algorithm>
#include <cmath>

#include "contact/gdp_digit.h"

namespace phalanx {
namespace {

/// For all stops of a digit in one tick. A dozen is common, grazing takes a hundred; beyond it the digit
/// stops early and says so.
constexpr int kMaxIterations = 1000;

/// The straight line in joint space that the free joints follow; fixed joints have rate 0.
struct Path {
  DigitAngles from;  ///< at s = 0 [rad]
  DigitAngles rate;  ///< dq/ds [rad]

  [[nodiscard]] DigitAngles at(double s, const DigitAngles& end, const DigitAngles& now,
                               int fixed) const noexcept {
    DigitAngles q = now;
    for (int i = fixed; i < kJointsPerDigit; ++i)
      q[idx(i)] = s >= 1.0 ? end[idx(i)] : from[idx(i)] + s * rate[idx(i)];
    return q;
  }
};

/// Velocity and bounds of the digit's segment k at `pose` when joints move at `rate`.
/// With w_j = |rate_j| and R_jk the farthest that segment k reaches from joint j:
///   |dx/ds|   <= sum_j w_j R_jk
///   |d2x/ds2| <= sum_j w_j (2 R_jk sum_{i<j} w_i + sum_{i>=j} w_i R_ik)
SegmentMotion motion_of(const HandModel& hand, const DigitTick& tick, const DigitAngles& rate,
                        int k) noexcept {
  SegmentMotion motion;
  double turned_before = 0.0;
  double speed_from_here = 0.0;
  for (int j = 0; j < joints_that_move(k); ++j)
    speed_from_here += std::abs(rate[idx(j)]) * hand.reach(tick.digit, j, k);
  motion.speed = speed_from_here;
  for (int j = 0; j < joints_that_move(k); ++j) {
    const JointAxis& joint = tick.pose.joint[idx(j)];
    const double w = std::abs(rate[idx(j)]);
    const double reach = hand.reach(tick.digit, j, k);
    motion.angular += rate[idx(j)] * joint.axis;
    motion.linear -= rate[idx(j)] * joint.axis.cross(joint.centre);
    motion.acceleration += w * (2.0 * reach * turned_before + speed_from_here);
    turned_before += w;
    speed_from_here -= w * reach;
  }
  motion.acceleration = std::max(0.0, motion.acceleration);
  return motion;
}

/// First segment that moves; kSegmentsPerDigit if none does.
int first_moving(const DigitAngles& rate) noexcept {
  for (int i = 0; i < kJointsPerDigit; ++i) {
    if (rate[idx(i)] != 0.0) return segment_in_digit_of_joint(i);
  }
  return kSegmentsPerDigit;
}

struct Stop {
  double s = 1.0;
  int segment = -1;  ///< most distal blocked segment; -1: the end of the path was reached
};

/// Advances tick.angle from s to the first stop.
Stop next_stop(const ContactModel& model, const Path& path, double s, int& iterations, DigitTick& tick,
               GdpState& state) noexcept {
  const StopBand band = stop_band(model.parameters.margin);
  const int first = first_moving(path.rate);
  while (iterations++ < kMaxIterations) {
    place_digit(model, first, tick, state);
    double step = 1.0 - s;
    bool near = false;
    int blocked = -1;
    for (int k = first; k < kSegmentsPerDigit; ++k) {
      const Advance advance =
          safe_advance(state.placed[idx(segment_index(tick.digit, k))], model.object.tree(),
                       motion_of(model.hand, tick, path.rate, k), step, band);
      if (advance.blocked) {
        blocked = k;  // the most distal one decides: S1's sequence priority
      } else {
        step = std::min(step, advance.step);
      }
      near = near || advance.near;
    }
    if (blocked >= 0) return {s, blocked};
    if (s >= 1.0) return {1.0, -1};
    const bool last = step >= 1.0 - s;
    const double from = s;
    s = last ? 1.0 : s + step;
    tick.angle = path.at(s, tick.hcp, tick.angle, tick.fixed);
    for (int k = first; k < kSegmentsPerDigit; ++k) record_of(state, tick, k).active = false;  // it has moved
    if (last && !near) return {1.0, -1};
    if (!last && !(s > from)) break;  // a step below the resolution of s
  }
  tick.status |= Status::kSearchExhausted;
  return {s, kSegmentsPerDigit - 1};
}

}  // namespace

void advance_continuous(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  const double margin = model.parameters.margin;
  double s = 0.0;
  int iterations = 0;
  Path path{tick.angle, {}};
  for (int i = 0; i < kJointsPerDigit; ++i) path.rate[idx(i)] = tick.hcp[idx(i)] - tick.angle[idx(i)];
  while (tick.fixed < kJointsPerDigit) {
    for (int i = 0; i < tick.fixed; ++i) path.rate[idx(i)] = 0.0;
    if (first_moving(path.rate) == kSegmentsPerDigit) break;

    const Stop stop = next_stop(model, path, s, iterations, tick, state);
    if (stop.segment < 0) break;
    s = stop.s;
    place_digit(model, 0, tick, state);
    // Blocked by something else than its record, which the HCP has left: the contact has hopped. Without this
    // a finger in a corner would rest against the second wall without force.
    ContactRecord& record = record_of(state, tick, stop.segment);
    if (record.active) {
      measure(record, tick.pose.segment[idx(stop.segment)], tick.hcp_pose.segment[idx(stop.segment)]);
      if (record.depth + record.offset <= 0.0) record.active = false;
    }
    const bool exhausted = has(tick.status, Status::kSearchExhausted);
    const SegmentMotion motion = motion_of(model.hand, tick, path.rate, stop.segment);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      if (record_of(state, tick, k).active) continue;
      // Within the margin; the stopping segment itself in any case, wherever a search that gave up has left
      // it: then by its nearest pair alone, for what it runs into would have to be sought among all pairs.
      const bool stopped = k == stop.segment;
      const double cap = stopped && exhausted ? 1.0 : std::nextafter(margin, 1.0);
      make_record(model, tick, k, s, cap, stopped && !exhausted ? &motion : nullptr, state);
    }
    tick.fixed = joints_that_move(stop.segment);
  }
}

}  // namespace phalanx
