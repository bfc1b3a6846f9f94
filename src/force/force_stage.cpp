// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_stage.h"

#include <algorithm>
#include <cmath>

#include "force/wall_stage.h"
#include "phalanx/core/index.h"
#include "phalanx/force/force_law.h"
#include "phalanx/force/stabiliser_methods.h"

namespace phalanx {
namespace {

SegmentForce& force_of(ForceState& state, int digit, int k) noexcept {
  return state.segment[idx(segment_index(digit, k))];
}

/// Closing speed of the record's material point on the HCP, low-passed.
/// @returns the same of this tick alone [m/s]
double update_speed(const ForceModel& model, const ContactRecord& record, const Pose& hcp_before,
                    bool started, SegmentForce& force) noexcept {
  if (!record.active) {
    force.speed = 0.0;
    return 0.0;
  }
  const double speed = started ? record.n_c.dot(hcp_before * record.p_S - record.p_hcp) / model.period : 0.0;
  force.speed += lowpass_gain(model.law.velocity_lowpass_hz, model.period) * (speed - force.speed);
  return speed;
}

/// The direction of the force at this tick. What is not felt may turn at once.
Vec3 direction(const ForceModel& model, const ContactRecord& record, const SegmentForce& force) noexcept {
  if (model.stabiliser.method != Stabiliser::kDirection || force.sent == 0.0) return record.force_normal;
  return turned_direction(force.normal, record.force_normal, model.stabiliser.turn_rate * model.period);
}

/// The factor that brings the vector sum of magnitudes[k] along each segment's normal to at most the cap.
double sum_factor(const std::array<double, kSegmentsPerDigit>& magnitude, int digit, double cap,
                  ForceState& state) noexcept {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < kSegmentsPerDigit; ++k) sum += magnitude[idx(k)] * force_of(state, digit, k).normal;
  const double size = sum.norm();
  return size > cap ? cap / size : 1.0;
}

/// Nothing touches the digit, and what was sent has decayed.
bool is_free(const GdpState& contacts, int digit, ForceState& state) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    if (contacts.record[idx(segment_index(digit, k))].active || force_of(state, digit, k).sent != 0.0)
      return false;
  }
  return true;
}

using DigitInputs = std::array<StabiliserInput, kSegmentsPerDigit>;

/// The law of one contact.
Status apply_law(const ForceModel& model, const ContactRecord& record, const Pose& hcp_before, bool stale,
                 const ForceState& state, SegmentForce& force, StabiliserInput& input) noexcept {
  Status status = Status::kOk;
  input.speed_now = update_speed(model, record, hcp_before, state.started, force);
  input.pressing = record.active && !record.silent && !stale;
  input.speed = force.speed;
  input.depth = record.depth;
  input.sent = force.sent;
  input.period = model.period;
  force.raw = 0.0;
  if (record.active) {
    force.p_S = record.p_S;
    force.normal = direction(model, record, force);
    if (input.pressing)
      force.raw = state.stiffness_factor.value() * law_force(model.law, record.depth, force.speed);
  }
  input.force = std::isfinite(force.raw) ? force.raw : 0.0;
  if (!std::isfinite(force.raw)) status |= Status::kCommandNotFinite;
  return status;
}

constexpr double kNoDifference = 1e-6;  // what nobody feels [N]

/// The stabiliser of one contact on the capped force of its law, and the cap on what it may have added. A cap
/// that changes nothing that is sent, as while smoothing still climbs towards it, has not acted.
double stabilise(const ForceModel& model, const StabiliserInput& by_law, double capped_force,
                 StabiliserMemory& memory, Status& status) noexcept {
  StabiliserInput input = by_law;
  input.force = capped_force;
  StabiliserMemory without_cap = memory;
  const double force = stabilised_force(model.stabiliser, model.smoothing, input, memory);
  if (capped_force < by_law.force) {
    const double uncapped = stabilised_force(model.stabiliser, model.smoothing, by_law, without_cap);
    if (std::abs(force - uncapped) > kNoDifference) status |= Status::kForceLimited;
  }
  const bool capped = model.limits.fingertip_force_enabled && !keeps_below_law(model.stabiliser.method);
  if (!capped || !(force > model.limits.fingertip_force)) return force;
  status |= Status::kForceLimited;
  return model.limits.fingertip_force;
}

