// SPDX-License-Identifier: Apache-2.0
// A hand with round numbers, so that answers can be worked out on paper: five straight digits along -Z, 100
// mm apart, the index at x = 0. Flexion turns -Z towards -Y.
#pragma once

#include <numbers>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx::test {

inline constexpr int kIndex = 1;
inline constexpr double kLength1 = 0.040;  ///< proximal [m]
inline constexpr double kLength2 = 0.025;
inline constexpr double kLength3 = 0.020;

inline HandParameters simple_parameters() {
  HandParameters hand;
  hand.name = "simple";
  for (std::size_t d = 0; d < kDigits; ++d) {
    DigitParameters& digit = hand.digits[d];
    digit.base = Vec3(0.1 * (static_cast<double>(d) - 1.0), 0.0, 0.0);
    constexpr double kRight = std::numbers::pi / 2.0;
    digit.dh[0] = {.a = 0.0, .alpha = kRight, .d = 0.0, .theta = 0.0};
    digit.dh[1] = {.a = kLength1, .alpha = -kRight, .d = 0.0, .theta = 0.0};
    digit.dh[2] = {.a = kLength2, .alpha = 0.0, .d = 0.0, .theta = 0.0};
    digit.dh[3] = {.a = kLength3, .alpha = 0.0, .d = 0.0, .theta = 0.0};
    hand.segments[3 * d + 0] = {.length = kLength1, .radius_base = 0.008, .radius_tip = 0.007};
    hand.segments[3 * d + 1] = {.length = kLength2, .radius_base = 0.007, .radius_tip = 0.006};
    hand.segments[3 * d + 2] = {.length = kLength3, .radius_base = 0.006, .radius_tip = 0.005};
  }
  hand.palm = {.length = 0.08,
               .wrist_breadth = 0.06,
               .wrist_thickness = 0.03,
               .knuckle_breadth = 0.08,
               .knuckle_thickness = 0.025,
               .offset = Vec3(0.0, 0.0, 0.15)};
  for (std::size_t j = 0; j < kJoints; ++j) {
    const bool abduction = j % kJointsPerDigit == 1;
    hand.min_angle[j] = abduction ? -0.6 : -0.5;
    hand.max_angle[j] = abduction ? 0.6 : 2.0;
  }
  return hand;
}

/// Couples every digit: the thumb's rotations and the arch's, in all digits together.
inline HandParameters coupled(HandParameters hand) {
  for (DigitParameters& digit : hand.digits) {
    digit.coupling = {
        .pronation_per_flexion = 0.35, .pronation_per_abduction = -0.2, .metacarpal_per_flexion = 0.25};
    digit.metacarpal_base = digit.base + Vec3(0.006, -0.004, 0.050);
    digit.metacarpal_axis = Vec3(-0.9, 0.4, 0.2);
  }
  return hand;
}

inline HandModel simple_hand(Handedness side = Handedness::kRight, const Pose& X_WH = {},
                             int triangles = 2250) {
  return make_hand_model(simple_parameters(), side, X_WH, triangles);
}

/// A model with the parameters of its steps: most tests set up both together.
struct Setup : HapticModel {
  using HapticModel::HapticModel;
  Setup(HapticModel model, const HapticParameters& of_steps)
      : HapticModel(std::move(model)), parameters(of_steps) {}

  HapticParameters parameters;
};

/// Turns every limiter and the stabiliser off, so that the law itself is seen.
inline void turn_limits_off(Setup& model) {
  model.parameters.stabiliser.method = Stabiliser::kNone;
  model.parameters.limits.fingertip_force_enabled = false;
  model.parameters.limits.joint_torque_enabled = false;
  model.parameters.limits.torque_rate_enabled = false;
  model.parameters.limits.joint_speed = kInfinity;
}

inline Pose at(double x, double y, double z) { return Pose{Mat3::Identity(), Vec3(x, y, z)}; }

inline TriangleMesh moved(const TriangleMesh& mesh, const Pose& X) {
  TriangleMesh out;
  append(out, mesh, X);
  return out;
}

/// Angles of the index finger, all other joints open (0).
inline JointArray index_angles(double mcp, double pip = 0.0, double dip = 0.0, double abduction = 0.0) {
  JointArray q{};
  q[joint_index(kIndex, 0)] = mcp;
  q[joint_index(kIndex, 1)] = abduction;
  q[joint_index(kIndex, 2)] = pip;
  q[joint_index(kIndex, 3)] = dip;
  return q;
}

/// Feeds samples one tick apart.
class Runner {
 public:
  explicit Runner(const Setup& model) : model_(model), state_(model, model.parameters) {}

  const Snapshot& tick(const JointArray& angle) {
    time_ += 1.0 / model_.parameters.rate_hz;
    step(model_, model_.parameters, Sample{time_, angle}, state_);
    return state_.snapshot();
  }
  /// `ticks` equal steps from the last angles to `angle`.
  const Snapshot& move(const JointArray& angle, int ticks) {
    const JointArray from = state_.snapshot().hcp_angle;
    for (int i = 1; i <= ticks; ++i) {
      JointArray q{};
      for (std::size_t j = 0; j < kJoints; ++j)
        q[j] = i == ticks ? angle[j] : from[j] + (angle[j] - from[j]) * i / ticks;
      tick(q);
    }
    return state_.snapshot();
  }
  [[nodiscard]] const Snapshot& now() const { return state_.snapshot(); }

 private:
  const Setup& model_;
  HapticState state_;
  double time_ = 0.0;
};

inline const SegmentSnapshot& index_segment(const Snapshot& s, int k) {
  return s.segment[static_cast<std::size_t>(segment_index(kIndex, k))];
}
inline double index_torque(const Snapshot& s, int i) {
  return s.torque[static_cast<std::size_t>(joint_index(kIndex, i))];
}
inline double index_gdp(const Snapshot& s, int i) {
  return s.gdp_angle[static_cast<std::size_t>(joint_index(kIndex, i))];
}

}  // namespace phalanx::test
