// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture_moment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx {
namespace {

/// Time of the tick that is shown of a motion with these total forces, a tick a second.
double shown(const std::vector<double>& forces, std::optional<std::uint64_t> at = std::nullopt) {
  PictureMoment moment(forces.size(), std::nullopt, at);
  Snapshot snapshot;
  for (std::size_t tick = 0; tick < forces.size(); ++tick) {
    snapshot.time_s = static_cast<double>(tick);
    snapshot.segment[3].force = forces[tick];
    moment.see(snapshot);
  }
  return moment.snapshot().time_s;
}

TEST(PictureMoment, IsTheTickOfTheLargestTotalForce) {
  EXPECT_EQ(shown({0.0, 1.0, 3.0, 3.0, 2.0}), 2.0);
  EXPECT_EQ(shown({0.0, 0.0, 0.0, 0.0, 2.0}), 4.0);
}

TEST(PictureMoment, IsTheMiddleOfAMotionWithoutForce) {
  EXPECT_EQ(shown({0.0, 0.0, 0.0, 0.0, 0.0}), 2.0);
  EXPECT_EQ(shown({0.0}), 0.0);
}

TEST(PictureMoment, IsTheTickThatIsAskedFor) {
  EXPECT_EQ(shown({0.0, 1.0, 3.0, 3.0, 2.0}, 4), 4.0);
  EXPECT_EQ(shown({0.0, 0.0, 0.0}, 0), 0.0);
}

// The GDP of a fist goes through itself.
TEST(PictureMoment, IsDrawnWithTheDigitsApart) {
  const SceneDescription scene = load_scene("wave");
  const auto model = std::make_unique<HapticModel>(build_model(scene));
  const HandParameters& hand = model->hand.parameters();
  PictureMoment moment(61, DisplayedHand(*model, scene.parameters.contact.margin), 60);
  Snapshot snapshot;
  HandPoses poses;
  for (int tick = 0; tick <= 60; ++tick) {
    snapshot.time_s = tick / 60.0;
    for (int j = 0; j < kJoints; ++j) {
      const bool flexes = j % kJointsPerDigit != kAbductionJoint;
      const double part = flexes ? 0.8 * std::min(1.0, tick / 50.0) : 0.0;
      snapshot.gdp_angle[idx(j)] =
          hand.open_angle[idx(j)] + part * (hand.max_angle[idx(j)] - hand.open_angle[idx(j)]);
    }
    model->hand.poses(snapshot.gdp_angle, poses);
    for (int s = 0; s < kPalm; ++s)
      snapshot.gdp_pose[idx(s)] = poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
    snapshot.gdp_pose[kPalm] = model->hand.palm_pose();
    snapshot.hcp_pose = snapshot.gdp_pose;
    moment.see(snapshot);
  }
  double apart = 0.0;
  for (int s = 0; s < kPalm; ++s)
    apart = std::max(apart, (moment.snapshot().gdp_pose[idx(s)].p - snapshot.gdp_pose[idx(s)].p).norm());
  EXPECT_GT(apart, 2e-3);
  EXPECT_EQ(moment.snapshot().hcp_pose[0].p, moment.snapshot().gdp_pose[0].p) << "nothing is in its way";
}

}  // namespace
}  // namespace phalanx
