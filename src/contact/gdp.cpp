// SPDX-License-Identifier: Apache-2.0
#include "phalanx/contact/gdp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "contact/containment.h"
#include "contact/gdp_digit.h"
#include "contact/normal_fan.h"
#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

std::string millimetres(double metres) { return std::to_string(metres * 1e3) + " mm"; }

}  // namespace

void AngleRing::push(const DigitAngles& angle) noexcept {
  angle_[idx(next_)] = angle;
  next_ = (next_ + 1) % kCapacity;
  size_ = std::min(size_ + 1, kCapacity);
}

const DigitAngles& AngleRing::back(int age) const noexcept {
  return angle_[idx((next_ - 1 - age + 2 * kCapacity) % kCapacity)];
}

SegmentTrees make_segment_trees(const HandModel& hand) {
  SegmentTrees trees;
  for (int s = 0; s < kSegments; ++s) trees[idx(s)] = SegmentTree(hand.mesh(s));
  return trees;
}

GdpState::GdpState(const ContactModel& model)
    : angle(model.hand.parameters().open_angle), hcp_angle(angle), scratch(model.trees) {
  model.hand.poses(angle, poses);
  if (model.parameters.mode == ContactMode::kSliding)
    for (NearPairs& of_segment : near) of_segment.candidates().allocate();
  const double margin = model.parameters.margin;
  const Containment& containment = model.object.containment();
  for (int s = 0; s < kSegments; ++s) {
    const bool palm = s == kPalm;
    const Pose& X = palm ? model.hand.palm_pose()
                         : poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
    const PlacedSegment placed{model.trees[idx(s)], X, scratch};
    const std::string name =
        std::string(palm ? "the palm (" : "the open hand (") + std::string(segment_name(s)) + ")";
    const std::string remedy =
        "; move the object or the hand (objects.N.position_mm, hand.position_mm) so that they are apart";
    const double apart = distance(placed, model.object.tree(), 2.0 * margin);
    if (!(apart > 0.0) || containment.with(model.hand.mesh(s), X)) {
      throw std::invalid_argument(name + " goes through the object" + remedy);
    }
    if (!palm && apart <= margin) {
      throw std::invalid_argument(name + " is " + millimetres(apart) +
                                  " from the object, within the margin of " + millimetres(margin) + remedy);
    }
    if (palm && apart <= margin) {
      const ContactPatch patch = contact_patch(placed, model.object, 2.0 * margin);
      ContactRecord& touching = record[idx(s)];
      touching.active = true;
      touching.p_S = X.inverse() * patch.on_segment;
      touching.p_gdp = touching.p_hcp = patch.on_segment;
      touching.n_c = touching.force_normal = patch.direction;
    }
  }
}

double deepest(double closing, double end) noexcept {
  return closing > 0.0 && closing > 2.0 * end ? closing * closing / (4.0 * (closing - end)) : end;
}

void measure(const ContactModel& model, const DigitTick& tick, int k, const DigitAngles& hcp_angle,
             const DigitPose& hcp, ContactRecord& record) noexcept {
  record.p_gdp = tick.pose.segment[idx(k)] * record.p_S;
  record.p_hcp = hcp.segment[idx(k)] * record.p_S;
  record.penetration = (record.p_gdp - record.p_hcp).dot(record.n_c);
  if (record.along) {
    DigitAngles way{};
    for (std::size_t i = 0; i < way.size(); ++i) way[i] = hcp_angle[i] - tick.angle[i];
    const SegmentMotion motion = segment_motion(model.hand, tick.digit, tick.pose, way, k);
    record.penetration = deepest(-record.n_c.dot(motion.velocity(record.p_gdp)), record.penetration);
  }
  record.depth = record.penetration - record.offset;
}

