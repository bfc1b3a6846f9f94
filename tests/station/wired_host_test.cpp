// SPDX-License-Identifier: Apache-2.0
// A StationHost with the reference controller on the other end of a wire: the calibration wizard, and a
// device that goes away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "device/link/controller_thread.h"
#include "station/host_fixture.h"

namespace phalanx {
namespace {

using test::ControllerThread;
using test::HostTest;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Step = CalibrationSession::Step;

/// Its raw values rise for ever, whatever pose is asked for: nothing can be calibrated by it, and a station
/// ends in a fault after a while.
class WiredHostTest : public HostTest {
 protected:
  void connect() {
    StationHostSettings settings = with(controller->address(), "grasp_teapot");
    settings.overrides = {{"limits.joint_torque_nm", "0.4"}, {"limits.torque_rate_nm_per_s", "80"}};
    settings.write_calibration = [this](const Calibration&) -> std::string {
      ++written;
      throw std::runtime_error("the disk is full");
    };
    start(settings);
  }
  void begin() {
    ASSERT_EQ(calibrate(Step::kBegin), "");
    ASSERT_NE(host->state()->wizard, nullptr);
  }

  std::unique_ptr<ControllerThread> controller =
      std::make_unique<ControllerThread>(listen_udp("127.0.0.1:0"), clock);
  int written = 0;
};

TEST_F(WiredHostTest, AWizardWhosePosesFitNothingSaysWhyAndGoesBackToAStation) {
  connect();
  ASSERT_TRUE(until([&] { return host->view().snapshot.tick > 0; }));
  EXPECT_FALSE(move_by(HandSource::kSliders).empty()) << "a device on a wire moves the hand";
  begin();
  EXPECT_FALSE(host->state()->running);
  EXPECT_FALSE(any_torque(host->view()));
  const std::size_t poses = host->state()->wizard->names.size();
  ASSERT_GT(poses, 2U);
  for (std::size_t i = 0; i < poses; ++i) {
    ASSERT_EQ(calibrate(Step::kMeasure), "");
    ASSERT_TRUE(until([&] { return !host->state()->wizard->measuring; }));
    ASSERT_EQ(host->state()->trouble, "");
  }
  const auto end = host->state()->wizard;
  EXPECT_EQ(end->pose, poses);
  EXPECT_FALSE(end->finished);
  EXPECT_THAT(end->problems, Not(IsEmpty()));
  EXPECT_THAT(calibrate(Step::kWrite), HasSubstr("not finished"));
  EXPECT_EQ(written, 0);
  EXPECT_NE(host->state()->wizard, nullptr) << "what was measured is still there";
  EXPECT_FALSE(calibrate(Step::kGoTo, 999).empty());
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  EXPECT_EQ(host->state()->wizard, nullptr);
  EXPECT_TRUE(until([&] { return host->state()->running && host->view().snapshot.tick > 0; }));
}

TEST_F(WiredHostTest, NothingElseChangesWhileACalibrationIsOn) {
  connect();
  begin();
  const auto before = host->state();
  EXPECT_THAT(set({{"force.stiffness_n_per_mm", "0.9"}}), HasSubstr("calibration"));
  EXPECT_THAT(set({{"rate_hz", "250"}}), HasSubstr("calibration"));
  EXPECT_THAT(load("pinch_ball"), HasSubstr("calibration"));
  EXPECT_THAT(calibrate(Step::kBegin), HasSubstr("calibration"));
  host->reset();
  host->resume();
  pass(0.3);
  EXPECT_FALSE(host->state()->running);
  EXPECT_EQ(host->state()->overrides, before->overrides);
  EXPECT_NE(host->state()->wizard, nullptr);
  host->stop();
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  pass(0.5);
  EXPECT_TRUE(host->held_stopped());
  EXPECT_EQ(host->view().factor, 0.0);
}

TEST_F(WiredHostTest, ADeviceLostDuringACalibrationIsSaidAndItCanBeAbandoned) {
  connect();
  begin();
  controller->restart();  // it knows nothing of our session any more
  EXPECT_TRUE(until([&] { return !host->state()->trouble.empty(); }));
  EXPECT_NE(host->state()->wizard, nullptr);
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  EXPECT_EQ(host->state()->trouble, "");
  EXPECT_TRUE(host->state()->running);
}

TEST_F(WiredHostTest, ADeviceThatDoesNotOpenAgainIsTroubleUntilAReset) {
  connect();
  const std::string address = controller->after_scheme();
  ASSERT_TRUE(until([&] { return host->view().snapshot.tick > 0; }));
  controller.reset();
  const auto before = host->state();
  EXPECT_FALSE(set({{"rate_hz", "250"}}).empty());
  EXPECT_FALSE(host->state()->running);
  EXPECT_FALSE(host->state()->trouble.empty());
  EXPECT_FALSE(any_torque(host->view()));
  EXPECT_EQ(host->state()->overrides, before->overrides) << "what was refused is not kept";
  EXPECT_EQ(host->state()->scene, before->scene);
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock);
  for (int i = 0; i < 100; ++i) host->reset();
  EXPECT_TRUE(until([&] { return host->state()->running; }));
  EXPECT_EQ(host->state()->trouble, "");
  EXPECT_EQ(host->state()->geometry->rate_hz, 200.0);
}

}  // namespace
}  // namespace phalanx
