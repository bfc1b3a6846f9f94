// SPDX-License-Identifier: Apache-2.0
// Changes of a session while its station runs, and stop(), which no change delays or ends.
#include "phalanx/station/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/mesh/import_cache.h"
#include "phalanx/scene/scene.h"
#include "record/temporary_folder.h"
#include "station/session_fixture.h"
#include "station/station_build.h"
#include "support/held_clock/hold_this_process.h"
#include "support/opened_files.h"

namespace phalanx {
namespace {

using test::SessionFixture;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

class SessionTest : public SessionFixture {};

TEST_F(SessionTest, RunsTheSceneAndSaysWhatIsSet) {
  start(with("simulated"));
  ASSERT_TRUE(until_running());
  const auto state = session->info();
  EXPECT_EQ(state->scene, "first_touch");
  EXPECT_EQ(state->source, HandSource::kPatient);
  EXPECT_EQ(state->device_spec, "simulated");
  EXPECT_TRUE(state->device.simulated);
  EXPECT_EQ(state->trouble, "");
  EXPECT_EQ(state->busy, "");
  EXPECT_THAT(state->overrides, IsEmpty());
  EXPECT_THAT(state->values, Contains(Pair("force.stiffness_n_per_mm", "0.5")));
  EXPECT_THAT(state->description, HasSubstr("a first session"));
  EXPECT_EQ(state->fingertip_force, 5.0) << "the scene states none";
  EXPECT_EQ(state->geometry->revision, 1U);
  EXPECT_FALSE(state->geometry->object.vertices.empty());
  for (const SegmentMeshes* meshes : {&state->geometry->segment, &state->geometry->display})
    for (const TriangleMesh& mesh : *meshes) EXPECT_FALSE(mesh.vertices.empty());
  EXPECT_LT((state->geometry->X_WH.p - Vec3(0.0273017, -0.1027451, 0.0270887)).norm(), 1e-12)
      << "the scene's hand";
  EXPECT_EQ(state->geometry->rate_hz, 200.0);
  EXPECT_THAT(state->sensed_joints, ::testing::Not(IsEmpty()));
  EXPECT_EQ(state->wizard, nullptr);
}

TEST_F(SessionTest, WhatCannotBeLoadedIsRefusedAtTheBeginning) {
  EXPECT_THROW(start(with("simulated", "no_such_scene")), std::exception);
  EXPECT_THROW(start(with("nonsense")), std::exception);
}

TEST_F(SessionTest, AnotherStiffnessGoesOverInTheStationThatRuns) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  EXPECT_THAT(session->info()->overrides, ElementsAre(Pair("force.stiffness_n_per_mm", "0.75")));
  EXPECT_EQ(value("force.stiffness_n_per_mm"), "0.75");
  EXPECT_TRUE(until([&] { return std::abs(session->view().stiffness - 750.0) < 1e-9; }));
  EXPECT_EQ(session->info()->geometry->revision, 1U);
  EXPECT_EQ(session->view().state, SafetyState::kRunning);
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", ""}}), "");
  EXPECT_THAT(session->info()->overrides, IsEmpty());
  EXPECT_TRUE(until([&] { return std::abs(session->view().stiffness - 500.0) < 1e-9; }));
}

TEST_F(SessionTest, AnotherObjectIsExchangedAtZeroTorqueOrGetsANewStationWithThePatient) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  ASSERT_EQ(set({{"grasp.type", "none"}}), "");  // the wrist stays
  const double before = session->info()->geometry->object.vertices.front().norm();
  const std::uint32_t first = session->info()->geometry->revision;
  EXPECT_EQ(set({{"objects.0.size_mm", "65"}}), "");  // of 130
  EXPECT_EQ(session->info()->geometry->revision, first + 1);
  EXPECT_NEAR(session->info()->geometry->object.vertices.front().norm(), 0.5 * before, 1e-3 * before);
  EXPECT_TRUE(until_running());
  EXPECT_THAT(move_by(HandSource::kPatient), HasSubstr("take the sliders")) << "he meets nothing";
  EXPECT_EQ(session->info()->source, HandSource::kSliders);
  EXPECT_EQ(set({{"objects.0.size_mm", ""}}), "");
  EXPECT_EQ(move_by(HandSource::kPatient), "");
  const std::uint32_t shown = session->info()->geometry->revision;
  EXPECT_EQ(set({{"objects.0.size_mm", "131"}}), "");
  EXPECT_EQ(session->info()->geometry->revision, shown + 1);
  EXPECT_TRUE(until_running());
}

/// Share of the steps with a force in which a contact oscillates. NaN: no step has a force.
double share_oscillating(const std::vector<StepRecord>& records) {
  int with_force = 0, oscillating = 0;
  for (const StepRecord& record : records) {
    if (*std::max_element(record.force.begin(), record.force.end()) <= 0.0) continue;
    ++with_force;
    if (has(record.status, Status::kOscillating)) ++oscillating;
  }
  return static_cast<double>(oscillating) / with_force;
}

// S2's effect in the scene that a station shows first (docs/claims.md).
TEST_F(SessionTest, TheFirstSceneOscillatesAtAStiffWallAndNotWithSmoothing) {
  for (const char* seed : {"1", "2"}) {
    const auto share = [&](const char* stiffness, const char* method) {
      SessionSettings settings = with("simulated");
      settings.overrides = {{"seed", seed},
                            {"force.stiffness_n_per_mm", stiffness},
                            {"stabiliser.method", '"' + std::string(method) + '"'}};
      start(settings);
      EXPECT_TRUE(until_running());
      records.clear();
      pass(12.0);
      return share_oscillating(records);
    };
    EXPECT_EQ(share("0.5", "none"), 0.0) << seed;
    EXPECT_GT(share("2.2", "none"), 0.8) << seed;
    EXPECT_EQ(share("2.2", "smoothing"), 0.0) << seed;
  }
}

