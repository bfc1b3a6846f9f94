// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/poses_csv.h"

#include <gmock/gmock.h>

#include <array>
#include <numbers>
#include <sstream>
#include <string>

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

// A turn by 240 degrees about z: cos = -1/2, sin = -sqrt(3)/2. Its quaternion is +-(cos 120, 0, 0, sin 120
// degrees), and the one with qw >= 0 is written: (1/2, 0, 0, -sqrt(3)/2).
TEST(PosesCsv, WritesTheQuaternionWhoseFirstNumberIsNotNegative) {
  const TemporaryFolder folder;
  Snapshot snapshot;
  const double sin240 = -0.5 * std::numbers::sqrt3;
  snapshot.hcp_pose[0].R << -0.5, -sin240, 0.0, sin240, -0.5, 0.0, 0.0, 0.0, 1.0;
  PosesCsv csv(folder / "poses.csv");
  csv.write(snapshot);
  csv.commit();
  std::istringstream lines(read_file(folder / "poses.csv"));
  std::string line;
  std::getline(lines, line);
  std::getline(lines, line);
  ASSERT_THAT(line, StartsWith("0,thumb-metacarpal,hcp,0,0,0,"));
  std::istringstream cells(line.substr(line.find("0,0,0,") + 6));
  std::array<double, 4> q{};  // qw, qx, qy, qz
  char comma = ',';
  cells >> q[0] >> comma >> q[1] >> comma >> q[2] >> comma >> q[3];
  EXPECT_NEAR(q[0], 0.5, 1e-15);
  EXPECT_NEAR(q[1], 0.0, 1e-15);
  EXPECT_NEAR(q[2], 0.0, 1e-15);
  EXPECT_NEAR(q[3], -0.5 * std::numbers::sqrt3, 1e-15);
}

}  // namespace
}  // namespace phalanx
