// SPDX-License-Identifier: Apache-2.0
// A Session with the reference controller on the other end of a wire: the calibration wizard, and a
// device that goes away.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "device/link/controller_thread.h"
#include "phalanx/core/constants.h"
#include "phalanx/device/calibration_session.h"
#include "phalanx/scene/calibration_file.h"
#include "phalanx/scene/range_file.h"
#include "record/temporary_folder.h"
#include "station/session_fixture.h"

namespace phalanx {
namespace {

using test::ControllerThread;
using test::SessionFixture;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Step = WizardStep::Kind;

/// Its raw values rise for ever, whatever pose is asked for, until they are held: no pose can be measured, and a
/// station ends in a fault after a while.
class WiredSessionTest : public SessionFixture {
 protected:
  void connect(const std::string& scene = "grasp_teapot") {
    SessionSettings settings = with(controller->address(), scene);
    settings.overrides = {{"limits.joint_torque_nm", "0.4"}, {"limits.torque_rate_nm_per_s", "80"}};
    settings.write_calibration = [this](Calibration found) -> std::string {
      ++written;
      if (disk_full) throw std::runtime_error("the disk is full");
      found.date = "2026-05-04T09:30:00Z";
      found.phalanx = "0.1.0";
      const std::string file = folder / "found.toml";
      std::ofstream(file) << calibration_text(found);
      return file;
    };
    settings.write_range = [this](MeasuredRange found) -> std::string {
      found.date = "2026-05-04T09:45:00Z";
      found.phalanx = "0.1.0";
      const std::string file = folder / "range.toml";
      std::ofstream(file) << range_text(found);
      return file;
    };
    start(settings);
  }
  /// The sensors read these angles of their joints [rad], as of a device that says 1 rad too much of each.
  void hold(std::array<double, 2> angle) {
    std::array<std::int32_t, 2> raw{};
    for (std::size_t c = 0; c < raw.size(); ++c)
      raw[c] = static_cast<std::int32_t>(std::lround(1000.0 * (angle[c] + kTooMuch)));
    controller->hold(raw);
    const auto before = session->info()->wizard;
    if (before == nullptr || before->pose == before->names.size()) return;
    ASSERT_TRUE(until([&] {  // what was on its way is no part of the pose
      const auto wizard = session->info()->wizard;
      for (const std::int32_t seen : wizard->raw)
        if (seen != raw[0] && seen != raw[1]) return false;
      return !wizard->raw.empty();
    }));
  }
  void measure() {
    ASSERT_EQ(calibrate(Step::kMeasure), "");
    ASSERT_TRUE(until([&] { return !session->info()->wizard->measuring; }));
    ASSERT_EQ(session->info()->trouble, "");
  }
  /// A wearer goes into every pose.
  void measure_all() {
    const auto state = session->info();
    const HandParameters& hand = state->geometry->hand;
    std::array<double, 2> angle = {hand.open_angle[kJoint[0]], hand.open_angle[kJoint[1]]};
    for (const CalibrationPose& pose : calibration_poses(state->device.channels, hand)) {
      for (std::size_t c = 0; c < angle.size(); ++c) angle[c] = pose.value[c].value_or(angle[c]);
      hold(angle);
      measure();
    }
  }
  void begin() {
    ASSERT_EQ(calibrate(Step::kBegin), "");
    ASSERT_NE(session->info()->wizard, nullptr);
  }

