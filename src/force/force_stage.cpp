// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/force_stage.h"

#include <algorithm>
#include <cmath>

#include "phalanx/force/force_law.h"
#include "phalanx/force/smoothing.h"

namespace phalanx {
namespace {

constexpr std::size_t idx(int i) noexcept { return static_cast<std::size_t>(i); }

SegmentForce& force_of(ForceState& state, int digit, int k) noexcept {
  return state.segment[idx(segment_index(digit, k))];
}

/// Closing speed of the record's material point on the HCP, low-passed [m/s].
void update_speed(const ForceModel& model, const ContactRecord& record, const Pose& hcp_before, bool started,
                  SegmentForce& force) noexcept {
  if (!record.active) {
    force.speed = 0.0;
    return;
  }
  const double speed = started ? record.n_c.dot(hcp_before * record.p_S - record.p_hcp) / model.period : 0.0;
  force.speed += lowpass_gain(model.law.velocity_lowpass_hz, model.period) * (speed - force.speed);
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

/// The forces of one digit: law -> fingertip cap -> smoothing.
Status digit_forces(const ForceModel& model, const GdpState& contacts, int digit, bool stale,
                    ForceState& state) noexcept {
  Status status = Status::kOk;
  const bool capped = model.limits.fingertip_force_enabled;
  const double cap = model.limits.fingertip_force;
  std::array<double, kSegmentsPerDigit> target{};
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const ContactRecord& record = contacts.record[idx(segment_index(digit, k))];
    SegmentForce& force = force_of(state, digit, k);
    update_speed(model, record, state.hcp_before.digit[idx(digit)].segment[idx(k)], state.started, force);
    force.raw = 0.0;
    if (record.active) {
      force.p_S = record.p_S;
      force.normal = record.force_normal;
      if (!record.silent && !stale) force.raw = law_force(model.law, record.depth, force.speed);
    }
    target[idx(k)] = std::isfinite(force.raw) ? force.raw : 0.0;
    if (!std::isfinite(force.raw)) status |= Status::kCommandNotFinite;
    if (capped && target[idx(k)] > cap) {
      target[idx(k)] = cap;
      status |= Status::kForceLimited;
    }
  }
  const double before = capped ? sum_factor(target, digit, cap, state) : 1.0;

  std::array<double, kSegmentsPerDigit> sent{};
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    sent[idx(k)] = smoothed_force(model.smoothing, before * target[idx(k)], force_of(state, digit, k).sent,
                                  model.period);
  }
  const double after = capped ? sum_factor(sent, digit, cap, state) : 1.0;
  if (before < 1.0 || after < 1.0) status |= Status::kForceLimited;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    SegmentForce& force = force_of(state, digit, k);
    force.sent = after * sent[idx(k)];
    if (force.sent == 0.0 && !contacts.record[idx(segment_index(digit, k))].active)
      force.normal = Vec3::Zero();
  }
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
  for (int d = 0; d < kDigits; ++d) {
    if (is_free(contacts, d, state)) {  // most digits at most ticks
      for (int k = 0; k < kSegmentsPerDigit; ++k) force_of(state, d, k) = {};
      continue;
    }
    status |= digit_forces(model, contacts, d, stale, state);
    const DigitPose& gdp = contacts.poses.digit[idx(d)];
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentForce& force = force_of(state, d, k);
      if (force.sent == 0.0) continue;
      add_torques(gdp, d, k, gdp.segment[idx(k)] * force.p_S, force.sent * force.normal, wanted);
    }
  }
  for (std::size_t j = 0; j < kJoints; ++j) status |= limited_torque(model, wanted[j], state.torque[j]);
  state.hcp_before = hcp;
  state.started = true;
  return status;
}

}  // namespace phalanx
