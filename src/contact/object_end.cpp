// SPDX-License-Identifier: Apache-2.0
#include "contact/object_end.h"

#include <algorithm>

#include "contact/first_contact.h"

namespace phalanx {
namespace {

constexpr double kLeastDepth = 1e-3;  // below it the measured finger is not looked for beyond [m]
constexpr double kLookEvery = 4e-3;   // [s]
constexpr double kSpeed = 1.0;        // of the shown finger on its way round, of any of its points [m/s]
constexpr double kLongest = 0.5;      // of the search and the way round [s]
constexpr int kMostPoses = 200;       // that the search of one leg evaluates
/// Way round: out from where the digit is held, across to beside the measured posture, and back to that.
struct Way {
  double open;   ///< share of the way to the open hand, on the way out
  double aside;  ///< change of the abduction, on the way out and across [rad]
};
constexpr std::array<Way, 8> kWays = {
    {{0.0, 0.0}, {0.3, 0.0}, {0.6, 0.0}, {1.0, 0.0}, {0.3, 0.3}, {0.3, -0.3}, {1.0, 0.3}, {1.0, -0.3}}};

/// @returns true if all segments of the measured digit are clear of the object's surface. The chain begins outside, so
/// that none is then inside.
bool is_clear(const ContactModel& model, const DigitTick& tick, GdpState& state) noexcept {
  bool clear = true;
  for (int k = kSegmentsPerDigit - 1; k >= 0 && clear; --k) {  // the fingertip is the likeliest to be inside
    const PlacedSegment placed{model.trees[idx(segment_index(tick.digit, k))], tick.hcp_pose.segment[idx(k)],
                               state.scratch};
    const double margin = model.parameters.margin;
    const ObjectTree& object = model.object.tree();
    // In a segment that crosses the object distance_bound() may look at hundreds of pairs. Where crosses() is undecided,
    // as near many slivers, it is true: the digit is held on.
    clear = !crosses(placed, object) && (distance_bound(placed, object, 2.0 * margin) > margin ||
                                         distance(placed, object, 2.0 * margin) > margin);
  }
  return clear;
}

/// Looks whether the measured digit is clear while a contact holds the shown one, and lets forces fade while it is.
/// @returns true if they have
bool has_passed_the_end(const ContactModel& model, const DigitTick& tick, GdpState& state) noexcept {
  DigitContacts& contacts = state.sliding[idx(tick.digit)];
  double deepest = 0.0;
  for (int c = 0; c < contacts.count; ++c)
    deepest = std::max(deepest, contacts.depth_per_multiplier * contacts.contact[idx(c)].multiplier[0]);
  if (!(deepest > kLeastDepth)) {
    contacts.unchecked_for = 0.0;
    contacts.beyond = false;
  } else if ((contacts.unchecked_for += model.period) >= kLookEvery) {
    contacts.unchecked_for = 0.0;
    contacts.beyond = is_clear(model, tick, state);
  }
  contacts.beyond_for = std::clamp(contacts.beyond_for + (contacts.beyond ? model.period : -model.period),
                                   0.0, DigitContacts::kFadeTime);
  return contacts.beyond_for >= DigitContacts::kFadeTime;
}

void forget_bounds(const DigitTick& tick, GdpState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const std::size_t s = idx(segment_index(tick.digit, k));
    state.clearance[s] = {};
    state.near[s].clear();
  }
}

/// Ends the way round. Shows the digit where it is measured, unless that is not clear of the object any more. Then the
/// digit stays, touches what it meets from the next tick on, and its forces rise as they have faded.
void end_detour(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  DigitContacts& contacts = state.sliding[idx(tick.digit)];
  const bool clear = is_clear(model, tick, state);
  contacts = {};
  if (clear) {
    tick.angle = tick.hcp;
    tick.pose = tick.hcp_pose;
  } else {
    contacts.beyond_for = DigitContacts::kFadeTime;
  }
  forget_bounds(tick, state);
}

/// Moves the digit along a straight line in joint space up to the first stop.
/// @param poses  greatest number of poses that are evaluated
Stop move_straight(const ContactModel& model, const DigitAngles& to, int poses, DigitTick& tick,
                   GdpState& state) noexcept {
  Path path{tick.angle, {}, to};
  for (std::size_t i = 0; i < to.size(); ++i) path.rate[i] = to[i] - tick.angle[i];
  int evaluations = kMaxEvaluations - poses;
  return tick.angle == to ? Stop{} : first_contact(model, path, 0.0, evaluations, tick, state);
}

/// @returns true if the digit may go from one posture to another on a straight line in joint space
bool is_free(const ContactModel& model, const DigitAngles& from, const DigitAngles& to, const DigitTick& tick,
             GdpState& state) noexcept {
  DigitTick probe = tick;
  probe.angle = from;
  model.hand.digit_pose(tick.digit, from, probe.pose);
  forget_bounds(tick, state);
  const Stop stop = move_straight(model, to, kMostPoses, probe, state);
  forget_bounds(tick, state);
  return stop.segment < 0 && probe.angle == to;
}

/// Returns the posture, turned to the way's side.
DigitAngles turned_aside(const ContactModel& model, const DigitTick& tick, const Way& way,
                         DigitAngles angle) noexcept {
  const HandParameters& hand = model.hand.parameters();
  const std::size_t joint = idx(joint_index(tick.digit, kAbductionJoint));
  double& abduction = angle[kAbductionJoint];
  if (way.aside != 0.0)
    abduction = std::clamp(abduction + way.aside, hand.min_angle[joint], hand.max_angle[joint]);
  return angle;
}

/// Returns the posture to which a way leads out.
DigitAngles way_out(const ContactModel& model, const DigitTick& tick, const Way& way) noexcept {
  DigitAngles angle = tick.angle;
  for (int i = 0; i < kJointsPerDigit; ++i) {
    const double open = model.hand.parameters().open_angle[idx(joint_index(tick.digit, i))];
    angle[idx(i)] += way.open * (open - angle[idx(i)]);
  }
  return turned_aside(model, tick, way, angle);
}

/// Looks at one leg of one way. @returns false if no way is left
bool look_at_next_leg(const ContactModel& model, const DigitTick& tick, GdpState& state) noexcept {
  DigitContacts::Detour& detour = state.sliding[idx(tick.digit)].detour;
  const Way& way = kWays[idx(detour.way)];
  const std::array<DigitAngles, 4> stations = {tick.angle, way_out(model, tick, way),
                                               turned_aside(model, tick, way, detour.measured),
                                               detour.measured};
  const std::size_t leg = idx(detour.free_legs);
  if (is_free(model, stations[leg], stations[leg + 1], tick, state)) {
    if (++detour.free_legs < 3) return true;
    detour.phase = DigitContacts::Detour::kOut;
    detour.out = stations[1];
    return true;
  }
  detour.free_legs = 0;
  return ++detour.way < static_cast<int>(kWays.size());
}

/// Returns the posture towards `to` that lies as far on as the digit may go in this tick.
DigitAngles next_posture(const ContactModel& model, const DigitAngles& to, const DigitTick& tick) noexcept {
  DigitAngles change{};
  for (std::size_t i = 0; i < to.size(); ++i) change[i] = to[i] - tick.angle[i];
  double farthest = 0.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    farthest = std::max(farthest, segment_speed(model.hand, tick.digit, change, k));
  if (farthest <= kSpeed * model.period) return to;
  DigitAngles next = tick.angle;
  for (std::size_t i = 0; i < to.size(); ++i) next[i] += kSpeed * model.period / farthest * change[i];
  return next;
}

/// Goes on with the way round. @returns false if it ends here
bool go_on(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  using Detour = DigitContacts::Detour;
  DigitContacts& contacts = state.sliding[idx(tick.digit)];
  Detour& detour = contacts.detour;
  if ((detour.lasts += model.period) > kLongest) return false;
  if ((contacts.unchecked_for += model.period) >= kLookEvery) {
    contacts.unchecked_for = 0.0;
    if (!is_clear(model, tick, state)) return false;
  }
  if (detour.phase == Detour::kLooking) return look_at_next_leg(model, tick, state);
  const DigitAngles goal = detour.phase == Detour::kOut ? detour.out
                           : detour.phase == Detour::kAcross
                               ? turned_aside(model, tick, kWays[idx(detour.way)], tick.hcp)
                               : tick.hcp;
  if (move_straight(model, next_posture(model, goal, tick), kMaxEvaluations, tick, state).segment >= 0)
    return false;
  if (tick.angle == tick.hcp) {
    detour = {};
  } else if (tick.angle == goal) {
    detour.phase = detour.phase == Detour::kOut ? Detour::kAcross : Detour::kBack;
  }
  return true;
}

}  // namespace

bool goes_round(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  using Detour = DigitContacts::Detour;
  DigitContacts& contacts = state.sliding[idx(tick.digit)];
  if (contacts.detour.phase == Detour::kNone) {
    if (!has_passed_the_end(model, tick, state)) return false;
    contacts = {};
    contacts.detour.phase = Detour::kLooking;
    contacts.detour.measured = tick.hcp;
  }
  if (!go_on(model, tick, state)) end_detour(model, tick, state);
  return true;
}

}  // namespace phalanx
