// SPDX-License-Identifier: Apache-2.0
// Requests of pages to the station, and the state that pages are sent.
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
#include "device/opengloves/glove_firmware.h"
#include "phalanx/core/index.h"
#include "phalanx/device/calibration_session.h"
#include "phalanx/device/fault.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"
#include "phalanx/station/resolved_station.h"
#include "serve/state_message.h"
#include "station/session_fixture.h"

namespace phalanx {
namespace {

using test::ControllerThread;
using test::SessionFixture;
using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

class PageRequestsTest : public SessionFixture {
 protected:
  PageRequestsTest() {
    start(with("sliders"));
    write_choices(choices);
  }

  /// Applies a message and waits for the outcome. @returns the request
  PageRequest applied(const wire::ToHost& message) {
    auto [answer, done] = awaited();
    const PageRequest asked = apply_request(message, *session, choices, "/tmp/up", done);
    if (asked.done_at_once) {
      pass(0.1);
      EXPECT_EQ(answer->times, 0);
      return asked;
    }
    const auto got = answer;
    EXPECT_TRUE(until([&] { return got->refused.has_value(); }));
    refused = got->refused.value_or("no answer");
    return asked;
  }
  /// @returns the reason for which the message is refused at once; expects that nothing of it is done later
  std::string why_not(const wire::ToHost& message) {
    auto [answer, done] = awaited();
    std::string why;
    try {
      static_cast<void>(apply_request(message, *session, choices, "/tmp/up", done));
    } catch (const std::invalid_argument& error) {
      why = error.what();
    }
    pass(0.1);
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
    write_state(*session, out);
    return out;
  }
  wire::Welcome choices;
  std::string refused;
};

TEST_F(PageRequestsTest, ASetOverridesTheSceneAndIsShown) {
  const PageRequest asked = applied(set("force.stiffness_n_per_mm", "0.8"));
  EXPECT_EQ(asked.code, "set");
  EXPECT_EQ(asked.text, "force.stiffness_n_per_mm = 0.8");
  EXPECT_EQ(refused, "");
  pass(0.5);
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
  EXPECT_EQ(applied(set("force.stiffness_n_per_mm", "")).text, "force.stiffness_n_per_mm = as in the scene");
  EXPECT_EQ(state().changed_size(), 0);
  EXPECT_EQ(applied(set("description", "v", 2)).text, "description = v, description = v");
  EXPECT_FALSE(asked.dragging);
  wire::ToHost dragged = set("force.stiffness_n_per_mm", "0.9");
  dragged.mutable_set()->set_dragging(true);
  EXPECT_TRUE(applied(dragged).dragging);
  EXPECT_EQ(applied(dragged).keys, asked.keys);
}

TEST_F(PageRequestsTest, AnOpeningIsRefusedInTheSessionsWords) {
  ASSERT_TRUE(until_running());
  wire::ToHost message;
  message.mutable_open()->set_digit(2);
  message.mutable_open()->set_way(0.014F);
  EXPECT_EQ(why_not(message), "middle: the digit is not inside the object, or has left it");
  message.mutable_open()->set_digit(4294967295U);
  EXPECT_THAT(why_not(message), HasSubstr("there are 0 to 4"));
}

TEST_F(PageRequestsTest, TooMuchAndForeignFilesAreRefusedAtOnce) {
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
  EXPECT_EQ(session->info()->overrides.size(), 0U);
}

TEST_F(PageRequestsTest, TheLimitsOfASetAreExact) {
  const PageRequest asked = applied(set("description", std::string(4096, 'v'), 64));
  EXPECT_EQ(asked.code, "set");
  EXPECT_EQ(refused, "");
  ASSERT_EQ(state().changed_size(), 1);
  EXPECT_EQ(state().changed(0).value().size(), 4096U);
  EXPECT_THAT(why_not(set("description", std::string(4097, 'v'), 64)), HasSubstr("4097"));
  EXPECT_THAT(why_not(set("description", "v", 65)), HasSubstr("65"));
  // A key of 200 bytes is read. The scene does not know it.
  applied(set(std::string(200, 'k'), "1"));
  EXPECT_THAT(refused, HasSubstr("is not a known key"));
}

TEST_F(PageRequestsTest, ScenesSourcesAndCalibrationsArePassedOn) {
  wire::ToHost message;
  message.mutable_scene()->set_name("pinch_ball");
  EXPECT_EQ(applied(message).code, "scene");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().scene(), "pinch_ball");
  EXPECT_EQ(state().geometry(), 2U);
  message.mutable_source()->set_source(wire::HAND_SLIDERS);
  EXPECT_EQ(applied(message).code, "source");
  message.mutable_calibrate()->set_step(wire::Calibrate::BEGIN);
  EXPECT_EQ(applied(message).code, "calibrate");
  EXPECT_FALSE(refused.empty()) << "the simulated device needs none";
  message.mutable_calibrate()->set_step(wire::Calibrate::MEASURE);
  EXPECT_EQ(applied(message).text, "calibration: measures the pose");
  message.mutable_calibrate()->set_step(wire::Calibrate::GO_TO);
  message.mutable_calibrate()->set_pose(2);
  const PageRequest step = applied(message);
  EXPECT_EQ(step.code, "calibrate");
  EXPECT_EQ(step.text, "calibration: goes to pose 3") << "counted from 1";
  auto& calibrate = *message.mutable_calibrate();
  calibrate.set_step(wire::Calibrate::ENTER);
  calibrate.set_angle(0.5F);
  EXPECT_EQ(applied(message).text, "calibration: takes an angle that was entered, 28.6 deg for pose 3");
  calibrate.set_method(static_cast<wire::Wizard::Method>(7));
  EXPECT_THAT(why_not(message), HasSubstr("method 7"));
  calibrate.set_method(wire::Wizard::GONIOMETER);
  calibrate.add_digit(5);
  EXPECT_THAT(why_not(message), HasSubstr("digit 5"));
  calibrate.clear_digit();
  calibrate.set_patient(std::string(41, 'p'));
  EXPECT_THAT(why_not(message), HasSubstr("41 bytes"));
}

TEST_F(PageRequestsTest, SlidersOfAnyNumberStayInTheRangeOfMotion) {
  wire::ToHost message;
  auto& sliders = *message.mutable_sliders();
  EXPECT_FALSE(why_not(message).empty());
  for (int j = 0; j < kJoints; ++j) sliders.add_angle(std::numeric_limits<float>::quiet_NaN());
  const PageRequest asked = applied(message);
  EXPECT_TRUE(asked.done_at_once);
  EXPECT_EQ(asked.text, "moves the hand with the sliders");
  for (int j = 0; j < kJoints; ++j) sliders.set_angle(j, std::numeric_limits<float>::infinity());
  applied(message);
  for (int j = 0; j < kJoints; ++j) sliders.set_angle(j, -3e38F);
  applied(message);
  for (const double angle : session->sliders()) EXPECT_LT(std::abs(angle), 4.0);
  sliders.add_angle(0.0F);
  EXPECT_THAT(why_not(message), HasSubstr("21"));
}

// A different angle for each joint, from the lower end of its range upwards; the page sends single precision.
TEST_F(PageRequestsTest, EachSliderMovesItsOwnJoint) {
  const auto geometry = session->info()->geometry;
  const HandParameters& hand = geometry->hand;
  wire::ToHost message;
  for (std::size_t j = 0; j < kJoints; ++j) {
    const double share = 0.03 * static_cast<double>(j + 1);
    message.mutable_sliders()->add_angle(
        static_cast<float>(hand.min_angle[j] + share * (hand.max_angle[j] - hand.min_angle[j])));
  }
  applied(message);
  const wire::State shown = state();
  ASSERT_EQ(shown.slider_size(), kJoints);
  for (int j = 0; j < kJoints; ++j) {
    EXPECT_EQ(session->sliders()[idx(j)], static_cast<double>(message.sliders().angle(j))) << j;
    EXPECT_EQ(shown.slider(j), message.sliders().angle(j)) << j;
  }
}

// A page sends the joints that it moves. What it was told of the others may be old.
TEST_F(PageRequestsTest, JointsWithoutANumberStayWhereTheyAre) {
  wire::ToHost message;
  for (int j = 0; j < kJoints; ++j) message.mutable_sliders()->add_angle(0.1F);
  applied(message);
  for (int j = 0; j < kJoints; ++j)
    message.mutable_sliders()->set_angle(j, j == 6 ? 0.3F : std::numeric_limits<float>::quiet_NaN());
  applied(message);
  for (int j = 0; j < kJoints; ++j)
    EXPECT_EQ(session->sliders()[idx(j)], static_cast<double>(j == 6 ? 0.3F : 0.1F)) << j;
}

TEST_F(PageRequestsTest, SlidersThatMoveNothingAreRefused) {
  EXPECT_EQ(move_by(HandSource::kPatient), "");
  wire::ToHost message;
  for (int j = 0; j < kJoints; ++j) message.mutable_sliders()->add_angle(0.1F);
  EXPECT_EQ(why_not(message), "the sliders do not move the hand now; choose them as its source first");
}

TEST_F(PageRequestsTest, ResumeAndResetAreDoneAtOnce) {
  session->stop();
  EXPECT_TRUE(state().held_stopped());
  wire::ToHost message;
  message.mutable_resume()->set_stops(state().stops());
  EXPECT_TRUE(applied(message).done_at_once);
  EXPECT_FALSE(state().held_stopped());
  message.mutable_reset();
  EXPECT_EQ(applied(message).code, "reset");
}

TEST_F(PageRequestsTest, AResumeOrAResetAfterANewerStopOrFaultIsRefused) {
  session->stop();
  wire::ToHost message;
  message.mutable_resume()->set_stops(state().stops());
  session->stop();
  EXPECT_EQ(why_not(message), "another stop or fault has come since; look, then resume again");
  EXPECT_TRUE(session->held_stopped());
  message.mutable_resume()->set_stops(state().stops());
  EXPECT_EQ(applied(message).code, "resumed");
  EXPECT_FALSE(session->held_stopped());
  ASSERT_TRUE(until_running());
  overload();
  message.mutable_reset()->set_fault_time(0.0);
  EXPECT_EQ(why_not(message), "another fault has come since; look, then reset again");
  EXPECT_EQ(session->view().state, SafetyState::kFault);
  message.mutable_reset()->set_fault_time(state().fault().time());
  EXPECT_EQ(applied(message).code, "reset");
  EXPECT_TRUE(until_running());
}

// The loop runs meanwhile: the counts that are shown lie between those before and after.
TEST_F(PageRequestsTest, AFaultIsShownWithTheLoopsOverruns) {
  ASSERT_TRUE(until_running());
  overload();
  const DeadlineStatistics before = session->deadlines();
  const wire::State shown = state();
  const DeadlineStatistics after = session->deadlines();
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

TEST_F(PageRequestsTest, PatientAndSlidersMoveTheHandAsRequested) {
  wire::ToHost message;
  message.mutable_source()->set_source(wire::HAND_PATIENT);
  EXPECT_EQ(applied(message).text, "the simulated patient moves the hand");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().source(), wire::HAND_PATIENT);
  message.mutable_source()->set_source(wire::HAND_SLIDERS);
  EXPECT_EQ(applied(message).text, "the sliders move the hand");
  EXPECT_EQ(refused, "");
  EXPECT_EQ(state().source(), wire::HAND_SLIDERS);
}

/// Fixture with a station whose wired device has two angle sensors.
class WiredPagesTest : public SessionFixture {
 protected:
  using Step = WizardStep::Kind;

