// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/haptic_step.h"

#include <optional>
#include <utility>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_stage.h"
#include "step/check_parameters.h"
#include "step/contact_points.h"
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

/// Writes down what the stages have left behind.
void record(const HapticModel& model, const HapticParameters& parameters, double time_s, const HandPoses& hcp,
            const GdpState& gdp, const ForceState& force, Status status, Snapshot& out) noexcept {
  const StabiliserParameters& stabiliser = parameters.stabiliser;
  std::optional<LastHand> last;
  if (gdp.mode == ContactMode::kSliding) last.emplace(out);
  ++out.tick;
  out.time_s = time_s;
  out.status = status;
  out.hcp_angle = gdp.hcp_angle;
  out.gdp_angle = gdp.angle;
  for (std::size_t d = 0; d < kDigits; ++d) out.opening[d] = force.opening[d].now();
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
    } else if (sent.sent > 0.0) {
      segment.point = out.gdp_pose[s] * sent.p_S;
      segment.normal = sent.normal;
    }
  }
  out.contact_points.count = 0;
  if (last) record_contact_points(parameters, gdp, force, *last, out);
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

bool HapticState::confirm_opening(int digit) noexcept {
  return digit >= 0 && digit < kDigits && stages_->force.opening[idx(digit)].confirm();
}

void HapticState::withdraw_openings() noexcept {
  for (OpeningState& opening : stages_->force.opening) opening.withdraw();
}

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