// The values change as by the page. The simulated patient planned its press for the softer wall and goes on to press so
// far: each bump reaches the limit of force, and with smoothing, too, the hand oscillates at the start of each squeeze.
TEST_F(SessionTest, TheFirstSceneOscillatesLessOnceSmoothingIsSwitchedOn) {
  start(with("simulated"));
  ASSERT_TRUE(until_running());
  const auto share_with = [&](const char* key, const char* value) {
    EXPECT_EQ(set({{key, value}}), "");
    pass(3.0);  // what oscillated before fades
    records.clear();
    pass(12.0);
    return share_oscillating(records);
  };
  const double without = share_with("force.stiffness_n_per_mm", "2.2");
  EXPECT_GT(without, 0.2);
  EXPECT_LT(share_with("stabiliser.method", "\"smoothing\""), 0.5 * without);
}

// An exchange would begin a new state, and its ticks with it.
TEST_F(SessionTest, AnotherMethodThatBoundsTheForcesChangeGoesOverInContact) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  for (const char* method : {"none", "smoothing", "rise_only"}) {
    const StationView before = session->view();
    EXPECT_EQ(set({{"stabiliser.method", method}, {"force.stiffness_n_per_mm", "0.75"}}), "");
    EXPECT_EQ(value("stabiliser.method"), '"' + std::string(method) + '"');
    EXPECT_TRUE(until([&] { return session->view().time > before.time + 1.0; }));
    EXPECT_EQ(session->view().state, SafetyState::kRunning) << method;
    EXPECT_GT(session->view().snapshot.tick, before.snapshot.tick) << method;
  }
  EXPECT_THAT(set({{"smoothing.enabled", "false"}}), HasSubstr("stabiliser.method = \"none\""));
  EXPECT_EQ(session->info()->geometry->revision, 1U);
}

TEST_F(SessionTest, AnotherLawIsExchangedAndTheShapesStay) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.law", "kelvin_voigt"}, {"description", "'another law'"}}), "");
  EXPECT_EQ(value("force.law"), R"("kelvin_voigt")");
  EXPECT_THAT(session->info()->overrides,
              ElementsAre(Pair("force.law", "kelvin_voigt"), Pair("description", "'another law'")));
  EXPECT_EQ(session->info()->description, "another law");
  EXPECT_EQ(session->info()->geometry->revision, 1U);
  EXPECT_TRUE(until_running());
}

TEST_F(SessionTest, AnotherRateIsANewStation) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"rate_hz", "250"}}), "");
  EXPECT_EQ(session->info()->geometry->rate_hz, 250.0);
  EXPECT_TRUE(until_running());
  EXPECT_EQ(session->deadlines().period, 1.0 / 250.0);
}

TEST_F(SessionTest, WhatIsRefusedLeavesEverythingAsItWas) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  const auto before = session->info();
  for (const Overrides& wrong :
       {Overrides{{"force.stiffness_n_per_mm", "-1"}}, Overrides{{"force.stiffness_n_per_mm", "nan"}},
        Overrides{{"force.stiffness_n_per_mm", "inf"}}, Overrides{{"force.stiffness_n_per_mm", "many"}},
        Overrides{{"no.such.key", "1"}}, Overrides{{"", "1"}}, Overrides{{"rate_hz", "5000"}},
        Overrides{{"objects.0.size_mm", "0"}}, Overrides{{"objects.7.size_mm", "10"}},
        Overrides{{"force.stiffness_n_per_mm", "0.8"}, {"smoothing.min_n", "[]"}}}) {
    const std::string refused = set(wrong);
    EXPECT_THAT(refused, HasSubstr(wrong.back().first.substr(0, wrong.back().first.find('.'))))
        << "names the key";
    EXPECT_FALSE(refused.empty());
  }
  EXPECT_THAT(load("no_such_scene"), HasSubstr("no_such_scene"));
  EXPECT_FALSE(move_by(HandSource::kDevice).empty());
  const auto after = session->info();
  EXPECT_EQ(after->overrides, before->overrides);
  EXPECT_EQ(after->values, before->values);
  EXPECT_EQ(after->geometry, before->geometry);
  EXPECT_EQ(after->scene, before->scene);
  EXPECT_TRUE(after->running);
  EXPECT_EQ(after->trouble, "");
  EXPECT_EQ(after->busy, "");
  EXPECT_EQ(session->view().state, SafetyState::kRunning) << "the torque was never away";
  EXPECT_EQ(session->view().stiffness, 500.0);
}

TEST_F(SessionTest, AStationReadsEachFileOnceAndAnotherParameterReadsNone) {
  const testing::TemporaryFolder folder;
  const std::string scene = test::write_first_touch(folder.path());
  const std::map<std::string, int> once = {
      {"device.toml", 1}, {"hand.toml", 1}, {"patient.toml", 1}, {"scene.toml", 1}};
  const test::OpenedFiles opened(folder.path());
  start(with("simulated", scene));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(opened.take(), once);
  for (const char* stiffness : {"0.75", "0.8", ""})
    EXPECT_EQ(set({{"force.stiffness_n_per_mm", stiffness}}), "");
  EXPECT_EQ(set({{"smoothing.max_n_per_s", "30"}}), "");
  EXPECT_EQ(set({{"force.law", "kelvin_voigt"}, {"contact.margin_mm", "0.06"}}), "") << "at zero torque";
  EXPECT_FALSE(set({{"force.stiffness_n_per_mm", "-1"}}).empty());
  EXPECT_THAT(opened.take(), IsEmpty());
  EXPECT_EQ(value("force.law"), R"("kelvin_voigt")");
  EXPECT_EQ(set({{"objects.0.size_mm", "131"}}), "") << "another station";
  const std::map<std::string, int> without_scene = {
      {"device.toml", 1}, {"hand.toml", 1}, {"patient.toml", 1}};
  EXPECT_EQ(opened.take(), without_scene);
}

