// SPDX-License-Identifier: Apache-2.0
// Trials of one scene over many seeds, and the curves of the first: what the figures of S2 are made of.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"
#include "phalanx/scene/scene.h"
#include "phalanx/study/closed_loop/trial.h"

namespace phalanx {

/// Curves of one trial, a value for each step of the host.
struct LoopCurves {
  std::vector<double> time_s;
  std::array<std::vector<double>, kSegments> force;  ///< sent [N]
  std::array<std::vector<double>, kSegments>
      position;  ///< of the HCP's contact point along n, into the object, from its first contact on [m]
  std::vector<int> touching;  ///< segments that ever had a force, in their order
};

/// When the on-line observer fired beside when it should have.
struct Detection {
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  /// From when on a segment's force swings by more than 0.5 N and back within 125 ms (8 Hz), again and again
  /// for at least 200 ms [s]
  double swung_s = kNever;
  double fired_s = kNever;  ///< first time at which the snapshot said `oscillating`
};

struct LoopRun {
  std::string name;  ///< "without smoothing"
  double stiffness = 0.0;
  std::vector<TrialResult> trials;  ///< seeds 1, 2, ..
  std::vector<Detection> detections;
  LoopCurves curves;        ///< of seed 1
  JointArray unrendered{};  ///< largest torque of each joint that no motor could render, of seed 1 [Nm]

  [[nodiscard]] int stable() const;    ///< number of seeds that are stable and valid
  [[nodiscard]] int unstable() const;  ///< number of seeds that swing too far, valid or not
  [[nodiscard]] double largest_force_swing() const;
  [[nodiscard]] double largest_position_swing() const;
};

/// Seeds 1 .. `seeds` on all cores. @throws as load_scene() and make_trial_setup().
[[nodiscard]] LoopRun run_loop(const std::string& name, const std::string& scene, const Overrides& overrides,
                               int seeds);

}  // namespace phalanx
