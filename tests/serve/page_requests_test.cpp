// SPDX-License-Identifier: Apache-2.0
// What a page's message asks of the station, and the state that pages are shown of it.
#include "serve/page_requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/link/controller_thread.h"
#include "phalanx/core/index.h"
#include "phalanx/device/calibration_poses.h"
#include "phalanx/device/fault.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"
#include "phalanx/station/assemble.h"
#include "serve/state_message.h"
#include "station/host_fixture.h"

namespace phalanx {
namespace {

using test::ControllerThread;
using test::HostTest;
using ::testing::AllOf;
using ::testing::HasSubstr;

class PageRequestsTest : public HostTest {
 protected:
  PageRequestsTest() {
    start(with("sliders"));
    write_choices(choices);
  }

  /// Hands it over and waits. @returns what was asked
  PageRequest handed(const wire::ToHost& message) {
    auto [answer, done] = awaited();
    const PageRequest asked = hand_over(message, *host, choices, "/tmp/up", done);
    if (asked.at_once) {
      EXPECT_TRUE(until_idle());
      EXPECT_EQ(answer->times, 0);
      return asked;
    }
    const auto got = answer;
    EXPECT_TRUE(until([&] { return got->refused.has_value(); }));
    refused = got->refused.value_or("no answer");
    return asked;
  }
  /// Nothing waits to be done or answered.
  bool until_idle() {
    return until([&] { return host->state()->busy.empty(); });
  }
  /// @returns why it is refused at once; nothing of it may be done later
  std::string why_not(const wire::ToHost& message) {
    auto [answer, done] = awaited();
    std::string why;
    try {
      static_cast<void>(hand_over(message, *host, choices, "/tmp/up", done));
    } catch (const std::invalid_argument& error) {
      why = error.what();
    }
    EXPECT_TRUE(until_idle());
    EXPECT_EQ(answer->times, 0);
    return why;
  }
  static wire::ToHost set(const std::string& key, const std::string& value, int times = 1) {
    wire::ToHost message;
    for (int i = 0; i < times; ++i) {
      message.mutable_set()->add_setting()->set_key(key);
      message.mutable_set()->mutable_setting(i)->set_value(value);
    }
    return message;
  }
  wire::State state() {
    wire::State out;
    write_state(*host, out);
    return out;
  }
  wire::Welcome choices;
  std::string refused;
};

TEST_F(PageRequestsTest, ASetIsLaidOverTheSceneAndShown) {
  const PageRequest asked = handed(set("force.stiffness_n_per_mm", "0.8"));
  EXPECT_EQ(asked.code, "set");
  EXPECT_EQ(asked.text, "force.stiffness_n_per_mm = 0.8");
  EXPECT_EQ(refused, "");
  const wire::State shown = state();
  ASSERT_EQ(shown.changed_size(), 1);
  EXPECT_EQ(shown.changed(0).value(), "0.8");
  EXPECT_EQ(shown.source(), wire::HAND_SLIDERS);
  EXPECT_EQ(shown.slider_size(), kJoints);
  EXPECT_FALSE(shown.station_gone());
  EXPECT_FALSE(shown.has_wizard());
  EXPECT_FALSE(shown.has_fault());
  EXPECT_GT(shown.time(), 0.0);
  EXPECT_EQ(shown.loop().lateness().octave_size(), 27);
  EXPECT_EQ(handed(set("force.stiffness_n_per_mm", "")).text, "force.stiffness_n_per_mm = as in the scene");
  EXPECT_EQ(state().changed_size(), 0);
  EXPECT_EQ(handed(set("description", "v", 2)).text, "description = v, description = v");
  EXPECT_FALSE(asked.dragging);
  wire::ToHost dragged = set("force.stiffness_n_per_mm", "0.9");
  dragged.mutable_set()->set_dragging(true);
  EXPECT_TRUE(handed(dragged).dragging);
  EXPECT_EQ(handed(dragged).keys, asked.keys);
}

TEST_F(PageRequestsTest, WhatIsTooMuchOrForeignIsRefusedAtOnce) {
  EXPECT_FALSE(why_not(set("rate_hz", "250", 0)).empty());
  EXPECT_THAT(why_not(set("rate_hz", "250", 65)), HasSubstr("65"));
  EXPECT_FALSE(why_not(set("", "1")).empty());
  EXPECT_THAT(why_not(set(std::string(201, 'k'), "1")), HasSubstr("201"));
  EXPECT_THAT(why_not(set("description", std::string(4097, 'v'))),
              AllOf(HasSubstr("description"), HasSubstr("4097"), HasSubstr("4096")));
  EXPECT_THAT(why_not(set("objects.0.file", R"("\u002fetc\u002fpasswd")")), HasSubstr("objects.0.file"));
  wire::ToHost message;
  message.mutable_scene()->set_name("../scenes/wave");
  EXPECT_THAT(why_not(message), HasSubstr("shipped"));
  message.mutable_scene()->set_name("/etc/passwd");
  EXPECT_FALSE(why_not(message).empty());
  message.mutable_scene()->set_name("");
  EXPECT_FALSE(why_not(message).empty());
  message.mutable_source()->set_source(wire::HAND_DEVICE);
  EXPECT_FALSE(why_not(message).empty());
  message.mutable_source()->set_source(static_cast<wire::HandSource>(77));
  EXPECT_FALSE(why_not(message).empty());
  message.mutable_calibrate()->set_step(static_cast<wire::Calibrate::Step>(77));
  EXPECT_FALSE(why_not(message).empty());
  message.mutable_calibrate()->set_step(static_cast<wire::Calibrate::Step>(-1));
  EXPECT_FALSE(why_not(message).empty());
  EXPECT_FALSE(why_not(wire::ToHost()).empty());
  EXPECT_EQ(host->state()->overrides.size(), 0U);
}

TEST_F(PageRequestsTest, ExactlyAsMuchAsMayBeSetIsTaken) {
  const PageRequest asked = handed(set("description", std::string(4096, 'v'), 64));
  EXPECT_EQ(asked.code, "set");
  EXPECT_EQ(refused, "");
  ASSERT_EQ(state().changed_size(), 1);
  EXPECT_EQ(state().changed(0).value().size(), 4096U);
  EXPECT_THAT(why_not(set("description", std::string(4097, 'v'), 64)), HasSubstr("4097"));
  EXPECT_THAT(why_not(set("description", "v", 65)), HasSubstr("65"));
  // A key of 200 bytes is read, and then known to nobody.
  handed(set(std::string(200, 'k'), "1"));
  EXPECT_THAT(refused, HasSubstr("nobody knows this key"));
}

TEST_F(PageRequestsTest, ScenesSourcesAndCalibrationsAreHandedOver) {
  wire::ToHost message;
  message.mutable_scene()->set_name("pinch_ball");
  EXPECT_EQ(handed(message).code, "scene");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().scene(), "pinch_ball");
  EXPECT_EQ(state().geometry(), 2U);
  message.mutable_source()->set_source(wire::HAND_SLIDERS);
  EXPECT_EQ(handed(message).code, "source");
  message.mutable_calibrate()->set_step(wire::Calibrate::BEGIN);
  EXPECT_EQ(handed(message).code, "calibrate");
  EXPECT_FALSE(refused.empty()) << "the simulated device needs none";
  message.mutable_calibrate()->set_step(wire::Calibrate::MEASURE);
  EXPECT_EQ(handed(message).text, "calibration: measures the pose");
  message.mutable_calibrate()->set_step(wire::Calibrate::GO_TO);
  message.mutable_calibrate()->set_pose(2);
  const PageRequest step = handed(message);
  EXPECT_EQ(step.code, "calibrate");
  EXPECT_EQ(step.text, "calibration: goes to pose 3") << "as people count";
}

TEST_F(PageRequestsTest, SlidersOfWhateverNumberStayInsideTheHand) {
  wire::ToHost message;
  auto& sliders = *message.mutable_sliders();
  EXPECT_FALSE(why_not(message).empty());
  for (int j = 0; j < kJoints; ++j) sliders.add_angle(std::numeric_limits<float>::quiet_NaN());
  const PageRequest asked = handed(message);
  EXPECT_TRUE(asked.at_once);
  EXPECT_EQ(asked.text, "moves the hand with the sliders");
  for (int j = 0; j < kJoints; ++j) sliders.set_angle(j, std::numeric_limits<float>::infinity());
  handed(message);
  for (int j = 0; j < kJoints; ++j) sliders.set_angle(j, -3e38F);
  handed(message);
  for (const double angle : host->sliders()) EXPECT_LT(std::abs(angle), 4.0);
  sliders.add_angle(0.0F);
  EXPECT_THAT(why_not(message), HasSubstr("21"));
}

// A different angle for each joint, from the lower end of its range upwards; the page sends single precision.
TEST_F(PageRequestsTest, EachSliderMovesItsOwnJoint) {
  const auto geometry = host->state()->geometry;
  const HandParameters& hand = geometry->hand;
  wire::ToHost message;
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double share = 0.03 * static_cast<double>(j + 1);
    message.mutable_sliders()->add_angle(
        static_cast<float>(hand.min_angle[j] + share * (hand.max_angle[j] - hand.min_angle[j])));
  }
  handed(message);
  const wire::State shown = state();
  ASSERT_EQ(shown.slider_size(), kJoints);
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_EQ(host->sliders()[idx(j)], static_cast<double>(message.sliders().angle(j))) << j;
    EXPECT_EQ(shown.slider(j), message.sliders().angle(j)) << j;
  }
}