TEST_F(SessionTest, AnotherStationImportsNoMeshAgain) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  const auto first = session->info()->geometry;
  EXPECT_EQ(session->imports()->misses(), std::size_t{kSegments}) << "the files of the hand";
  EXPECT_EQ(session->imports()->hits(), 0U);
  EXPECT_EQ(set({{"rate_hz", "250"}}), "");
  EXPECT_EQ(session->imports()->misses(), std::size_t{kSegments});
  EXPECT_EQ(session->imports()->hits(), std::size_t{kSegments});
  const auto second = session->info()->geometry;
  ASSERT_NE(second, first);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_EQ(second->segment[s].vertices, first->segment[s].vertices) << s;
    EXPECT_EQ(second->segment[s].triangles, first->segment[s].triangles) << s;
  }
}

// A scene's file that is edited, or broken, while a station runs changes nothing until it is loaded again.
TEST_F(SessionTest, AnEditedSceneCountsOnceItIsLoaded) {
  const testing::TemporaryFolder folder;
  const std::string scene = test::write_first_touch(folder.path());
  start(with("simulated", scene));
  ASSERT_TRUE(until_running());
  std::ofstream(scene) << "this is no scene";
  EXPECT_EQ(set({{"objects.0.size_mm", "131"}}), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(value("objects.0.size_mm"), "131");
  auto [answer, done] = awaited();
  session->load_scene(scene, done);
  ASSERT_TRUE(until([&] { return answer->refused.has_value(); }));
  EXPECT_THAT(*answer->refused, HasSubstr("scene.toml"));
  EXPECT_TRUE(until_running()) << "the old one goes on";
}

// The gate and the channels have the hand of the start: another object alone must not bring another hand.
TEST_F(SessionTest, AHandFileThatHasChangedSinceTheStartComesWithANewStation) {
  const testing::TemporaryFolder folder;
  const std::string scene = test::write_first_touch(folder.path());
  start(with("sliders", scene));
  ASSERT_TRUE(until_running());
  const auto ticks_until_running = [&] {
    pass(0.5);
    EXPECT_TRUE(until_running());
    return session->deadlines().steps;
  };
  const std::uint64_t first = ticks_until_running();
  EXPECT_EQ(set({{"objects.0.size_mm", "131"}}), "");
  const std::uint64_t second = ticks_until_running();
  EXPECT_GT(second, first) << "the same station";
  const std::string name = session->info()->geometry->hand.name;
  std::string text;
  {
    std::ifstream in(folder / "hand.toml");
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  const std::size_t at = text.find("name = \"" + name + "\"");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(folder / "hand.toml") << text.replace(at, name.size() + 9, "name = \"another\"");
  EXPECT_EQ(set({{"objects.0.size_mm", "132"}}), "");
  EXPECT_EQ(session->info()->geometry->hand.name, "another");
  EXPECT_LT(ticks_until_running(), second) << "another station";
}

TEST_F(SessionTest, AParameterIsRefusedInTheWordsOfTheScenesReader) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  for (const auto& [key, wrong] : Overrides{{"force.stiffness_n_per_mm", "-1"},
                                            {"force.stiffness_n_per_mm", "100.1"},
                                            {"force.stiffness_n_per_mm", "many"},
                                            {"smoothing.max_n_per_s", "0"},
                                            {"smoothing.max_n", "0.1"},
                                            {"smoothing.min_n_per_s", "nan"},
                                            {"force.law", "hook"},
                                            {"stabiliser.method", "3"},
                                            {"force.stifness", "1"}}) {
    std::string words;
    try {
      static_cast<void>(load_scene("first_touch", {{key, wrong}}));
    } catch (const SceneError& refused) {
      words = refused.what();
    }
    EXPECT_THAT(words, HasSubstr(key + " = "));
    EXPECT_EQ(set({{key, wrong}}), words);
  }
}

TEST_F(SessionTest, AValueThatIsTakenAwayIsTheFilesAgain) {
  const testing::TemporaryFolder folder;
  const std::string scene = folder / "scene.toml";
  std::ofstream(scene) << "[force]\nlaw = \"duffing\"\nstiffness_n_per_mm = 0.7\n";
  start(with("sliders", scene));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.law", "hooke"}}), "");
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.9"}}), "");
  EXPECT_TRUE(until([&] { return std::abs(session->view().stiffness - 900.0) < 1e-9; }));
  EXPECT_EQ(set({{"force.law", ""}}), "");
  EXPECT_EQ(value("force.law"), R"("duffing")");
  EXPECT_EQ(value("force.stiffness_n_per_mm"), "0.9");
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", ""}}), "");
  EXPECT_TRUE(until([&] { return std::abs(session->view().stiffness - 700.0) < 1e-9; }));
}

TEST_F(SessionTest, ASliderThatIsDraggedIsOneChangeAndEachIsAnswered) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  occupy();
  std::vector<std::shared_ptr<Answer>> answers;
  for (int i = 1; i <= 300; ++i) {
    auto [answer, done] = awaited();
    answers.push_back(answer);
    session->set({{"force.stiffness_n_per_mm", std::to_string(0.3 + 0.001 * i)}}, done);
  }
  ASSERT_TRUE(until([&] { return answers.back()->refused.has_value(); }));
  for (const auto& answer : answers) {
    EXPECT_EQ(answer->refused, "");
    EXPECT_EQ(answer->times, 1);
    EXPECT_EQ(answer->overtaken, answer != answers.back());
  }
  EXPECT_TRUE(until([&] { return std::abs(session->view().stiffness - 600.0) < 1e-6; }));
}

