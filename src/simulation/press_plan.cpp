// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

bool moves(const Exoskeleton& exoskeleton, int digit) {
  for (const ExoJoint& joint : exoskeleton.joints)
    if (digit_of_joint(joint.joint) == digit) return true;
  return false;
}

DigitPress press_of(const HapticModel& model, const Snapshot& snapshot, int digit, int k,
                    const Exoskeleton& exoskeleton, const PatientParameters& patient) {
  const SegmentSnapshot& contact = snapshot.segment[idx(segment_index(digit, k))];
  DigitPress press;
  press.segment = segment_index(digit, k);
  press.point = contact.point;
  press.p_S = snapshot.gdp_pose[idx(press.segment)].inverse() * contact.point;
  press.normal = contact.normal;
  press.contact = snapshot.gdp_angle;
  DigitPose pose;
  model.hand.digit_pose(digit, digit_angles(snapshot.gdp_angle, digit), pose);
  const PointJacobian jacobian = point_jacobian(pose, k, contact.point);
  JointArray arm{};
  for (int i = 0; i < kJointsPerDigit; ++i)
    arm[idx(joint_index(digit, i))] = contact.normal.dot(jacobian.linear[idx(i)]);
  for (const CoupledJoint& joint : exoskeleton.coupled)
    arm[idx(joint.of)] += joint.ratio * arm[idx(joint.joint)];

  double compliance = 0.0;
  for (const ExoJoint& joint : exoskeleton.joints) {
    const auto j = idx(joint.joint);
    if (digit_of_joint(joint.joint) != digit) continue;
    press.g[j] = arm[j];
    if (patient.stiffness[j] > 0.0) compliance += arm[j] * arm[j] / patient.stiffness[j];
  }
  if (!(compliance > 0.0)) {
    throw std::invalid_argument(
        fmt::format("patient: the {} meets the object, but none of its joints has a stiffness that could "
                    "press; give it one in the "
                    "patient file",
                    digit_name(digit)));
  }
  for (const ExoJoint& joint : exoskeleton.joints) {
    const auto j = idx(joint.joint);
    if (press.g[j] != 0.0 && patient.stiffness[j] > 0.0)
      press.into[j] = -press.g[j] / patient.stiffness[j] / compliance;
  }
  for (const CoupledJoint& joint : exoskeleton.coupled)
    if (digit_of_joint(joint.joint) == digit)
      press.into[idx(joint.joint)] = joint.ratio * press.into[idx(joint.of)];
  press.stiffness = 1.0 / compliance;
  return press;
}

}  // namespace

PressPlan plan_press(const HapticModel& model, const HapticParameters& parameters, const Motion& motion,
                     const Exoskeleton& exoskeleton, const PatientParameters& patient) {
  PressPlan plan;
  plan.open = model.hand.parameters().open_angle;
  bool any = false;
  const auto all = [&] {
    for (int digit = 0; digit < kDigits; ++digit)
      if (moves(exoskeleton, digit) && !plan.digit[idx(digit)]) return false;
    return true;
  };
  const auto watch = [&](const Snapshot& snapshot) {
    for (int digit = 0; digit < kDigits; ++digit) {
      if (plan.digit[idx(digit)] || !moves(exoskeleton, digit)) continue;
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        if (!snapshot.segment[idx(segment_index(digit, k))].contact) continue;
        plan.digit[idx(digit)] = press_of(model, snapshot, digit, k, exoskeleton, patient);
        any = true;
        break;
      }
    }
  };
  // The hand as the host receives it: joints without a sensor stay open, coupled and copied ones follow.
  Motion sensed = motion;
  for (JointArray& angle : sensed.angle) angle = sensed_angles(exoskeleton, plan.open, angle);
  const auto state = std::make_unique<HapticState>(model, parameters);
  const double ticks = std::max(1.0, std::round(sensed.duration() * parameters.rate_hz));
  for (double tick = 0.0; tick < ticks && !all(); tick += 1.0) {
    const double t = tick / parameters.rate_hz;
    step(model, parameters, Sample{.time_s = t, .angle = sensed.at(t)}, *state);
    watch(state->snapshot());
  }
  if (!any)
    throw std::invalid_argument(
        "the motion brings none of the digits that the device moves to the object; change [motion] or the "
        "object's place");
  return plan;
}

}  // namespace phalanx
