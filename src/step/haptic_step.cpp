// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/haptic_step.h"

#include "step/check_parameters.h"

namespace phalanx {
namespace {

ContactModel contact_model(const HapticModel& model, const HapticParameters& parameters) noexcept {
  return {model.hand, model.trees, model.object, parameters.contact};
}

/// @throws as check_parameters(). @returns its argument
const HapticParameters& checked(const HapticParameters& parameters) {
  check_parameters(parameters);
  return parameters;
}

/// Writes down what the stages have left behind.
void record(const HapticModel& model, const StabiliserParameters& stabiliser, double time_s,
            const HandPoses& hcp, const GdpState& gdp, const ForceState& force, Status status,
            Snapshot& out) noexcept {
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
}

}  // namespace

HapticState::HapticState(const HapticModel& model, const HapticParameters& parameters)
    : guard_(model.hand.parameters().open_angle), gdp_(contact_model(model, checked(parameters))) {
  model.hand.poses(model.hand.parameters().open_angle, hcp_);
  record(model, parameters.stabiliser, 0.0, hcp_, gdp_, force_, Status::kOk, snapshot_);
  snapshot_.tick = 0;
}

Status step(const HapticModel& model, const HapticParameters& parameters, const Sample& sample,
            HapticState& state) noexcept {
  Status status =
      state.guard_.accept(sample, model.hand.parameters(), parameters.limits, parameters.period());
  pass_measured(sample, status, state.snapshot_);
  model.hand.poses(state.guard_.angle(), state.hcp_);
  status |= advance_gdp(contact_model(model, parameters), state.guard_.angle(), state.hcp_,
                        state.guard_.measured(), state.gdp_);
  status |= compute_command(parameters, state.gdp_, state.hcp_, state.guard_.stale(), state.force_);
  record(model, parameters.stabiliser, state.guard_.time_s(), state.hcp_, state.gdp_, state.force_, status,
         state.snapshot_);
  return status;
}

}  // namespace phalanx