void follow(const ContactModel& model, const DigitTick& tick, int k, ContactRecord& record) noexcept {
  const Vec3 apart = record.p_gdp - record.p_hcp;
  const double before = record.penetration;
  measure(model, tick, k, tick.hcp, tick.hcp_pose, record);
  if (!record.fades || record.offset == 0.0) return;
  const double deeper = record.penetration - before;
  const double way = (record.p_gdp - record.p_hcp - apart).norm();
  double offset = std::max(0.0, record.offset - kFade * std::max(0.0, way - std::max(0.0, deeper)));
  if (!(record.penetration > 0.0)) {
    offset = 0.0;
  } else if (deeper < 0.0) {
    offset *= record.penetration / before;
  }
  record.offset = offset;
  record.depth = record.penetration - offset;
}

bool nearer_pushes(const ContactModel& model, const DigitTick& tick, int k, const DigitAngles& hcp_angle,
                   const DigitPose& hcp, const GdpState& state) noexcept {
  for (int nearer = 0; nearer < k; ++nearer) {
    ContactRecord record = record_of(state, tick, nearer);
    if (!record.active) continue;
    measure(model, tick, nearer, hcp_angle, hcp, record);
    if (record.depth > 0.0) return true;
  }
  return false;
}

namespace {

/// @returns true if a segment of the digit at its measured angles crosses the object's surface. The palm is
/// outside the object, so that some segment crosses wherever the digit is inside.
bool hcp_goes_through(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  if (tick.hcp_through == Through::kUnknown) {
    tick.hcp_through = Through::kNo;
    for (int k = 0; k < kSegmentsPerDigit && tick.hcp_through == Through::kNo; ++k) {
      const SegmentTree& tree = model.trees[idx(segment_index(tick.digit, k))];
      if (crosses({tree, tick.hcp_pose.segment[idx(k)], state.scratch}, model.object.tree()))
        tick.hcp_through = Through::kYes;
    }
  }
  return tick.hcp_through == Through::kYes;
}

/// Sets d0 of a new record, made at s of the tick. See docs/architecture.md "The GDP, exactly", 3 and Hops.
void set_offset(const ContactModel& model, const DigitTick& tick, int k, double s, const GdpState& state,
                ContactRecord& record) noexcept {
  if (k == 0 && !tick.lagged) return;
  // The HCP at s decides whether a segment nearer the palm already pushes.
  DigitAngles hcp_angle{};
  for (int i = 0; i < kJointsPerDigit; ++i) {
    hcp_angle[idx(i)] = tick.hcp_from[idx(i)] + s * (tick.hcp[idx(i)] - tick.hcp_from[idx(i)]);
  }
  DigitPose hcp;
  model.hand.digit_pose(tick.digit, hcp_angle, hcp);
  const bool pushed = nearer_pushes(model, tick, k, hcp_angle, hcp, state);
  if (!pushed && !tick.lagged) return;
  measure(model, tick, k, hcp_angle, hcp, record);
  record.offset = std::max(0.0, record.penetration - tick.pushed[idx(k)]);
  record.fades = !(pushed && nearer_pushes(model, tick, k, tick.hcp, tick.hcp_pose, state));
}

}  // namespace

int joints_held(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept {
  int held = 0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    ContactRecord& record = record_of(state, tick, k);
    if (!record.active) continue;
    tick.pushed[idx(k)] = record.silent ? 0.0 : std::max(0.0, record.depth);
    record.along = record.along && hcp_goes_through(model, tick, state);
    follow(model, tick, k, record);
    if (record.depth > 0.0) held = joints_that_move(k);
  }
  return held;
}

