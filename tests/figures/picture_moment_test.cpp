// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/picture_moment.h"

#include <gtest/gtest.h>

#include <vector>

namespace phalanx {
namespace {

/// Time of the tick that is shown of a motion with these total forces, a tick a second.
double shown(const std::vector<double>& forces, std::optional<std::uint64_t> at = std::nullopt) {
  PictureMoment moment(forces.size(), at);
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

}  // namespace
}  // namespace phalanx