TEST_F(PageRequestsTest, SlidersThatMoveNothingAreRefused) {
  EXPECT_EQ(move_by(HandSource::kPatient), "");
  wire::ToHost message;
  for (int j = 0; j < kJoints; ++j) message.mutable_sliders()->add_angle(0.1F);
  EXPECT_EQ(why_not(message), "the sliders do not move the hand now; let them move it first");
}

TEST_F(PageRequestsTest, ResumeAndResetAreDoneAtOnce) {
  host->stop();
  EXPECT_TRUE(state().held_stopped());
  wire::ToHost message;
  message.mutable_resume()->set_stops(state().stops());
  EXPECT_TRUE(handed(message).at_once);
  EXPECT_FALSE(state().held_stopped());
  message.mutable_reset();
  EXPECT_EQ(handed(message).code, "reset");
}

TEST_F(PageRequestsTest, AResumeOrAResetThatANewerStopOrFaultHasOvertakenIsRefused) {
  host->stop();
  wire::ToHost message;
  message.mutable_resume()->set_stops(state().stops());
  host->stop();
  EXPECT_EQ(why_not(message), "another stop or fault has come since; look, then resume again");
  EXPECT_TRUE(host->held_stopped());
  message.mutable_resume()->set_stops(state().stops());
  EXPECT_EQ(handed(message).code, "resumed");
  EXPECT_FALSE(host->held_stopped());
  ASSERT_TRUE(until_running());
  overload();
  message.mutable_reset()->set_fault_time(0.0);
  EXPECT_EQ(why_not(message), "another fault has come since; look, then reset again");
  EXPECT_EQ(host->view().state, SafetyState::kFault);
  message.mutable_reset()->set_fault_time(state().fault().time());
  EXPECT_EQ(handed(message).code, "reset");
  EXPECT_TRUE(until_running());
}

