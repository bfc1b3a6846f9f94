// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/haptic_step.h"

#include <algorithm>
#include <utility>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_stage.h"
#include "step/check_parameters.h"
#include "step/sample_guard.h"

namespace phalanx {
namespace {

ContactModel contact_model(const HapticModel& model, const HapticParameters& parameters) noexcept {
  return {model.hand, model.trees(), model.object, parameters.contact, parameters.period()};
}

/// @throws as check_parameters(). @returns its argument
const HapticParameters& checked(const HapticParameters& parameters) {
  check_parameters(parameters);
  return parameters;
}

static_assert(ContactPoints::kMost == kDigits * DigitContacts::kMost);

constexpr double kLeastResultant = 0.1;  // of the sum of a segment's contact points

/// Writes down the contact points of one digit in sliding mode, and what they add up to for its segments.
void record_points(const GdpState& gdp, const ForceState& force, int digit, double coefficient,
                   Snapshot& out) noexcept {
  const DigitContacts& contacts = gdp.sliding[idx(digit)];
  const auto presses = [](const SlidingContact& contact) { return contact.depth[0] > 0.0; };
  std::array<double, kSegmentsPerDigit> size{};  // of the points' depths, added
  for (int c = 0; c < contacts.count; ++c) {
    const SlidingContact& contact = contacts.contact[idx(c)];
    if (presses(contact)) size[idx(contact.k)] += Vec3(contact.depth.data()).norm();
  }
  std::array<double, kSegmentsPerDigit> normal_force{};
  std::array<double, kSegmentsPerDigit> slipping_force{};
  for (int c = 0; c < contacts.count; ++c) {
    const SlidingContact& contact = contacts.contact[idx(c)];
    if (!presses(contact)) continue;
    const int s = segment_index(digit, contact.k);
    const double sent = force.segment[idx(s)].sent;
    const double resultant = std::max(gdp.record[idx(s)].depth, kLeastResultant * size[idx(contact.k)]);
    ContactPoint& at = out.contact_points.point[idx(out.contact_points.count++)];
    at.segment = s;
    at.point = out.gdp_pose[idx(s)] * contact.p_S;
    at.normal = contact.normal;
    at.force = sent * (contact.depth[0] / resultant);
    at.friction = sent * (contact.depth[1] / resultant * contact.tangent[0] +
                          contact.depth[2] / resultant * contact.tangent[1]);
    at.spin = sent * (contact.spin_depth / resultant);
    at.coefficient = coefficient;
    at.slips = contact.slips;

    SegmentSnapshot& segment = out.segment[idx(s)];
    segment.friction += at.friction;
    segment.spin += at.spin * at.normal.dot(gdp.record[idx(s)].n_c);
    normal_force[idx(contact.k)] += contact.depth[0];
    if (contact.slips) slipping_force[idx(contact.k)] += contact.depth[0];
  }
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    out.segment[idx(segment_index(digit, k))].slips = slipping_force[idx(k)] > 0.5 * normal_force[idx(k)];
}

/// Returns the speed of the contact's material point along the surface, from the pose of the last tick [m/s].
double slip_speed(const ContactRecord& contact, const Pose& before, double period) noexcept {
  const Vec3 moved = contact.p_gdp - before * contact.p_S;
  return (moved - moved.dot(contact.n_c) * contact.n_c).norm() / period;
}

/// Writes down what the stages have left behind.
void record(const HapticModel& model, const HapticParameters& parameters, double time_s, const HandPoses& hcp,
            const GdpState& gdp, const ForceState& force, Status status, Snapshot& out) noexcept {
  const StabiliserParameters& stabiliser = parameters.stabiliser;
  const bool sliding = gdp.mode == ContactMode::kSliding;
  ++out.tick;
  out.time_s = time_s;
  out.status = status;
  out.hcp_angle = gdp.hcp_angle;
  out.gdp_angle = gdp.angle;
  out.started_inside = gdp.inside;
  out.torque = force.torque;
  out.stiffness_factor = force.stiffness_factor.value();
  if (stabiliser.method == Stabiliser::kLocalWall) {
    out.wall = force.wall;
    out.wall_valid_for = stabiliser.wall_valid;
  }
  for (std::size_t s = 0; s < kSegments; ++s) {
    const bool palm = s == kPalm;
    const std::size_t d = s / kSegmentsPerDigit;
    const std::size_t k = s % kSegmentsPerDigit;
    const Pose before = out.gdp_pose[s];
    out.hcp_pose[s] = palm ? model.hand.palm_pose() : hcp.digit[d].segment[k];
    out.gdp_pose[s] = palm ? model.hand.palm_pose() : gdp.poses.digit[d].segment[k];

    const ContactRecord& contact = gdp.record[s];
    const SegmentForce& sent = force.segment[s];
    SegmentSnapshot& segment = out.segment[s];
    segment = {};
    segment.contact = contact.active;
    segment.force_raw = sent.raw;
    segment.force = sent.sent;
    if (const OscillationObserver& observer = force.observer[s]; observer.oscillating()) {
      segment.oscillating = true;
      segment.oscillation_frequency = observer.frequency();
      segment.oscillation_swing = observer.swing();
    }
    if (contact.active) {
      segment.depth = contact.depth > 0.0 ? contact.depth : 0.0;
      segment.point = contact.p_gdp;
      segment.normal = sent.normal;
      segment.slid = contact.slid;
      if (sliding) segment.slip_speed = slip_speed(contact, before, parameters.period());
    } else if (sent.sent > 0.0) {
      segment.point = out.gdp_pose[s] * sent.p_S;
      segment.normal = sent.normal;
    }
  }
  out.contact_points.count = 0;
  for (int d = 0; d < kDigits && sliding; ++d) record_points(gdp, force, d, parameters.contact.friction, out);
}

}  // namespace

HapticModel::HapticModel(HandModel hand_model, ObjectModel object_model)
    : hand(std::move(hand_model)),
      object(std::move(object_model)),
      trees_(std::make_unique<const SegmentTrees>(make_segment_trees(hand))) {}

HapticModel::HapticModel(HapticModel&&) noexcept = default;
HapticModel& HapticModel::operator=(HapticModel&&) noexcept = default;
HapticModel::~HapticModel() = default;

struct HapticState::Stages {
  Stages(const HapticModel& model, const HapticParameters& parameters)
      : guard(model.hand.parameters().open_angle), gdp(contact_model(model, parameters)) {}