  std::unique_ptr<ControllerThread> controller =
      std::make_unique<ControllerThread>(listen_udp("127.0.0.1:0"), clock);
  static constexpr std::array<std::size_t, 2> kJoint = {4, 6};  ///< of bench_device()
  static constexpr double kTooMuch = 1.0;                       ///< [rad]
  const testing::TemporaryFolder folder;
  int written = 0;
  bool disk_full = false;
};

// The limits that connect() lays over the scene. A sample is not connecting any more once CONFIGURE has come.
TEST_F(WiredSessionTest, TheControllerIsToldTheStationsLimits) {
  connect();
  ASSERT_TRUE(until([&] { return session->view().device != DeviceState::kConnecting; }));
  const phx_controller told = controller->controller();
  EXPECT_TRUE(told.configured);
  EXPECT_EQ(told.configure.torque_limit, 0.4F);
  EXPECT_EQ(told.configure.torque_rate, 80.0F);
}

TEST_F(WiredSessionTest, WhatAWizardHasFoundIsWrittenAndUsedAtOnce) {
  connect();
  begin();
  measure_all();
  ASSERT_TRUE(session->info()->wizard->finished)
      << ::testing::PrintToString(session->info()->wizard->problems);
  disk_full = true;
  EXPECT_THAT(calibrate(Step::kWrite), HasSubstr("the disk is full"));
  ASSERT_NE(session->info()->wizard, nullptr) << "what was measured is still there";
  const HandParameters& hand = session->info()->geometry->hand;
  std::array<double, 2> middle{};
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = 0.5 * (hand.min_angle[kJoint[c]] + hand.max_angle[kJoint[c]]);
  hold(middle);
  disk_full = false;
  const double asked = session->now();
  EXPECT_EQ(calibrate(Step::kWrite), "");
  EXPECT_EQ(written, 2);
  EXPECT_EQ(session->info()->wizard, nullptr);
  EXPECT_EQ(session->info()->calibration, folder / "found.toml");
  EXPECT_TRUE(session->info()->running);
  EXPECT_TRUE(session->held_stopped()) << "motors must not begin by themselves";
  EXPECT_EQ(session->info()->trouble, "");
  ASSERT_TRUE(until([&] {
    const StationView view = session->view();
    return view.time > asked && view.snapshot.tick > 0;
  })) << "until then the last station's is shown";
  for (std::size_t c = 0; c < middle.size(); ++c)
    EXPECT_NEAR(session->view().snapshot.hcp_angle[kJoint[c]], middle[c], 2e-3);
  ASSERT_TRUE(until([&] { return session->view().device != DeviceState::kConnecting; }));
  const phx_controller told = controller->controller();
  for (std::size_t c = 0; c < middle.size(); ++c)
    EXPECT_NEAR(static_cast<double>(told.configure.offset[c]), -kTooMuch, 0.01) << "for its walls";
  // With its file gone neither the new rate nor the old one gets a station: that was tried once.
  std::filesystem::remove(folder / "found.toml");
  ASSERT_NE(session->view().state, SafetyState::kFault) << "which would hold the torque, too";
  const std::uint64_t stops = session->stops();
  EXPECT_THAT(set({{"rate_hz", "250"}}), HasSubstr("found.toml"));
  EXPECT_FALSE(session->info()->running);
  EXPECT_EQ(session->stops(), stops + 1);
}

// The patient reaches 40 degrees of PIP, of the hand's 100 or so.
TEST_F(WiredSessionTest, AWizardMeasuresThePatientsRangeAndTheNextStationHasIt) {
  connect();
  EXPECT_THAT(calibrate(Step::kBeginRange), HasSubstr("not calibrated"));
  EXPECT_TRUE(session->info()->running);
  begin();
  EXPECT_THAT(calibrate(Step::kAccept), HasSubstr("belongs to a patient's range"));
  measure_all();
  ASSERT_EQ(calibrate(Step::kWrite), "");
  EXPECT_EQ(session->info()->range, "");
  ASSERT_EQ(calibrate(WizardStep{.kind = Step::kBeginRange, .patient = "P07"}), "");
  EXPECT_FALSE(session->info()->running);
  EXPECT_EQ(session->info()->wizard, nullptr);
  ASSERT_NE(session->info()->range_wizard, nullptr);
  EXPECT_THAT(set({{"rate_hz", "250"}}), HasSubstr("calibration"));
  EXPECT_THAT(calibrate(Step::kEnter), HasSubstr("belongs to a calibration"));
  EXPECT_THAT(calibrate(Step::kWrite), HasSubstr("no digit's range was accepted"));
  const auto reach = [&] {
    hold({0.2, 2.0 * kDeg});
    ASSERT_EQ(calibrate(Step::kMeasure), "");
    pass(1.0);
    hold({0.9, 40.0 * kDeg});
    pass(1.0);
    ASSERT_EQ(calibrate(Step::kAccept), "");
    EXPECT_TRUE(session->info()->range_wizard->finished);
    ASSERT_EQ(calibrate(Step::kWrite), "");
    EXPECT_TRUE(session->held_stopped());
  };
  reach();
  EXPECT_EQ(session->info()->range_wizard, nullptr);
  EXPECT_TRUE(session->info()->running);
  ASSERT_EQ(session->info()->range, folder / "range.toml");
  const MeasuredRange range = load_range(session->info()->range);
  EXPECT_EQ(range.patient, "P07");
  EXPECT_EQ(range.calibration, "2026-05-04T09:30:00Z");
  ASSERT_TRUE(range.joint[kJoint[1]]);
  EXPECT_NEAR(range.joint[kJoint[1]]->max, 40.0 * kDeg, 3.0 * kDeg);
  EXPECT_NEAR(range.joint[kJoint[1]]->min, 2.0 * kDeg, 3.0 * kDeg);
  // Another calibration may turn every angle: the range is not used with it.
  begin();
  hold({0.2, 0.2});
  ASSERT_EQ(calibrate(Step::kAbandon), "");
  EXPECT_EQ(session->info()->range, folder / "range.toml");
  begin();
  measure_all();
  ASSERT_EQ(calibrate(Step::kWrite), "");
  EXPECT_EQ(session->info()->range, "");
  EXPECT_TRUE(session->info()->running);
  // The next patient has another one, or none.
  EXPECT_THAT(calibrate(Step::kDropRange), HasSubstr("no range of a patient is in force"));
  ASSERT_EQ(calibrate(Step::kBeginRange), "");
  EXPECT_THAT(calibrate(Step::kDropRange), HasSubstr("a calibration is on"));
  reach();
  ASSERT_EQ(session->info()->range, folder / "range.toml");
  EXPECT_TRUE(session->resume(session->stops()));
  EXPECT_EQ(calibrate(Step::kDropRange), "");
  EXPECT_EQ(session->info()->range, "");
  EXPECT_TRUE(session->info()->running);
  EXPECT_TRUE(session->held_stopped()) << "the torque may push further than before";
  EXPECT_TRUE(std::filesystem::exists(folder / "range.toml"));
}

TEST_F(WiredSessionTest, AWizardThatEndsWhereNoStationCanBeMadeSaysWhyAndTheNextOneBeginsStopped) {
  const std::filesystem::path shipped = PHALANX_SOURCE_DIR "/scenes/grasp_teapot.toml";
  const std::string scene = folder / "own.toml";
  std::filesystem::copy_file(shipped, scene);
  connect(scene);
  begin();
  const std::uint64_t before = session->stops();
  std::filesystem::remove(scene);
  const std::string refused = calibrate(Step::kAbandon);
  EXPECT_THAT(refused, HasSubstr("own.toml"));
  EXPECT_EQ(session->info()->wizard, nullptr);
  EXPECT_FALSE(session->info()->running);
  EXPECT_EQ(session->info()->trouble, refused);
  EXPECT_FALSE(session->resume(before));
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(load("grasp_teapot"), "");
  EXPECT_TRUE(session->info()->running);
  EXPECT_TRUE(session->held_stopped());
}

TEST_F(WiredSessionTest, AWizardsWrittenCalibrationIsUsedByTheNextStationIfItsOwnIsRefused) {
  const std::string scene = folder / "own.toml";
  std::filesystem::copy_file(PHALANX_SOURCE_DIR "/scenes/grasp_teapot.toml", scene);
  connect(scene);
  begin();
  measure_all();
  std::filesystem::remove(scene);
  EXPECT_THAT(calibrate(Step::kWrite), HasSubstr("own.toml"));
  EXPECT_EQ(written, 1);
  EXPECT_EQ(session->info()->wizard, nullptr);
  EXPECT_FALSE(session->info()->running);
  EXPECT_EQ(load("grasp_teapot"), "");
  EXPECT_EQ(session->info()->calibration, folder / "found.toml");
  EXPECT_TRUE(session->info()->running);
}

TEST_F(WiredSessionTest, AWizardWhosePosesFitNothingSaysWhyAndGoesBackToAStation) {
  connect();
  ASSERT_TRUE(until([&] { return session->view().snapshot.tick > 0; }));
  EXPECT_FALSE(move_by(HandSource::kSliders).empty()) << "a device on a wire moves the hand";
  begin();
  EXPECT_FALSE(session->info()->running);
  EXPECT_FALSE(any_torque(session->view()));
  const std::size_t poses = session->info()->wizard->names.size();
  ASSERT_GT(poses, 2U);
  EXPECT_EQ(calibrate(Step::kSkip), "");
  EXPECT_EQ(session->info()->wizard->pose, 1U);
  EXPECT_EQ(calibrate(Step::kGoTo, 2), "");
  EXPECT_EQ(session->info()->wizard->pose, 2U);
  for (const std::size_t before : {std::size_t{1}, std::size_t{0}}) {
    EXPECT_EQ(calibrate(Step::kBack), "");
    EXPECT_EQ(session->info()->wizard->pose, before);
  }
  ASSERT_EQ(calibrate(Step::kMeasure), "");
  ASSERT_TRUE(until([&] { return !session->info()->wizard->measuring; }));
  EXPECT_THAT(session->info()->trouble, HasSubstr("moved by")) << "its counts rise";
  EXPECT_EQ(session->info()->wizard->pose, 0U);
  for (std::size_t i = 0; i < poses; ++i) {
    hold({0.1, 0.1});
    measure();
  }
  const auto end = session->info()->wizard;
  EXPECT_EQ(end->pose, poses);
  EXPECT_FALSE(end->finished);
  EXPECT_THAT(end->problems, Not(IsEmpty()));
  EXPECT_THAT(calibrate(Step::kWrite), HasSubstr("not finished"));
  EXPECT_EQ(written, 0);
  EXPECT_NE(session->info()->wizard, nullptr) << "what was measured is still there";
  EXPECT_FALSE(calibrate(Step::kGoTo, 999).empty());
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  EXPECT_EQ(session->info()->wizard, nullptr);
  EXPECT_TRUE(until([&] { return session->info()->running && session->view().snapshot.tick > 0; }));
}

TEST_F(WiredSessionTest, NothingElseChangesWhileACalibrationIsOn) {
  connect();
  begin();
  const auto before = session->info();
  EXPECT_THAT(set({{"force.stiffness_n_per_mm", "0.9"}}), HasSubstr("calibration"));
  EXPECT_THAT(set({{"rate_hz", "250"}}), HasSubstr("calibration"));
  EXPECT_THAT(load("pinch_ball"), HasSubstr("calibration"));
  EXPECT_THAT(calibrate(Step::kBegin), HasSubstr("calibration"));
  session->reset();
  session->resume();
  pass(0.3);
  EXPECT_FALSE(session->info()->running);
  EXPECT_EQ(session->info()->overrides, before->overrides);
  EXPECT_NE(session->info()->wizard, nullptr);
  session->stop();
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->view().factor, 0.0);
}

TEST_F(WiredSessionTest, ADeviceLostDuringACalibrationIsSaidAndItCanBeAbandoned) {
  connect();
  begin();
  ASSERT_TRUE(until([&] { return !session->info()->wizard->raw.empty(); }));
  pass(0.1);              // before the first samples a restart is just another session
  controller->restart();  // it knows nothing of our session any more
  EXPECT_TRUE(until([&] { return !session->info()->trouble.empty(); }));
  EXPECT_NE(session->info()->wizard, nullptr);
  EXPECT_EQ(calibrate(Step::kAbandon), "");
  EXPECT_EQ(session->info()->trouble, "");
  EXPECT_TRUE(session->info()->running);
}

// Whoever plugs the device in again is not whom the hand waits for; nor is a slider that is dragged.
TEST_F(WiredSessionTest, AStationThatWasLostComesBackStoppedWhateverBringsItBack) {
  connect();
  hold({-kTooMuch, -kTooMuch});
  const std::string address = controller->after_scheme();
  ASSERT_TRUE(until([&] { return session->view().snapshot.tick > 0; }));
  for (const bool by_reset : {false, true}) {
    session->stop();
    const std::uint64_t seen = session->stops();
    EXPECT_TRUE(session->resume(seen));
    controller.reset();
    EXPECT_FALSE(set({{"rate_hz", "250"}}).empty());
    EXPECT_FALSE(session->info()->running);
    controller = std::make_unique<ControllerThread>(listen_udp(address), clock);
    hold({-kTooMuch, -kTooMuch});
    EXPECT_FALSE(session->resume(seen)) << "said before it was lost";
    records.clear();
    if (by_reset)
      session->reset();
    else
      EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.6"}}), "");
    ASSERT_TRUE(
        until([&] { return session->info()->running && session->view().state == SafetyState::kStopped; }));
    pass(0.5);
    for (const StepRecord& record : records) EXPECT_EQ(record.factor, 0.0);
    EXPECT_TRUE(session->held_stopped());
    EXPECT_TRUE(session->resume(session->stops()));
    EXPECT_TRUE(until([&] { return session->view().factor > 0.0; }));
  }
}

TEST_F(WiredSessionTest, ADeviceThatDoesNotOpenAgainIsTroubleUntilAReset) {
  connect();
  const std::string address = controller->after_scheme();
  ASSERT_TRUE(until([&] { return session->view().snapshot.tick > 0; }));
  controller.reset();
  const auto before = session->info();
  // Two that wait together are tried together, and the device is not asked once more for each. They wait while
  // the running station ends for another rate.
  session->set({{"rate_hz", "500"}}, {});
  ASSERT_FALSE(until_busy().empty());
  auto [rate, rate_done] = awaited();
  auto [force, force_done] = awaited();
  session->set({{"rate_hz", "250"}}, std::move(rate_done));
  session->set({{"force.stiffness_n_per_mm", "0.6"}}, std::move(force_done));
  const auto first = rate;
  const auto second = force;
  ASSERT_TRUE(until([&] { return first->refused.has_value() && second->refused.has_value(); }));
  EXPECT_THAT(*first->refused, HasSubstr("no controller answers"));
  EXPECT_EQ(second->refused, first->refused);
  EXPECT_FALSE(session->info()->running);
  EXPECT_FALSE(session->info()->trouble.empty());
  EXPECT_FALSE(any_torque(session->view()));
  EXPECT_EQ(session->info()->overrides, before->overrides) << "what was refused is not shown";
  EXPECT_EQ(session->info()->values, before->values);
  EXPECT_EQ(session->info()->scene, before->scene);
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock);
  for (int i = 0; i < 100; ++i) session->reset();
  EXPECT_TRUE(until([&] { return session->info()->running; }));
  EXPECT_EQ(session->info()->trouble, "");
  EXPECT_EQ(session->info()->geometry->rate_hz, 200.0);
}

