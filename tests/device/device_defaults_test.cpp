// SPDX-License-Identifier: Apache-2.0
// Default values of what devices say and of what files say of them.
#include <gtest/gtest.h>

#include "phalanx/device/calibration.h"
#include "phalanx/device/device.h"
#include "phalanx/device/exoskeleton.h"
#include "phalanx/simulation/press_plan.h"

namespace phalanx {
namespace {

TEST(DeviceDefaults, ASampleThatNobodyFillsIsOfADeviceThatConnects) {
  const DeviceSample sample;
  EXPECT_EQ(sample.sequence, 0U);
  EXPECT_EQ(sample.time_us, 0U);
  EXPECT_EQ(sample.received, 0.0);
  EXPECT_EQ(sample.state, DeviceState::kConnecting);
  EXPECT_EQ(sample.fault, Fault::kNone);
  EXPECT_EQ(sample.fault_channel, -1);
  EXPECT_FALSE(sample.estop);
  EXPECT_EQ(sample.factor, 0.0);
  EXPECT_EQ(sample.acted_tick, 0U);
}

TEST(DeviceDefaults, ACoupledJointGoesOneToOne) {
  const CoupledJoint joint;
  EXPECT_EQ(joint.joint, 0);
  EXPECT_EQ(joint.of, 0);
  EXPECT_EQ(joint.ratio, 1.0);
  EXPECT_EQ(joint.offset, 0.0);
}

TEST(DeviceDefaults, APressAndACalibratedChannelBeginWithNothing) {
  const DigitPress press;
  EXPECT_EQ(press.segment, 0);
  EXPECT_EQ(press.stiffness, 0.0);
  const CalibratedChannel channel;
  EXPECT_EQ(channel.residual, 0.0);
  EXPECT_TRUE(channel.poses.empty());
}

}  // namespace
}  // namespace phalanx