  SampleGuard guard;
  HandPoses hcp;
  GdpState gdp;
  ForceState force;
};

HapticState::HapticState(const HapticModel& model, const HapticParameters& parameters)
    : stages_(std::make_unique<Stages>(model, checked(parameters))) {
  model.hand.poses(model.hand.parameters().open_angle, stages_->hcp);
  record(model, parameters, 0.0, stages_->hcp, stages_->gdp, stages_->force, Status::kOk, snapshot_);
  snapshot_.tick = 0;
}

HapticState::HapticState(HapticState&&) noexcept = default;
HapticState& HapticState::operator=(HapticState&&) noexcept = default;
HapticState::~HapticState() = default;

Status step(const HapticModel& model, const HapticParameters& parameters, const Sample& sample,
            HapticState& state) noexcept {
  auto& [guard, hcp, gdp, force] = *state.stages_;
  Status status = guard.accept(sample, model.hand.parameters(), parameters.limits, parameters.period());
  pass_measured(sample, status, state.snapshot_);
  model.hand.poses(guard.angle(), hcp);
  status |= advance_gdp(contact_model(model, parameters), guard.angle(), hcp, guard.measured(), gdp);
  status |= compute_command(parameters, gdp, hcp, guard.stale(), force);
  record(model, parameters, guard.time_s(), hcp, gdp, force, status, state.snapshot_);
  return status;
}

}  // namespace phalanx