TEST_F(WiredSessionTest, AStationIsReplacedAlsoIfThereIsNoneAndBeginsStopped) {
  connect();
  const std::string address = controller->after_scheme();
  ASSERT_TRUE(until([&] { return session->view().snapshot.tick > 0; }));
  controller.reset();
  const auto replace = [&](const StationOrder& order) {
    return ask([&](Session::Done done) { session->replace(order, std::move(done)); });
  };
  const StationOrder order{
      .scene = "grasp_teapot",
      .overrides = {{"limits.joint_torque_nm", "0.3"}, {"limits.torque_rate_nm_per_s", "80"}}};
  EXPECT_THAT(replace(order), HasSubstr("no controller answers"));
  EXPECT_FALSE(session->info()->running);
  EXPECT_TRUE(session->held_stopped());
  controller = std::make_unique<ControllerThread>(listen_udp(address), clock);
  EXPECT_EQ(replace(order), "");
  EXPECT_TRUE(session->info()->running);
  EXPECT_TRUE(session->held_stopped()) << "there was no station";
  ASSERT_TRUE(until([&] { return controller->controller().configured; }));
  EXPECT_EQ(controller->controller().configure.torque_limit, 0.3F);
  begin();
  EXPECT_THAT(replace(order), HasSubstr("a calibration is on"));
  EXPECT_NE(session->info()->wizard, nullptr);
}

}  // namespace
}  // namespace phalanx