// The loop goes on meanwhile: what is shown lies between what it had counted before and after.
TEST_F(PageRequestsTest, AFaultIsShownInWordsBesideTheLoopsLateSteps) {
  ASSERT_TRUE(until_running());
  overload();
  const DeadlineStatistics before = host->deadlines();
  const wire::State shown = state();
  const DeadlineStatistics after = host->deadlines();
  EXPECT_EQ(shown.fault().name(), "overload");
  EXPECT_EQ(shown.fault().meaning(), fault_meaning(Fault::kOverload));
  EXPECT_EQ(shown.fault().remedy(), fault_remedy(Fault::kOverload));
  EXPECT_GT(before.overruns, 0U);
  EXPECT_GE(shown.loop().overruns(), before.overruns);
  EXPECT_LE(shown.loop().overruns(), after.overruns);
  EXPECT_GT(before.skipped, 0U);
  EXPECT_GE(shown.loop().skipped(), before.skipped);
  EXPECT_LE(shown.loop().skipped(), after.skipped);
}

TEST_F(PageRequestsTest, PatientAndSlidersMoveTheHandWhereTheyAreAskedTo) {
  wire::ToHost message;
  message.mutable_source()->set_source(wire::HAND_PATIENT);
  EXPECT_EQ(handed(message).text, "the simulated patient moves the hand");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().source(), wire::HAND_PATIENT);
  message.mutable_source()->set_source(wire::HAND_SLIDERS);
  EXPECT_EQ(handed(message).text, "the sliders move the hand");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().source(), wire::HAND_SLIDERS);
}

