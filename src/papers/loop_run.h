// SPDX-License-Identifier: Apache-2.0
// Trials of one scene over many seeds, and the curves of the first, for the figures of S2.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/hand/joints.h"
#include "phalanx/scene/scene.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"

namespace phalanx {

/// Curves of one trial, with one value for each step of the host.
struct LoopCurves {
  std::vector<double> time_s;
  std::array<std::vector<double>, kSegments> force;  ///< sent [N]
  std::array<std::vector<double>, kSegments>
      position;  ///< of the HCP's contact point along n, into the object, from its first contact on [m]
  std::vector<int> touching;  ///< segments that ever had a force, by increasing index
};

/// Time at which the on-line observer fired, and the time at which it should have.
struct Detection {
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  /// Onset of the swing [s]. From then on, a segment's force repeatedly swings by more than 0.5 N and back
  /// within 125 ms (8 Hz), for at least 200 ms.
  double swung_s = kNever;
  double fired_s = kNever;  ///< first time at which the snapshot reported `oscillating` [s]
};

/// Trials of one scene.
struct LoopRun {
  std::string name;  ///< "without smoothing"
  double stiffness = 0.0;
  std::vector<TrialResult> trials;  ///< seeds 1, 2, ..
  std::vector<Detection> detections;
  LoopCurves curves;        ///< curves of seed 1
  JointArray unrendered{};  ///< of seed 1: largest torque of each joint that the motors could not exert [Nm]

  [[nodiscard]] int stable() const;    ///< number of seeds that are stable and valid
  [[nodiscard]] int unstable() const;  ///< number of seeds that swing by more than the criterion,
                                       ///< valid or not
  [[nodiscard]] double largest_force_swing() const;
  [[nodiscard]] double largest_position_swing() const;
};

/// Runs seeds 1 .. `seeds` on all cores.
/// @throws as SceneFile::scene() and make_trial_setup().
[[nodiscard]] LoopRun run_loop(const std::string& name, const std::string& scene, const Overrides& overrides,
                               int seeds);

}  // namespace phalanx