TEST_F(SessionTest, OfSetsThatWereJoinedOnlyTheWrongOneIsRefused) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  occupy();
  auto [good, good_done] = awaited();
  auto [bad, bad_done] = awaited();
  auto [later, later_done] = awaited();
  session->set({{"force.stiffness_n_per_mm", "0.625"}}, good_done);
  session->set({{"smoothing.max_n_per_s", "-3"}}, bad_done);
  session->set({{"force.damping_ns_per_m", "1"}}, later_done);
  const auto last = later;
  ASSERT_TRUE(until([&] { return last->refused.has_value(); }));
  EXPECT_EQ(good->refused, "");
  EXPECT_THAT(bad->refused.value_or(""), HasSubstr("smoothing.max_n_per_s"));
  EXPECT_EQ(later->refused, "");
  EXPECT_EQ(value("force.stiffness_n_per_mm"), "0.625");
  EXPECT_THAT(session->info()->overrides, ::testing::SizeIs(2));
}

TEST_F(SessionTest, MoreChangesThanTheQueueHoldsAreRefusedAtOnce) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  occupy();
  int answered = 0;
  int refused = 0;
  for (int i = 0; i < 12000; ++i) {  // a minute of 200 a second
    try {
      session->load_scene("no_such_scene", [&](const ChangeOutcome&) { ++answered; });
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr("wait"));
      ++refused;
    }
  }
  EXPECT_GE(refused, 12000 - 1024);
  ASSERT_TRUE(until([&] { return answered + refused == 12000; }));
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.6"}}), "") << "and it goes on";
}

TEST_F(SessionTest, SlidersMoveTheHandWithinItsRangeAndThePatientComesBack) {
  start(with("simulated"));
  ASSERT_TRUE(until_running());
  // The session's work while the change is made.
  const auto busy_with = [&](HandSource source) {
    auto [answer, done] = awaited();
    session->set_source(source, std::move(done));
    const std::string busy = until_busy();
    const auto got = answer;
    EXPECT_TRUE(until([&] { return got->refused.has_value(); }));
    EXPECT_EQ(got->refused, "");
    return busy;
  };
  EXPECT_EQ(busy_with(HandSource::kSliders), "sliders");
  EXPECT_EQ(session->info()->source, HandSource::kSliders);
  JointArray wanted = session->sliders();
  const auto index_pip = static_cast<std::size_t>(joint_index(1, 2));
  const auto thumb = static_cast<std::size_t>(joint_index(0, 0));
  const auto little = static_cast<std::size_t>(joint_index(4, 2));
  const double thumb_before = wanted[thumb];
  wanted[index_pip] = 100.0;
  wanted[thumb] = std::numeric_limits<double>::quiet_NaN();
  wanted[little] = -std::numeric_limits<double>::infinity();
  EXPECT_TRUE(session->set_sliders(wanted));
  const double most = session->info()->geometry->hand.max_angle[index_pip];
  EXPECT_EQ(session->sliders()[index_pip], most);
  EXPECT_EQ(session->sliders()[thumb], thumb_before);
  EXPECT_TRUE(std::isfinite(session->sliders()[little]));
  EXPECT_TRUE(until([&] { return std::abs(session->view().snapshot.hcp_angle[index_pip] - most) < 0.02; }));
  EXPECT_NE(session->view().state, SafetyState::kFault);
  EXPECT_EQ(busy_with(HandSource::kPatient), "simulated patient");
  EXPECT_FALSE(session->set_sliders(wanted)) << "it moves nothing";
  EXPECT_TRUE(until_running());
  EXPECT_TRUE(session->info()->device.simulated);
}

TEST_F(SessionTest, PlansTheGraspOfAnotherTypeAndObjectAndKeepsItThrough) {
  start(with("simulated", "pinch_ball"));
  ASSERT_TRUE(until_running());
  const auto value = [&](const char* key) {
    const Overrides values = session->info()->values;
    const auto it =
        std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.first == key; });
    return it == values.end() ? std::string() : it->second;
  };
  const auto set = [&](const Overrides& changes) {
    auto [answer, done] = awaited();
    session->set(changes, std::move(done));
    const auto got = answer;
    EXPECT_TRUE(until([&] { return got->refused.has_value(); }));
    return got->refused.value_or("no answer");
  };
  const Vec3 stated = session->info()->geometry->X_WH.p;
  ASSERT_EQ(set({{"grasp.type", "tripod"}, {"objects.0.diameter_mm", "50"}}), "");
  ASSERT_TRUE(until_running());
  const Vec3 planned = session->info()->geometry->X_WH.p;
  EXPECT_NE(planned, stated);
  EXPECT_EQ(value("grasp.type"), "\"tripod\"");
  const std::string checksum = value("grasp.planned_for");
  // A change that the grasp does not depend on, in contact and with a new station.
  ASSERT_EQ(set({{"force.stiffness_n_per_mm", "0.3"}}), "");
  EXPECT_EQ(value("grasp.planned_for"), checksum);
  ASSERT_EQ(set({{"limits.fingertip_force_n", "4"}}), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->info()->geometry->X_WH.p, planned);
  EXPECT_EQ(value("grasp.planned_for"), checksum);
  // What no hand can hold is refused, and the station goes on.
  EXPECT_THAT(set({{"objects.0.diameter_mm", "400"}}), HasSubstr("no tripod grasp"));
  EXPECT_EQ(session->info()->geometry->X_WH.p, planned);
  ASSERT_EQ(set({{"grasp.type", ""}, {"objects.0.diameter_mm", ""}}), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->info()->geometry->X_WH.p, stated);
}

