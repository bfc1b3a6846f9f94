// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/poses_csv.h"

#include <gmock/gmock.h>

#include <numbers>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::read_file;
using ::testing::StartsWith;
using testing::TemporaryFolder;

TEST(PosesCsv, HasOneRowPerSegmentOfBothHandsAtEveryTick) {
  const TemporaryFolder folder;
  PosesCsv csv(folder / "poses.csv");
  Snapshot snapshot;
  snapshot.tick = 3;
  snapshot.hcp_pose[0].p = Vec3(0.25, -0.5, 1.0);
  // Half a turn about z, by hand: q = (0, 0, 0, 1); the matrix is exact.
  snapshot.gdp_pose[kPalm].R = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  csv.write(snapshot);
  csv.commit();
  const std::string text = read_file(folder / "poses.csv");
  EXPECT_THAT(text, StartsWith("tick,segment,hand,px,py,pz,qw,qx,qy,qz\n"
                               "3,thumb-metacarpal,hcp,0.25,-0.5,1,1,0,0,0\n"
                               "3,thumb-phalanx-proximal,hcp,0,0,0,1,0,0,0\n"));
  EXPECT_THAT(text, HasSubstr("\n3,thumb-metacarpal,gdp,0,0,0,1,0,0,0\n"));
  EXPECT_THAT(text, HasSubstr("\n3,wrist,gdp,0,0,0,0,0,0,1\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 2 * kSegments);
}

}  // namespace
}  // namespace phalanx