/// A station with a wired device of two angle sensors.
class WiredPagesTest : public HostTest {
 protected:
  using Step = CalibrationSession::Step;

  WiredPagesTest() {
    StationHostSettings settings = with(controller.address(), "grasp_teapot");
    settings.overrides = {{"limits.joint_torque_nm", "0.4"}, {"limits.torque_rate_nm_per_s", "80"}};
    start(settings);
  }
  ~WiredPagesTest() override { host.reset(); }

  /// The pages show the station's calibration state.
  void expect_shown() {
    const auto view = host->state()->wizard;
    ASSERT_NE(view, nullptr);
    wire::State state;
    write_state(*host, state);
    const wire::Wizard& shown = state.wizard();
    EXPECT_EQ(shown.pose(), view->pose);
    EXPECT_EQ(std::vector<std::string>(shown.name().begin(), shown.name().end()), view->names);
    EXPECT_EQ(shown.instruction(), view->instruction);
    EXPECT_EQ(shown.measuring(), view->measuring);
    EXPECT_EQ(shown.measured(), static_cast<float>(view->measured));
    EXPECT_EQ(std::vector<bool>(shown.done().begin(), shown.done().end()), view->done);
    EXPECT_EQ(std::vector<std::int32_t>(shown.raw().begin(), shown.raw().end()), view->raw);
    EXPECT_EQ(std::vector<std::string>(shown.problem().begin(), shown.problem().end()), view->problems);
    EXPECT_EQ(std::vector<std::string>(shown.result().begin(), shown.result().end()), view->results);
    EXPECT_EQ(shown.finished(), view->finished);
  }

  ControllerThread controller{listen_udp("127.0.0.1:0"), clock};
};

// All poses are skipped, then the first two are measured. They concern both sensors, so that is enough.
TEST_F(WiredPagesTest, ADeviceAndItsCalibrationAreShownAsTheyStand) {
  ASSERT_TRUE(until_running());
  overload();
  wire::State state;
  write_state(*host, state);
  EXPECT_TRUE(state.has_fault());
  ASSERT_EQ(calibrate(Step::kBegin), "");
  ASSERT_TRUE(until([&] { return !host->state()->wizard->raw.empty(); }));
  expect_shown();
  state.Clear();
  write_state(*host, state);
  EXPECT_FALSE(state.has_fault()) << "it was the station's that has ended";
  EXPECT_EQ(state.source(), wire::HAND_DEVICE);
  EXPECT_EQ(state.device_spec(), controller.address());
  EXPECT_EQ(state.device_name(), host->state()->device.name);
  EXPECT_EQ(state.device_serial(), "BENCH-1");
  EXPECT_FALSE(state.device_simulated());
  EXPECT_EQ(state.slider_size(), 0);
  EXPECT_EQ(std::vector<int>(state.sensed_joint().begin(), state.sensed_joint().end()),
            host->state()->sensed_joints);
  const std::size_t poses = host->state()->wizard->names.size();
  for (std::size_t p = 0; p < poses; ++p) ASSERT_EQ(calibrate(Step::kSkip), "");
  EXPECT_FALSE(host->state()->wizard->problems.empty());
  expect_shown();
  const std::vector<CalibrationPose> known =
      calibration_poses(host->state()->device.channels, host->state()->geometry->hand);
  for (std::size_t p = 0; p < 2; ++p) {
    ASSERT_EQ(calibrate(Step::kGoTo, p), "");
    std::vector<std::int32_t> raw;  // 1,000 counts a radian, and 1 rad too much
    for (std::size_t c = 0; c < 2; ++c)
      raw.push_back(static_cast<std::int32_t>(std::lround(1000.0 * (known[p].value[c].value() + 1.0))));
    controller.hold({raw[0], raw[1]});
    ASSERT_TRUE(until([&] { return host->state()->wizard->raw == raw; }));
    ASSERT_EQ(calibrate(Step::kMeasure), "");
    pass(0.3);
    EXPECT_TRUE(host->state()->wizard->measuring);
    EXPECT_GT(host->state()->wizard->measured, 0.0);
    expect_shown();
    ASSERT_TRUE(until([&] { return !host->state()->wizard->measuring; }));
  }
  EXPECT_TRUE(host->state()->wizard->finished);
  EXPECT_EQ(host->state()->wizard->results.size(), 2U);
  expect_shown();
}