  WiredPagesTest() {
    SessionSettings settings = with(controller.address(), "grasp_teapot");
    settings.overrides = {{"limits.joint_torque_nm", "0.4"}, {"limits.torque_rate_nm_per_s", "80"}};
    start(settings);
  }
  ~WiredPagesTest() override { session.reset(); }

  /// Expects that the state shows the station's calibration.
  void expect_shown() {
    std::shared_ptr<const CalibrationSession::View> view;
    wire::State state;
    do {  // once more if the worker has published another view meanwhile
      view = session->info()->wizard;
      ASSERT_NE(view, nullptr);
      state.Clear();
      write_state(*session, state);
    } while (session->info()->wizard != view);
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

class GlovePagesTest : public SessionFixture {
 protected:
  ~GlovePagesTest() override { session.reset(); }
  test::GloveFirmware firmware{"A0B0C0D0E0F2047G2047"};
};

TEST_F(GlovePagesTest, AGloveWithoutAWatchdogIsShownAsSuchAlsoWithoutAStation) {
  start(with("opengloves:" + firmware.port()));
  ASSERT_EQ(calibrate(WizardStep::Kind::kBegin), "");
  wire::State state;
  write_state(*session, state);
  EXPECT_TRUE(state.station_gone());
  EXPECT_TRUE(state.holds_without_host());
}

// All poses are skipped. Then the first two are measured, which are enough for both sensors.
TEST_F(WiredPagesTest, ADeviceAndItsCalibrationAreShown) {
  ASSERT_TRUE(until_running());
  overload();
  wire::State state;
  write_state(*session, state);
  EXPECT_TRUE(state.has_fault());
  ASSERT_EQ(calibrate(Step::kBegin), "");
  ASSERT_TRUE(until([&] { return !session->info()->wizard->raw.empty(); }));
  expect_shown();
  state.Clear();
  write_state(*session, state);
  EXPECT_FALSE(state.has_fault()) << "it was the station's that has ended";
  EXPECT_EQ(state.source(), wire::HAND_DEVICE);
  EXPECT_EQ(state.device_spec(), controller.address());
  EXPECT_EQ(state.device_name(), session->info()->device.name);
  EXPECT_EQ(state.device_serial(), "BENCH-1");
  EXPECT_FALSE(state.device_simulated());
  EXPECT_EQ(state.slider_size(), 0);
  EXPECT_EQ(std::vector<int>(state.sensed_joint().begin(), state.sensed_joint().end()),
            session->info()->sensed_joints);
  const std::size_t poses = session->info()->wizard->names.size();
  for (std::size_t p = 0; p < poses; ++p) ASSERT_EQ(calibrate(Step::kSkip), "");
  EXPECT_FALSE(session->info()->wizard->problems.empty());
  expect_shown();
  const std::vector<CalibrationPose> known =
      calibration_poses(session->info()->device.channels, session->info()->geometry->hand);
  for (std::size_t p = 0; p < 2; ++p) {
    ASSERT_EQ(calibrate(Step::kGoTo, p), "");
    std::vector<std::int32_t> raw;  // 1,000 counts a radian, and 1 rad too much
    for (std::size_t c = 0; c < 2; ++c)
      raw.push_back(static_cast<std::int32_t>(std::lround(1000.0 * (known[p].value[c].value() + 1.0))));
    controller.hold({raw[0], raw[1]});
    ASSERT_TRUE(until([&] { return session->info()->wizard->raw == raw; }));
    ASSERT_EQ(calibrate(Step::kMeasure), "");
    pass(0.3);
    EXPECT_TRUE(session->info()->wizard->measuring);
    EXPECT_GT(session->info()->wizard->measured, 0.0);
    expect_shown();
    ASSERT_TRUE(until([&] { return !session->info()->wizard->measuring; }));
  }
  EXPECT_TRUE(session->info()->wizard->finished);
  EXPECT_EQ(session->info()->wizard->results.size(), 2U);
  expect_shown();
}

// The simulated patient can press everything that a page can choose.
TEST(Choices, HoldOnlyScenesThatTheSimulatedPatientMeets) {
  wire::Welcome welcome;
  write_choices(welcome);
  std::vector<std::string> refused;
  for (const SceneInfo& info : list_scenes()) {
    const ResolvedScene scene = resolve(load_scene(info.name), {.device = true, .motion = true});
    const auto model = std::make_unique<HapticModel>(build_model(scene));
    try {
      static_cast<void>(simulated_settings(scene, *model));
    } catch (const std::invalid_argument&) {
      refused.push_back(info.name);
    }
  }
  for (const wire::SceneChoice& choice : welcome.scene())
    EXPECT_EQ(std::count(refused.begin(), refused.end(), choice.name()), 0) << choice.name();
  EXPECT_EQ(idx(welcome.scene_size()) + refused.size(), list_scenes().size());
}

TEST(Choices, AreEveryKeySceneAndProfile) {
  wire::Welcome welcome;
  write_choices(welcome);
  EXPECT_GT(welcome.key_size(), 30);
  const auto key_of = [&](const std::string& path) -> const wire::KeyInfo& {
    for (const wire::KeyInfo& key : welcome.key())
      if (key.path() == path) return key;
    ADD_FAILURE() << path;
    return wire::KeyInfo::default_instance();
  };
  const auto change_of = [&](const std::string& path) { return key_of(path).change(); };
  EXPECT_EQ(change_of("force.stiffness_n_per_mm"), wire::CHANGE_IN_CONTACT);
  EXPECT_EQ(change_of("force.law"), wire::CHANGE_AT_ZERO_TORQUE);
  EXPECT_EQ(change_of("objects[].kind"), wire::CHANGE_OTHER_OBJECT);
  EXPECT_EQ(change_of("rate_hz"), wire::CHANGE_NEW_STATION);
  EXPECT_EQ(key_of("rate_hz").type(), wire::KEY_NUMBER);
  EXPECT_EQ(key_of("rate_hz").range().min(), 1.0);
  EXPECT_EQ(key_of("rate_hz").range().max(), 4000.0);
  EXPECT_FALSE(key_of("rate_hz").range().min_open());
  EXPECT_TRUE(key_of("limits.joint_torque_nm").range().min_open());
  EXPECT_EQ(key_of("limits.joint_torque_nm").type(), wire::KEY_NUMBER_OR_OFF);
  EXPECT_TRUE(key_of("smoothing.min_n_per_s").range().max_open());
  EXPECT_TRUE(key_of("smoothing.min_n_per_s").range().minus_infinity());
  EXPECT_EQ(key_of("mirror").type(), wire::KEY_FLAG);
  EXPECT_FALSE(key_of("mirror").has_range());
  EXPECT_EQ(key_of("objects[].breadth_mm").kind(0).kind(), "key");
  EXPECT_EQ(key_of("objects[].breadth_mm").kind(0).default_value(), "25");
  const std::vector<SceneKey>& keys = scene_keys();
  ASSERT_EQ(idx(welcome.key_size()), keys.size());
  for (int i = 0; i < welcome.key_size(); ++i) {
    const SceneKey& key = keys[idx(i)];
    EXPECT_EQ(welcome.key(i).path(), key.path);
    EXPECT_EQ(welcome.key(i).unit(), key.unit) << key.path;
    EXPECT_EQ(welcome.key(i).default_value(), text_of(key).default_value) << key.path;
    EXPECT_EQ(welcome.key(i).meaning(), key.meaning) << key.path;
    EXPECT_THAT(welcome.key(i).choice(), ElementsAreArray(key.choices)) << key.path;
    EXPECT_EQ(idx(welcome.key(i).kind_size()), key.kinds.size()) << key.path;
  }
  std::vector<SceneInfo> scenes = list_scenes();
  for (const SceneInfo& scene : scenes) EXPECT_TRUE(scene.readable) << scene.name;
  std::erase_if(scenes, [](const SceneInfo& scene) { return !scene.touches; });
  ASSERT_EQ(idx(welcome.scene_size()), scenes.size());
  for (int i = 0; i < welcome.scene_size(); ++i) {
    EXPECT_EQ(welcome.scene(i).name(), scenes[idx(i)].name);
    EXPECT_EQ(welcome.scene(i).meaning(), scenes[idx(i)].description);
    EXPECT_EQ(welcome.scene(i).object_kind(), scenes[idx(i)].object_kind);
    const bool measures =
        scenes[idx(i)].name.starts_with("bench_") || scenes[idx(i)].name.starts_with("timing_");
    const bool studies = scenes[idx(i)].name.starts_with("stability_") || scenes[idx(i)].name == "sponge" ||
                         scenes[idx(i)].name == "object_in_hand" || scenes[idx(i)].name == "pinch_slip";
    EXPECT_EQ(welcome.scene(i).purpose(), measures  ? "benchmark"
                                          : studies ? "study"
                                                    : "exercise")
        << scenes[idx(i)].name;
    if (welcome.scene(i).name() == "tripod_pen") {
      EXPECT_EQ(welcome.scene(i).grasp(), "tripod");
    }
    if (welcome.scene(i).name() == "index_ball") {
      EXPECT_EQ(welcome.scene(i).grasp(), "");
    }
  }
  ASSERT_GT(welcome.scene_size(), 10);
  ASSERT_GT(welcome.profile_size(), 1);
  EXPECT_LT(welcome.profile(0).name(), welcome.profile(1).name());
}

}  // namespace
}  // namespace phalanx