// The sliders close the hand on a ball, which then grows: the shown hand begins at the open hand again.
TEST_F(SessionTest, ADigitThatStartedInsideIsOpenedByAConfirmationOfWhatWasSeen) {
  SessionSettings settings = with("sliders", "squeeze_ball");
  // With a planned grasp the wrist would move to the larger ball.
  settings.overrides = {
      {"grasp.type", "none"}, {"hand.position_mm", "[0, -86, 74]"}, {"hand.rotation_deg", "[90, 0, 0]"}};
  start(settings);
  ASSERT_TRUE(until_running());
  JointArray fist = session->sliders();
  for (int digit = 1; digit < kDigits; ++digit)
    for (const int i : {0, 2, 3})
      fist[static_cast<std::size_t>(joint_index(digit, i))] =
          0.7 * session->info()->geometry->hand.max_angle[static_cast<std::size_t>(joint_index(digit, i))];
  ASSERT_TRUE(session->set_sliders(fist));
  pass(2.0);
  auto [answer, done] = awaited();
  session->set({{"objects.0.diameter_mm", "72"}}, std::move(done));
  const auto got = answer;
  ASSERT_TRUE(until([&] { return got->refused.has_value(); }));
  ASSERT_EQ(got->refused, "");
  const auto opening = [&](int digit) {
    return session->view().snapshot.opening[static_cast<std::size_t>(digit)];
  };
  int digit = kDigits - 1;
  ASSERT_TRUE(until([&] {
    for (digit = kDigits - 1; digit > 0; --digit)
      if (opening(digit).phase == OpeningPhase::kUnconfirmed && opening(digit).way > 2e-3) return true;
    return false;
  }));
  ASSERT_TRUE(until_running());
  // Of the digit's contacts, as the step has computed it.
  const auto force = [&] {
    const StationView view = session->view();
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment =
          view.snapshot.segment[static_cast<std::size_t>(segment_index(digit, k))];
      sum += segment.force * segment.normal;
    }
    return sum.norm();
  };
  std::uint64_t running = session->view().running;
  const auto refusal = [&](int of, double way) -> std::string {
    try {
      session->open_digit(of, way, running);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  pass(0.5);
  EXPECT_EQ(force(), 0.0);
  const double way = opening(digit).way;
  EXPECT_THAT(refusal(kDigits, way), HasSubstr("0 to 4"));
  EXPECT_THAT(refusal(-1, way), HasSubstr("0 to 4"));
  EXPECT_THAT(refusal(digit, way + 6e-3), HasSubstr("look, then confirm again"));
  EXPECT_THAT(refusal(digit, std::numeric_limits<double>::quiet_NaN()), HasSubstr("look"));
  session->stop();
  ASSERT_TRUE(until([&] { return session->view().state == SafetyState::kStopped; }));
  EXPECT_THAT(refusal(digit, way), HasSubstr("forces are not on"));
  session->resume();
  ASSERT_TRUE(until_running());
  EXPECT_EQ(opening(digit).phase, OpeningPhase::kUnconfirmed);
  EXPECT_THAT(refusal(digit, way), HasSubstr("forces have been off")) << "what was seen before the stop";
  running = session->view().running;

  EXPECT_EQ(refusal(digit, way + 3e-3), "");
  ASSERT_TRUE(until([&] { return opening(digit).phase == OpeningPhase::kConfirmed; }));
  EXPECT_THAT(refusal(digit, way), HasSubstr("is being opened"));
  ASSERT_TRUE(until([&] { return force() > 0.2; }));
  session->stop();  // also takes the confirmation back, though no step sees the station stopped
  session->resume();
  pass(1.5);
  ASSERT_TRUE(until_running());
  EXPECT_NE(session->view().running, running);
  running = session->view().running;
  EXPECT_EQ(opening(digit).phase, OpeningPhase::kUnconfirmed);
  EXPECT_EQ(force(), 0.0);

  EXPECT_EQ(refusal(digit, opening(digit).way), "");
  double largest = 0.0;
  ASSERT_TRUE(until([&] {  // sliders do not follow
    largest = std::max(largest, force());
    return opening(digit).phase == OpeningPhase::kNotFollowed;
  }));
  EXPECT_GT(largest, 0.5);
  EXPECT_LE(largest, 1.0 + 1e-9);
  for (double& angle : fist) angle = 0.0;
  ASSERT_TRUE(session->set_sliders(fist));
  ASSERT_TRUE(until([&] { return opening(digit).phase == OpeningPhase::kNone; }));
  EXPECT_THAT(refusal(digit, way), HasSubstr("is not inside"));
}

TEST_F(SessionTest, AnotherSceneLeavesWhatWasLaidOverTheLast) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  EXPECT_EQ(load("pinch_ball"), "");
  EXPECT_EQ(session->info()->scene, "pinch_ball");
  EXPECT_THAT(session->info()->overrides, IsEmpty());
  EXPECT_EQ(session->info()->geometry->revision, 2U);
  EXPECT_TRUE(until_running());
}

TEST_F(SessionTest, AStopIsObeyedByTheNextStepWhileASceneIsBuilt) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  auto [answer, done] = awaited();
  session->load_scene("grasp_teapot", done);
  ASSERT_EQ(until_busy(), "scene grasp_teapot");
  session->stop();
  const double stopped = clock.now();
  const auto got = answer;
  ASSERT_TRUE(until([&] { return got->refused.has_value(); }));
  pass(1.5);
  std::size_t after = 0;
  for (const StepRecord& record : records) {
    if (record.input.time <= stopped) continue;
    ++after;
    EXPECT_TRUE(record.state == SafetyState::kStopping || record.state == SafetyState::kStopped ||
                (record.state == SafetyState::kWaiting && record.factor == 0.0))
        << safety_state_name(record.state) << " " << record.input.time - stopped << " s after the stop";
  }
  EXPECT_GT(after, 20U);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->view().state, SafetyState::kStopped);
  EXPECT_EQ(session->info()->scene, "grasp_teapot");
  session->resume();
  EXPECT_FALSE(session->held_stopped());
  EXPECT_TRUE(until_running());
}

