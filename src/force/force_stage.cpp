// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_stage.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "force/wall_stage.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "phalanx/force/stabiliser_methods.h"

namespace phalanx {
namespace {

SegmentForce& force_of(ForceState& state, int digit, int k) noexcept {
  return state.segment[idx(segment_index(digit, k))];
}

/// Updates the low-passed closing speed of the record's material point on the HCP.
/// @returns the unfiltered closing speed of this tick [m/s]
double update_speed(const HapticParameters& parameters, const ContactRecord& record, const Pose& hcp_before,
                    bool started, SegmentForce& force) noexcept {
  if (!record.active) {
    force.speed = 0.0;
    return 0.0;
  }
  const double speed =
      started ? record.n_c.dot(hcp_before * record.p_S - record.p_hcp) / parameters.period() : 0.0;
  force.speed +=
      lowpass_gain(parameters.force.velocity_lowpass_hz, parameters.period()) * (speed - force.speed);
  return speed;
}

/// Returns the force's direction at this tick. If no force was sent, its rotation is not bounded.
Vec3 direction(const HapticParameters& parameters, const ContactRecord& record,
               const SegmentForce& force) noexcept {
  if (parameters.stabiliser.method != Stabiliser::kDirection || force.sent == 0.0) return record.force_normal;
  return turned_direction(force.normal, record.force_normal,
                          parameters.stabiliser.turn_rate * parameters.period());
}

/// Returns the factor that brings the vector sum of magnitude[k] along each segment's normal to at
/// most the cap.
double sum_factor(const std::array<double, kSegmentsPerDigit>& magnitude, int digit, double cap,
                  ForceState& state) noexcept {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < kSegmentsPerDigit; ++k) sum += magnitude[idx(k)] * force_of(state, digit, k).normal;
  const double size = sum.norm();
  return size > cap ? cap / size : 1.0;
}

/// @returns true if nothing touches the digit and the forces sent have decayed to zero
bool is_free(const GdpState& contacts, int digit, ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    if (contacts.record[idx(segment_index(digit, k))].active || force_of(state, digit, k).sent != 0.0)
      return false;
  }
  return true;
}

/// Advances the opening of a digit that started inside the object.
void advance_opening(const GdpState& contacts, int digit, double period, ForceState& state) noexcept {
  std::optional<double> way;
  double sent = 0.0;
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const ContactRecord& record = contacts.record[idx(segment_index(digit, k))];
    const double apart = (record.p_gdp - record.p_hcp).norm();
    if (record.active && std::isfinite(apart)) way = std::max(way.value_or(0.0), apart);
    const SegmentForce& force = force_of(state, digit, k);
    sent = std::max(sent, force.sent);
    sum += force.sent * force.normal;
  }
  state.opening[idx(digit)].advance(contacts.inside[idx(digit)], way, std::max(sent, sum.norm()), period);
}

using DigitInputs = std::array<StabiliserInput, kSegmentsPerDigit>;

/// Computes the law's force of one contact and the stabiliser's input.
Status apply_law(const HapticParameters& parameters, const ContactRecord& record, const Pose& hcp_before,
                 bool stale, double opening_force, const ForceState& state, SegmentForce& force,
                 StabiliserInput& input) noexcept {
  Status status = Status::kOk;
  input.speed_now = update_speed(parameters, record, hcp_before, state.started, force);
  input.pressing = record.active && !stale && (!record.silent || opening_force > 0.0);
  input.speed = force.speed;
  input.depth = record.depth;
  input.sent = force.sent;
  input.period = parameters.period();
  force.raw = 0.0;
  if (record.active) {
    force.p_S = record.p_S;
    force.normal = direction(parameters, record, force);
    force.couple = record.couple;
    if (input.pressing)
      force.raw = state.stiffness_factor.value() * law_force(parameters.force, record.depth, force.speed);
    if (record.silent) force.raw = std::min(force.raw, opening_force);
  }
  input.force = std::isfinite(force.raw) ? force.raw : 0.0;
  if (!std::isfinite(force.raw)) status |= Status::kCommandNotFinite;
  return status;
}

constexpr double kNoDifference = 1e-6;  // below human perception [N]

/// Returns the stabiliser's force for one contact on the capped force of its law, capped again if the
/// stabiliser added to it. A cap that leaves the force sent unchanged, as while smoothing still rises towards
/// it, is not reported.
double stabilise(const HapticParameters& parameters, const StabiliserInput& by_law, double capped_force,
                 StabiliserMemory& memory, Status& status) noexcept {
  StabiliserInput input = by_law;
  input.force = capped_force;
  StabiliserMemory without_cap = memory;
  const double force = stabilised_force(parameters.stabiliser, input, memory, &status);
  if (capped_force < by_law.force) {
    const double uncapped = stabilised_force(parameters.stabiliser, by_law, without_cap);
    if (std::abs(force - uncapped) > kNoDifference) status |= Status::kForceLimited;
  }
  const bool capped =
      parameters.limits.fingertip_force_enabled && !keeps_below_law(parameters.stabiliser.method);
  if (!capped || !(force > parameters.limits.fingertip_force)) return force;
  status |= Status::kForceLimited;
  return parameters.limits.fingertip_force;
}

