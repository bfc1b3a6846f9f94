// SPDX-License-Identifier: Apache-2.0
// Local walls under the host's limits, in closed loop: whatever acts, no motor draws the finger into the
// object, and no joint gets more than its limit.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "phalanx/scene/scene_trial.h"
#include "phalanx/simulation/closed_loop/trial.h"
#include "phalanx/simulation/simulated_exoskeleton.h"

namespace phalanx {
namespace {

constexpr double kSceneStiffness = std::numeric_limits<double>::quiet_NaN();

struct Seen {
  double least_force = 0.0;  ///< along the press; below 0 it pulls in [N]
  double most_torque = 0.0;  ///< of any joint [Nm]
  int limited = 0;           ///< steps in which a torque limiter acted
  int walls = 0;             ///< steps with a wall
};

Seen press(const Overrides& limits, double stiffness) {
  Overrides set = {{"stabiliser.method", "\"local_wall\""}, {"patient.bump_n", "10"}};
  set.insert(set.end(), limits.begin(), limits.end());
  const auto setup = make_trial_setup(load_scene("stability_press", set));
  const JointArray& g = setup->plan.digit[static_cast<std::size_t>(Digit::kIndex)]->g;
  Seen seen;
  static_cast<void>(run_trial(*setup, stiffness, kSceneStiffness, 1,
                              [&](double, const Snapshot& snapshot, const SimulatedExoskeleton& device) {
                                double along = 0.0, size = 0.0;
                                for (std::size_t j = 0; j < kJoints; ++j) {
                                  along += g[j] * device.rendered().torque[j];
                                  size += g[j] * g[j];
                                  seen.most_torque =
                                      std::max(seen.most_torque, std::abs(device.rendered().torque[j]));
                                }
                                seen.least_force = std::min(seen.least_force, along / size);
                                if (has(snapshot.status, Status::kTorqueLimited | Status::kTorqueRateLimited))
                                  ++seen.limited;
                                for (const LocalWall& wall : snapshot.wall) seen.walls += wall.active ? 1 : 0;
                              }));
  return seen;
}

TEST(WallLimits, NeverDrawTheFingerInWhereTheTorqueIsLimited) {
  for (const double k : {1000.0, 2000.0, 3000.0}) {
    const Seen seen = press({{"limits.joint_torque_nm", "0.05"}}, k);
    EXPECT_GT(seen.limited, 100) << k;
    EXPECT_GT(seen.walls, 10) << k;
    EXPECT_GE(seen.least_force, -1e-9) << k;
    EXPECT_LE(seen.most_torque, 0.05 + 1e-9) << k;
  }
}

TEST(WallLimits, NeverDrawTheFingerInWhereTheTorqueRateIsLimited) {
  for (const double k : {2000.0, 3000.0}) {
    const Seen seen = press({{"limits.torque_rate_nm_per_s", "1"}}, k);
    EXPECT_GT(seen.limited, 10) << k;
    EXPECT_GT(seen.walls, 10) << k;
    EXPECT_GE(seen.least_force, -1e-9) << k;
  }
}

}  // namespace
}  // namespace phalanx