TEST_F(SessionTest, AStopHoldsOverEveryKindOfChange) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  session->stop();
  ASSERT_TRUE(until([&] { return session->view().state == SafetyState::kStopped; }));
  records.clear();
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  EXPECT_EQ(set({{"objects.0.size_mm", "117"}}), "");
  EXPECT_EQ(set({{"objects.0.size_mm", ""}}), "");
  EXPECT_EQ(set({{"rate_hz", "250"}}), "");
  EXPECT_EQ(move_by(HandSource::kPatient), "");
  EXPECT_EQ(load("grasp_teapot"), "");
  session->reset();
  pass(1.0);
  for (const StepRecord& record : records) {
    EXPECT_EQ(record.factor, 0.0);
    for (const double torque : record.command.torque) EXPECT_EQ(torque, 0.0);
  }
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->view().state, SafetyState::kStopped);
}

TEST_F(SessionTest, AResumeBetweenTwoStationsIsNotLost) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  session->stop();
  auto [answer, done] = awaited();
  session->load_scene("pinch_ball", done);
  ASSERT_EQ(until_busy(), "scene pinch_ball");
  session->resume();
  const auto got = answer;
  ASSERT_TRUE(until([&] { return got->refused.has_value(); }));
  EXPECT_FALSE(session->held_stopped());
  EXPECT_TRUE(until_running());
}

TEST_F(SessionTest, AFaultIsReportedOverASwitchAndTorqueComesBackOnlyByWord) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  {
    const test::LoopWakesLate overload(0.0075);  // the period is 5 ms
    while (session->view().state != SafetyState::kFault || !session->view().at_rest) {
      session->poll();
      sleep(0.005);
    }
  }
  auto [answer, done] = awaited();
  session->load_scene("pinch_ball", done);
  const auto got = answer;
  StepRecord record;
  std::vector<DeviceSample> samples;
  while (!got->refused.has_value()) {  // an owner who fetches records first, and reports late
    session->poll();
    while (session->next_record(record, samples)) {
    }
    sleep(0.005);
  }
  pass(1.0);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->view().state, SafetyState::kStopped);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(reports.front().event.fault, Fault::kOverload);
  session->resume();
  EXPECT_TRUE(until_running());
}

TEST_F(SessionTest, TheViewNeverGoesBackOverASwitch) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  auto [answer, done] = awaited();
  session->load_scene("pinch_ball", done);
  const auto got = answer;
  double last = session->view().time;
  std::uint32_t revision = session->info()->geometry->revision;
  while (!got->refused.has_value()) {
    sleep(0.0002);
    session->poll();
    const bool gone = !session->info()->running;
    const StationView view = session->view();
    EXPECT_GE(view.time, last);
    EXPECT_GT(view.snapshot.tick, 0U) << "a hand at the origin is shown";
    last = view.time;
    EXPECT_GE(session->info()->geometry->revision, revision);
    revision = session->info()->geometry->revision;
    EXPECT_FALSE(gone && any_torque(view));
  }
}

TEST_F(SessionTest, AResetDuringASwitchDoesNotStartTheStationTwice) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  auto [answer, done] = awaited();
  session->load_scene("pinch_ball", done);
  const auto got = answer;
  while (!got->refused.has_value()) {
    session->poll();
    session->reset();
    sleep(0.0002);
  }
  pass(0.3);
  EXPECT_EQ(session->info()->geometry->revision, 2U);
}

// The callbacks after it wait for the next poll().
TEST_F(SessionTest, ACallbackThatThrowsEndsThePollAndNothingElse) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  occupy();
  const Session::Done throws = [](const ChangeOutcome&) { throw std::runtime_error("from a callback"); };
  auto [answer, done] = awaited();
  session->set({{"force.stiffness_n_per_mm", "0.7"}}, throws);
  session->set({{"force.damping_ns_per_m", "1"}}, done);
  sleep(2.0);  // the old station ramps down meanwhile
  EXPECT_EQ(session->info()->busy, "");
  EXPECT_THROW(session->poll(), std::runtime_error);
  EXPECT_EQ(answer->times, 0);
  session->poll();
  EXPECT_EQ(answer->times, 1);
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.6"}}), "");
}

TEST_F(SessionTest, ACallbackMayShutTheSessionDownAndNoneFollows) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  occupy();
  auto [answer, done] = awaited();
  session->set({{"force.stiffness_n_per_mm", "0.7"}}, [this](const ChangeOutcome&) { session->shut_down(); });
  session->set({{"force.damping_ns_per_m", "1"}}, done);
  sleep(2.0);  // the old station ramps down meanwhile
  session->poll();
  EXPECT_TRUE(session->held_stopped());
  session->poll();
  EXPECT_EQ(answer->times, 0);
}

TEST_F(SessionTest, NothingIsAnsweredOrBegunOnceItIsShutDown) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  int answers = 0;
  const auto done = [&](const ChangeOutcome&) { ++answers; };
  session->load_scene("pinch_ball", done);
  session->load_scene("grasp_teapot", done);
  ASSERT_FALSE(until_busy().empty());
  session->shut_down();
  EXPECT_THROW(session->load_scene("pinch_ball", done), std::runtime_error);
  session->stop();
  EXPECT_FALSE(session->resume());
  session->reset();
  session->set_sliders({});
  for (int i = 0; i < 5; ++i) session->poll();
  EXPECT_EQ(answers, 0);
  EXPECT_FALSE(any_torque(session->view()));
  session->shut_down();
  session.reset();
  EXPECT_EQ(answers, 0);
}