void make_record(const ContactModel& model, DigitTick& tick, int k, double s, double cap,
                 const SegmentMotion* motion, GdpState& state) noexcept {
  const Pose& gdp = tick.pose.segment[idx(k)];
  const PlacedSegment placed{model.trees[idx(segment_index(tick.digit, k))], gdp, state.scratch};
  const ContactPatch patch =
      contact_patch(placed, model.object, cap, motion, state.near[idx(segment_index(tick.digit, k))]);
  if (patch.pairs == 0) return;
  ContactRecord record;
  record.active = true;
  record.p_S = gdp.R.transpose() * (patch.on_segment - gdp.p);
  record.n_c = patch.direction;
  record.force_normal = model.parameters.normal == ForceNormal::kContact
                            ? patch.direction
                            : within_cone(patch.object_normal, patch.direction);
  if (motion != nullptr && model.parameters.depth == DepthOrigin::kContinuous) {
    measure(model, tick, k, tick.hcp, tick.hcp_pose, record);
    record.along =
        !(record.depth > 0.0) && !patch.lead_direction.isZero(0.0) && hcp_goes_through(model, tick, state);
    if (record.along) {  // the mean of several places may not close
      record.p_S = gdp.R.transpose() * (patch.lead - gdp.p);
      record.n_c = record.force_normal = patch.lead_direction;
    }
  }
  if (model.parameters.depth == DepthOrigin::kContinuous) set_offset(model, tick, k, s, state, record);
  // An exhausted search stopped before anything was near. With an infinite d0 the record neither pushes nor
  // holds; the next tick continues the search.
  if (has(tick.status, Status::kSearchExhausted) && patch.distance > model.parameters.margin) {
    record.offset = std::numeric_limits<double>::infinity();
    record.fades = false;
  }
  record_of(state, tick, k) = record;
}

namespace {

/// Removes the digits' contacts and records when the contact mode changes.
void forget_contacts(ContactMode mode, GdpState& state) noexcept {
  for (int s = 0; s < kPalm; ++s) {
    state.record[idx(s)] = {};
    state.near[idx(s)].clear();
  }
  state.sliding = {};
  state.mode = mode;
}

}  // namespace

Status advance_gdp(const ContactModel& model, const JointArray& hcp_angle, const HandPoses& hcp,
                   const std::array<bool, kDigits>& measured, GdpState& state) noexcept {
  Status status = Status::kOk;
  if (model.parameters.mode != state.mode) forget_contacts(model.parameters.mode, state);
  for (int d = 0; d < kDigits; ++d) {
    DigitTick tick{.digit = d,
                   .hcp_from = digit_angles(state.started[idx(d)] ? state.hcp_angle : hcp_angle, d),
                   .hcp = digit_angles(hcp_angle, d),
                   .hcp_pose = hcp.digit[idx(d)],
                   .angle = digit_angles(state.angle, d),
                   .pose = state.poses.digit[idx(d)]};
    tick.lagged = state.started[idx(d)] && tick.angle != tick.hcp_from;
    const bool sliding = model.parameters.mode == ContactMode::kSliding;
    if (!sliding) tick.fixed = joints_held(model, tick, state);
    if (sliding) {
      advance_sliding(model, tick, state);
    } else if (model.parameters.method == GdpMethod::kContinuous) {
      advance_continuous(model, tick, state);
    } else {
      advance_trajectory(model, tick, state);
    }
    state.poses.digit[idx(d)] = tick.pose;
    for (int i = 0; i < kJointsPerDigit; ++i) state.angle[idx(joint_index(d, i))] = tick.angle[idx(i)];

    const bool clear = tick.angle == tick.hcp;
    state.inside[idx(d)] = !clear && (state.inside[idx(d)] || !state.started[idx(d)]);
    state.started[idx(d)] = state.started[idx(d)] || measured[idx(d)];
    if (state.inside[idx(d)]) tick.status |= Status::kStartInside;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      ContactRecord& record = record_of(state, tick, k);
      if (!record.active) continue;
      if (!sliding) follow(model, tick, k, record);
      record.silent = state.inside[idx(d)];
      const Vec3 apart = record.p_hcp - record.p_gdp;
      record.slid = (apart - apart.dot(record.n_c) * record.n_c).norm();
      if (record.slid > model.parameters.slid_distance) tick.status |= Status::kSlid;
    }
    status |= tick.status;
  }
  state.hcp_angle = hcp_angle;

  return status;
}

}  // namespace phalanx