/// Computes the forces of one digit: law -> fingertip cap -> stabiliser -> cap. Each cap acts per contact,
/// then on the vector sum.
Status digit_forces(const HapticParameters& parameters, const GdpState& contacts, int digit, bool stale,
                    ForceState& state) noexcept {
  Status status = Status::kOk;
  const DigitOpening& opening = state.opening[idx(digit)].now();
  const bool inside = opening.phase != OpeningPhase::kNone;
  const bool limited = parameters.limits.fingertip_force_enabled;
  const bool capped = limited || inside;
  double cap = limited ? parameters.limits.fingertip_force : opening.force;
  if (inside) cap = std::min(cap, opening.force);
  std::array<double, kSegmentsPerDigit> magnitude{};
  DigitInputs input;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    status |= apply_law(parameters, contacts.record[idx(segment_index(digit, k))],
                        state.hcp_before.digit[idx(digit)].segment[idx(k)], stale, opening.force, state,
                        force_of(state, digit, k), input[idx(k)]);
    magnitude[idx(k)] = capped ? std::min(cap, input[idx(k)].force) : input[idx(k)].force;
  }
  const double before = capped ? sum_factor(magnitude, digit, cap, state) : 1.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    magnitude[idx(k)] = stabilise(parameters, input[idx(k)], before * magnitude[idx(k)],
                                  force_of(state, digit, k).memory, status);
    // A stabiliser may add to the law's force, or decay for a while.
    if (inside) magnitude[idx(k)] = std::min(magnitude[idx(k)], cap);
  }
  const double after = capped ? sum_factor(magnitude, digit, cap, state) : 1.0;
  if (after < 1.0) status |= Status::kForceLimited;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    SegmentForce& force = force_of(state, digit, k);
    force.sent = after * magnitude[idx(k)];
    if (force.sent == 0.0 && !contacts.record[idx(segment_index(digit, k))].active)
      force.normal = Vec3::Zero();
  }
  return status;
}

/// Watches the forces sent to the digit's segments.
/// @param swings  set to true if the detector of an oscillating segment fired in this step
/// @returns kOscillating if one of them oscillates
Status watch(const HapticParameters& parameters, int digit, ForceState& state, bool& swings) noexcept {
  Status status = Status::kOk;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    OscillationObserver& observer = state.observer[idx(segment_index(digit, k))];
    const double sent = force_of(state, digit, k).sent;
    if (sent == 0.0 && observer.idle()) continue;
    const bool fired = observer.watch(sent, parameters.oscillation.swing, parameters.period());
    if (!observer.oscillating()) continue;
    status |= Status::kOscillating;
    swings = swings || fired;
  }
  return status;
}

/// Resets the forces of a free digit, and watches until no verdict is left.
Status come_to_rest(const HapticParameters& parameters, int digit, ForceState& state, bool& swings) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) force_of(state, digit, k) = {};
  clear_walls(digit, state);
  const Status status = watch(parameters, digit, state, swings);
  bool rest = true;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    rest = rest && state.observer[idx(segment_index(digit, k))].idle();
  state.resting[idx(digit)] = rest;
  return status;
}

/// Applies finite check, torque limit and torque-rate limit to one joint.
Status limited_torque(const LimitParameters& limits, double period, double wanted,
                      double& commanded) noexcept {
  Status status = Status::kOk;
  double torque = wanted;
  if (!std::isfinite(torque)) {
    status |= Status::kCommandNotFinite;
    torque = 0.0;
  }
  if (limits.joint_torque_enabled) {
    const double limited = std::clamp(torque, -limits.joint_torque, limits.joint_torque);
    if (limited != torque) status |= Status::kTorqueLimited;
    torque = limited;
  }
  if (limits.torque_rate_enabled) {
    const double step = limits.torque_rate * period;
    const double limited = std::clamp(torque, commanded - step, commanded + step);
    if (limited != torque) status |= Status::kTorqueRateLimited;
    torque = limited;
  }
  commanded = torque;
  return status;
}

}  // namespace

Status compute_command(const HapticParameters& parameters, const GdpState& contacts, const HandPoses& hcp,
                       bool stale, ForceState& state) noexcept {
  Status status = Status::kOk;
  JointArray wanted{};
  bool swings = false;
  const double period = parameters.period();
  const bool walls = parameters.stabiliser.method == Stabiliser::kLocalWall;
  for (int d = 0; d < kDigits; ++d) {
    advance_opening(contacts, d, period, state);
    if (is_free(contacts, d, state) && !(walls && remembers_walls(d, state))) {  // most digits at most ticks
      if (!state.resting[idx(d)]) status |= come_to_rest(parameters, d, state, swings);
      continue;
    }
    state.resting[idx(d)] = false;
    status |= digit_forces(parameters, contacts, d, stale, state);
    status |= watch(parameters, d, state, swings);
    if (walls) make_walls(parameters, contacts, hcp, d, stale, state);
    const DigitPose& gdp = contacts.poses.digit[idx(d)];
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentForce& force = force_of(state, d, k);
      if (force.sent == 0.0) continue;
      add_torques(gdp, d, k, gdp.segment[idx(k)] * force.p_S, force.sent * force.normal, wanted);
      if (!force.couple.isZero(0.0)) add_couple(gdp, d, k, force.sent * force.couple, wanted);
    }
  }
  for (std::size_t j = 0; j < kJoints; ++j) {
    const Status limited = limited_torque(parameters.limits, period, wanted[j], state.torque[j]);
    status |= limited;
    // A wall states its share of the command. After a torque limit this share is undefined.
    if (walls && limited != Status::kOk) withhold_walls(digit_of_joint(static_cast<int>(j)), state);
  }
  if (parameters.oscillation.reaction == OscillationReaction::kHalve)
    state.stiffness_factor.advance(swings, period);
  state.hcp_before = hcp;
  state.started = true;
  return status;
}

}  // namespace phalanx