TEST_F(SessionTest, EndsWhileWorkIsOnItsWayWithoutTorqueOrAnAnswer) {
  for (int i = 0; i < 3; ++i) {
    start(with("sliders"));
    ASSERT_TRUE(until_running());
    auto [answer, done] = awaited();
    session->load_scene("pinch_ball", done);
    session->set({{"objects.0.size_mm", "50"}}, done);
    ASSERT_EQ(until_busy(), "scene pinch_ball");
    {
      const test::ThreadsWait building("phalanx-build");
      std::this_thread::sleep_for(std::chrono::milliseconds(20 * i));  // the build has not begun, or is done
    }
    session->shut_down();
    EXPECT_EQ(session->view().factor, 0.0);
    EXPECT_FALSE(any_torque(session->view()));
    session.reset();
    EXPECT_EQ(answer->times, 0);
  }
}

/// Nice value of each thread of this process, with its name.
std::vector<std::pair<std::string, int>> threads() {
  std::vector<std::pair<std::string, int>> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    const auto id = static_cast<id_t>(std::stoul(task.path().filename().string()));
    errno = 0;
    const int nice = ::getpriority(PRIO_PROCESS, id);
    if (errno == 0) found.emplace_back(name, nice);  // else it has ended
  }
  return found;
}

// A loop without SCHED_FIFO has nothing but its nice value against seconds of computing, and a loop that is
// begun by the worker must not inherit what gives way.
TEST_F(SessionTest, WhatComputesGivesWayAndNoLoopDoes) {
  const int own_nice = ::getpriority(PRIO_PROCESS, 0);
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  auto [answer, done] = awaited();
  std::optional<test::ThreadsWait> building("phalanx-build");
  session->set({{"objects.0.triangles", "2000"}}, done);
  ASSERT_TRUE(until([&] { return building->one_waits(); }));
  std::optional<int> computing;
  for (const auto& [name, nice] : threads())
    if (name == "phalanx-build") computing = nice;
  building.reset();
  EXPECT_EQ(computing, std::max(5, own_nice));
  const auto got = answer;
  EXPECT_TRUE(until([&] { return got->refused.has_value(); }));
  EXPECT_EQ(load("pinch_ball"), "");
  ASSERT_TRUE(until_running());
  for (const auto& [name, nice] : threads()) EXPECT_EQ(nice, own_nice) << name;
}

// A word that was late on its way does not undo a newer one.
TEST_F(SessionTest, AResumeThatIsOlderThanAStopDoesNothing) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  session->stop();
  const std::uint64_t seen = session->stops();
  session->stop();  // the stop of another user, not seen yet
  EXPECT_FALSE(session->resume(seen));
  EXPECT_TRUE(session->held_stopped());
  EXPECT_TRUE(until([&] { return session->view().state == SafetyState::kStopped; }));
  EXPECT_TRUE(session->resume(session->stops()));
  EXPECT_FALSE(session->held_stopped());
  EXPECT_TRUE(until_running());
}

// Said twice, or late: it was said before anybody knew of the fault.
TEST_F(SessionTest, AResumeFromBeforeAFaultDoesNotBringTheTorqueBackAfterIt) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  session->stop();
  const std::uint64_t seen = session->stops();
  EXPECT_TRUE(session->resume(seen));
  ASSERT_TRUE(until_running());
  overload();
  EXPECT_EQ(load("pinch_ball"), "");
  EXPECT_FALSE(session->resume(seen));
  EXPECT_TRUE(session->held_stopped());
  EXPECT_TRUE(until([&] { return session->view().state == SafetyState::kStopped; }));
  EXPECT_TRUE(session->resume(session->stops()));
  ASSERT_TRUE(until_running());
  session->stop();
  const std::uint64_t stopped = session->stops();
  overload();
  EXPECT_EQ(load("first_touch"), "");
  EXPECT_FALSE(session->resume(stopped))
      << "that it was stopped already does not make it a word on the fault";
  EXPECT_TRUE(session->held_stopped());
}

TEST_F(SessionTest, AResetOfAnotherFaultThanTheOneThatIsThereDoesNothing) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_FALSE(session->reset(12.5)) << "there is no fault at all";
  overload();
  const double first = session->view().fault.time;
  EXPECT_FALSE(session->reset(0.0)) << "said before there was one";
  pass(0.3);
  EXPECT_EQ(session->view().state, SafetyState::kFault);
  EXPECT_TRUE(session->reset(first));
  ASSERT_TRUE(until_running());
  overload();
  const double second = session->view().fault.time;
  EXPECT_GT(second, first);
  EXPECT_FALSE(session->reset(first));
  pass(0.3);
  EXPECT_EQ(session->view().state, SafetyState::kFault);
  EXPECT_TRUE(session->reset(second));
  EXPECT_TRUE(until_running());
}

// The program ends while an object is being built, for which time is made to pass.
TEST_F(SessionTest, TheTorqueIsZeroBeforeAChangeOnItsWayIsDone) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  std::optional<test::ThreadsWait> building("phalanx-build");
  session->set({{"objects.0.triangles", "2000"}}, {});
  ASSERT_TRUE(until([&] { return building->one_waits(); }));
  std::thread ending([&] { session->shut_down(); });
  bool resumed = false;
  bool at_rest_while_busy = false;
  for (int i = 0; i < 1000 && !at_rest_while_busy; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    resumed = resumed || session->resume(session->stops());
    const StationView view = session->view();
    at_rest_while_busy =
        view.state == SafetyState::kStopped && view.at_rest && session->info()->geometry->revision == 1;
  }
  building.reset();
  EXPECT_TRUE(at_rest_while_busy);
  EXPECT_TRUE(session->held_stopped());
  ending.join();
  EXPECT_EQ(session->view().factor, 0.0);
}