// What a page can choose, the simulated patient can press.
TEST(Choices, HoldOnlyScenesThatTheSimulatedPatientMeets) {
  wire::Welcome welcome;
  write_choices(welcome);
  std::vector<std::string> refused;
  for (const SceneInfo& info : list_scenes()) {
    const SceneDescription scene = load_scene(info.name, {{"hand.meshes", "\"capsules\""}});
    const auto model = std::make_unique<HapticModel>(build_model(scene));
    try {
      static_cast<void>(simulated_settings(scene, *model));
    } catch (const std::invalid_argument&) {
      refused.push_back(info.name);
    }
  }
  for (const wire::Choice& choice : welcome.scene())
    EXPECT_EQ(std::count(refused.begin(), refused.end(), choice.name()), 0) << choice.name();
  EXPECT_EQ(idx(welcome.scene_size()) + refused.size(), list_scenes().size());
}

TEST(Choices, AreEveryKeySceneAndProfile) {
  wire::Welcome welcome;
  write_choices(welcome);
  EXPECT_GT(welcome.key_size(), 30);
  const auto change_of = [&](const std::string& path) {
    for (const wire::KeyInfo& key : welcome.key())
      if (key.path() == path) return key.change();
    ADD_FAILURE() << path;
    return wire::CHANGE_NEW_STATION;
  };
  EXPECT_EQ(change_of("force.stiffness_n_per_mm"), wire::CHANGE_IN_CONTACT);
  EXPECT_EQ(change_of("force.law"), wire::CHANGE_AT_ZERO_TORQUE);
  EXPECT_EQ(change_of("objects[].kind"), wire::CHANGE_AT_ZERO_TORQUE);
  EXPECT_EQ(change_of("rate_hz"), wire::CHANGE_NEW_STATION);
  const std::vector<SceneKey> keys = scene_keys();
  ASSERT_EQ(idx(welcome.key_size()), keys.size());
  for (int i = 0; i < welcome.key_size(); ++i) {
    const SceneKey& key = keys[idx(i)];
    EXPECT_EQ(welcome.key(i).path(), key.path);
    EXPECT_EQ(welcome.key(i).type(), key.type) << key.path;
    EXPECT_EQ(welcome.key(i).unit(), key.unit) << key.path;
    EXPECT_EQ(welcome.key(i).range(), key.range) << key.path;
    EXPECT_EQ(welcome.key(i).default_value(), key.default_value) << key.path;
    EXPECT_EQ(welcome.key(i).meaning(), key.meaning) << key.path;
  }
  std::vector<SceneInfo> scenes = list_scenes();
  for (const SceneInfo& scene : scenes) EXPECT_TRUE(scene.readable) << scene.name;
  std::erase_if(scenes, [](const SceneInfo& scene) { return !scene.touches; });
  ASSERT_EQ(idx(welcome.scene_size()), scenes.size());
  for (int i = 0; i < welcome.scene_size(); ++i) {
    EXPECT_EQ(welcome.scene(i).name(), scenes[idx(i)].name);
    EXPECT_EQ(welcome.scene(i).meaning(), scenes[idx(i)].description);
  }
  ASSERT_GT(welcome.scene_size(), 10);
  ASSERT_GT(welcome.profile_size(), 1);
  EXPECT_LT(welcome.profile(0).name(), welcome.profile(1).name());
}

}  // namespace
}  // namespace phalanx