/// The forces of one digit: law -> fingertip cap -> stabiliser -> cap.
Status digit_forces(const ForceModel& model, const GdpState& contacts, int digit, bool stale,
                    ForceState& state) noexcept {
  Status status = Status::kOk;
  const bool capped = model.limits.fingertip_force_enabled;
  const double cap = model.limits.fingertip_force;
  std::array<double, kSegmentsPerDigit> magnitude{};
  DigitInputs input;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    status |= apply_law(model, contacts.record[idx(segment_index(digit, k))],
                        state.hcp_before.digit[idx(digit)].segment[idx(k)], stale, state,
                        force_of(state, digit, k), input[idx(k)]);
    magnitude[idx(k)] = capped ? std::min(cap, input[idx(k)].force) : input[idx(k)].force;
  }
  const double before = capped ? sum_factor(magnitude, digit, cap, state) : 1.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    magnitude[idx(k)] =
        stabilise(model, input[idx(k)], before * magnitude[idx(k)], force_of(state, digit, k).memory, status);
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

/// Watches what the digit's segments are sent.
/// @returns kOscillating where one of them oscillates; sets `swings` where one of those has fired, or would
/// have again
Status watch(const ForceModel& model, int digit, ForceState& state, bool& swings) noexcept {
  Status status = Status::kOk;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    OscillationObserver& observer = state.observer[idx(segment_index(digit, k))];
    const double sent = force_of(state, digit, k).sent;
    if (sent == 0.0 && observer.idle()) continue;
    const bool fired = observer.watch(sent, model.oscillation.swing, model.period);
    if (!observer.oscillating()) continue;
    status |= Status::kOscillating;
    swings = swings || fired;
  }
  return status;
}

/// Forgets the contacts of a free digit, and watches on until no verdict is left.
Status come_to_rest(const ForceModel& model, int digit, ForceState& state, bool& swings) noexcept {
  for (int k = 0; k < kSegmentsPerDigit; ++k) force_of(state, digit, k) = {};
  clear_walls(digit, state);
  const Status status = watch(model, digit, state, swings);
  bool rest = true;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    rest = rest && state.observer[idx(segment_index(digit, k))].idle();
  state.resting[idx(digit)] = rest;
  return status;
}

/// torque limit -> torque-rate limit -> finite check, for one joint.
Status limited_torque(const ForceModel& model, double wanted, double& commanded) noexcept {
  Status status = Status::kOk;
  const LimitParameters& limits = model.limits;
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
    const double step = limits.torque_rate * model.period;
    const double limited = std::clamp(torque, commanded - step, commanded + step);
    if (limited != torque) status |= Status::kTorqueRateLimited;
    torque = limited;
  }
  commanded = torque;
  return status;
}

}  // namespace

void add_torques(const DigitPose& pose, int digit, int k, const Vec3& p_W, const Vec3& f_W,
                 JointArray& torque) noexcept {
  for (int i = 0; i < joints_that_move(k); ++i) {
    const JointAxis& joint = pose.joint[idx(i)];
    torque[idx(joint_index(digit, i))] += joint.axis.dot((p_W - joint.centre).cross(f_W));
  }
}

Status compute_command(const ForceModel& model, const GdpState& contacts, const HandPoses& hcp, bool stale,
                       ForceState& state) noexcept {
  Status status = Status::kOk;
  JointArray wanted{};
  bool swings = false;
  const bool walls = model.stabiliser.method == Stabiliser::kLocalWall;
  for (int d = 0; d < kDigits; ++d) {
    if (is_free(contacts, d, state) && !(walls && remembers_walls(d, state))) {  // most digits at most ticks
      if (!state.resting[idx(d)]) status |= come_to_rest(model, d, state, swings);
      continue;
    }
    state.resting[idx(d)] = false;
    status |= digit_forces(model, contacts, d, stale, state);
    status |= watch(model, d, state, swings);
    if (walls) make_walls(model, contacts, hcp, d, stale, state);
    const DigitPose& gdp = contacts.poses.digit[idx(d)];
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentForce& force = force_of(state, d, k);
      if (force.sent == 0.0) continue;
      add_torques(gdp, d, k, gdp.segment[idx(k)] * force.p_S, force.sent * force.normal, wanted);
    }
  }
  for (std::size_t j = 0; j < kJoints; ++j) {
    const Status limited = limited_torque(model, wanted[j], state.torque[j]);
    status |= limited;
    // A wall says what the command holds of its contact: of a limited torque nobody can say that.
    if (walls && limited != Status::kOk) withhold_walls(digit_of_joint(static_cast<int>(j)), state);
  }
  if (model.oscillation.reaction == OscillationReaction::kHalve)
    state.stiffness_factor.advance(swings, model.period);
  state.hcp_before = hcp;
  state.started = true;
  return status;
}

}  // namespace phalanx