TEST_F(SessionTest, CalibratingWhatNeedsNoneIsRefused) {
  start(with("simulated"));
  ASSERT_TRUE(until_running());
  using Step = WizardStep::Kind;
  for (const Step step :
       {Step::kBegin, Step::kMeasure, Step::kSkip, Step::kBack, Step::kGoTo, Step::kAbandon, Step::kWrite})
    EXPECT_THAT(calibrate(step, 3), HasSubstr("calibration"));
  EXPECT_EQ(session->info()->geometry->revision, 1U) << "the station went on";
  EXPECT_EQ(session->view().state, SafetyState::kRunning);
}

TEST(LaidOver, KeepsTheLastWordOfEachKeyAndForgetsWhatItReplaces) {
  const Overrides before = {{"a", "1"}, {"objects.0.size_mm", "5"}, {"objects.0.kind", "mug"}};
  EXPECT_THAT(laid_over(before, {{"a", "2"}}),
              ElementsAre(Pair("objects.0.size_mm", "5"), Pair("objects.0.kind", "mug"), Pair("a", "2")));
  EXPECT_THAT(laid_over(before, {{"objects.0", "{kind='box'}"}}),
              ElementsAre(Pair("a", "1"), Pair("objects.0", "{kind='box'}")));
  EXPECT_THAT(laid_over(before, {{"objects", ""}}), ElementsAre(Pair("a", "1")));
  EXPECT_THAT(laid_over(before, {{"object", ""}}), ::testing::SizeIs(3)) << "another key";
  const Overrides whole = {{"objects.0", "{kind='box'}"}};
  EXPECT_THAT([&] { static_cast<void>(laid_over(whole, {{"objects.0.size_mm", ""}})); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("reset objects.0")));
  EXPECT_THAT(laid_over(whole, {{"objects.0", ""}, {"objects.0.size_mm", ""}}), ::testing::IsEmpty());
  const Overrides sized = {{"objects.0", "{kind='box'}"}, {"objects.0.size_mm", "80"}};
  EXPECT_THAT(laid_over(sized, {{"objects.0.size_mm", ""}}), ElementsAre(Pair("objects.0", "{kind='box'}")));
  // As the page replaces an object: it resets the keys first.
  for (const Overrides& earlier : {whole, sized})
    EXPECT_THAT(laid_over(earlier, {{"objects.0.size_mm", ""}, {"objects.0", "{kind='key'}"}}),
                ElementsAre(Pair("objects.0", "{kind='key'}")));
}

TEST(ChangeKindOf, APatientHasToBeToldOfAnotherObject) {
  const auto kind = [](const char* key, HandSource source) {
    return change_kind({{key, "1"}}, source, {}, {});
  };
  EXPECT_EQ(kind("objects.0.size_mm", HandSource::kPatient), ChangeKind::kNewStation);
  EXPECT_EQ(kind("objects.0.size_mm", HandSource::kSliders), ChangeKind::kOtherObject);
  EXPECT_EQ(kind("objectsize", HandSource::kPatient), ChangeKind::kAtZeroTorque);
  EXPECT_EQ(kind("force.stiffness_n_per_mm", HandSource::kPatient), ChangeKind::kInContact);
  EXPECT_EQ(kind("rate_hz", HandSource::kSliders), ChangeKind::kNewStation);
}

TEST(ChangeKindOf, ThePlannedWristDependsOnTheObject) {
  SceneDescription held;
  held.grasp.type = GraspType::kSphere;
  const Overrides size = {{"objects.0.size_mm", "90"}};
  EXPECT_EQ(change_kind(size, HandSource::kSliders, held, held), ChangeKind::kNewStation);
  EXPECT_EQ(change_kind(size, HandSource::kSliders, held, {}), ChangeKind::kOtherObject);
}

TEST(ChangeKindOf, AMethodGoesOverInContactWhereBothBoundTheForcesChange) {
  const auto kind = [](const Overrides& changes, Stabiliser from, Stabiliser to) {
    SceneDescription in_force;
    SceneDescription wanted;
    in_force.parameters.stabiliser.method = from;
    wanted.parameters.stabiliser.method = to;
    return change_kind(changes, HandSource::kSliders, in_force, wanted);
  };
  const Overrides method = {{"stabiliser.method", "as wanted"}};
  EXPECT_EQ(kind(method, Stabiliser::kRiseOnly, Stabiliser::kNone), ChangeKind::kInContact);
  EXPECT_EQ(kind(method, Stabiliser::kNone, Stabiliser::kSmoothing), ChangeKind::kInContact);
  EXPECT_EQ(kind(method, Stabiliser::kLowPass, Stabiliser::kLowPass), ChangeKind::kInContact);
  EXPECT_EQ(kind(method, Stabiliser::kRiseOnly, Stabiliser::kLowPass), ChangeKind::kAtZeroTorque);
  EXPECT_EQ(kind(method, Stabiliser::kLocalWall, Stabiliser::kNone), ChangeKind::kAtZeroTorque);
  EXPECT_EQ(kind({{"stabiliser.method", "as wanted"}, {"force.law", "duffing"}}, Stabiliser::kRiseOnly,
                 Stabiliser::kNone),
            ChangeKind::kAtZeroTorque)
      << "of several the largest counts";
}

}  // namespace
}  // namespace phalanx
