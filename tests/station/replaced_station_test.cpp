// SPDX-License-Identifier: Apache-2.0
// Session::replace(): a whole station in place of the one that runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>

#include "record/temporary_folder.h"
#include "station/session_fixture.h"

namespace phalanx {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

class ReplacedStation : public test::SessionFixture {
 protected:
  std::string replace(const StationOrder& order) {
    return ask([&](Session::Done done) { session->replace(order, std::move(done)); });
  }
  /// @returns the setups of the stations, as a recorder would fetch them
  std::vector<SessionChange> beginnings() const {
    std::vector<SessionChange> all;
    for (SessionChange change; session->next_change(change);)
      if (change.number == 0) all.push_back(change);
    return all;
  }
  const testing::TemporaryFolder folder;
};

TEST_F(ReplacedStation, HasTheOrdersSceneValuesAndSourceAndNothingOfTheOneBefore) {
  SessionSettings settings = with("sliders");
  settings.keep_changes = true;
  start(settings);
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  const std::uint64_t before = session->view().station;
  EXPECT_EQ(replace({.scene = "pinch_ball",
                     .overrides = {{"force.law", "kelvin_voigt"}, {"rate_hz", "250"}, {"rate_hz", "500"}},
                     .source = HandSource::kPatient,
                     .recording = 7}),
            "");
  const auto info = session->info();
  EXPECT_EQ(info->scene, "pinch_ball");
  EXPECT_THAT(info->overrides, ElementsAre(Pair("force.law", "kelvin_voigt"), Pair("rate_hz", "500")))
      << "the newest value of a key counts; those of the station before do not";
  EXPECT_EQ(info->geometry->rate_hz, 500.0);
  EXPECT_EQ(info->source, HandSource::kPatient);
  EXPECT_EQ(info->calibration, "");
  EXPECT_EQ(info->range, "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->view().station, before + 1);
  EXPECT_EQ(replace({.scene = "pinch_ball"}), "");
  EXPECT_EQ(session->info()->source, HandSource::kPatient) << "an order without a source leaves it";
  EXPECT_THAT(session->info()->overrides, IsEmpty());
  session->shut_down();
  const auto began = beginnings();
  ASSERT_EQ(began.size(), 3U);
  EXPECT_EQ(began[0].recording, 0U);
  EXPECT_EQ(began[1].recording, 7U);
  EXPECT_EQ(began[1].station, before + 1);
  EXPECT_EQ(began[1].last_station, before);
  EXPECT_EQ(began[2].recording, 0U);
}

TEST_F(ReplacedStation, OfEqualValuesIsANewStationUnlessTheOrderLeavesIt) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  const std::uint64_t first = session->view().station;
  EXPECT_EQ(replace({.scene = "first_touch", .always = false}), "");
  pass(0.5);
  EXPECT_EQ(session->view().station, first);
  EXPECT_FALSE(session->held_stopped());
  EXPECT_EQ(replace({.scene = "first_touch", .always = false, .stopped = true}), "");
  EXPECT_EQ(session->view().station, first);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_TRUE(session->resume());
  EXPECT_EQ(replace({.scene = "first_touch"}), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->view().station, first + 1);
  EXPECT_EQ(replace({.scene = "first_touch", .always = false, .recording = 1}), "");
  ASSERT_TRUE(until_running());
  EXPECT_EQ(session->view().station, first + 2) << "a recording begins with a station of its own";
}

TEST_F(ReplacedStation, RefusedLeavesTheOneThatRunsAndItsTorque) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.75"}}), "");
  const std::uint64_t first = session->view().station;
  const auto before = session->info();
  const std::string no_calibration = folder / "calibration.toml";
  const std::string broken = folder / "broken.toml";
  std::ofstream(broken) << "format = 9\n";
  records.clear();
  EXPECT_THAT(replace({.scene = "no_such_scene", .stopped = true}), HasSubstr("no_such_scene"));
  EXPECT_THAT(replace({.scene = "pinch_ball", .calibration = no_calibration, .stopped = true}),
              HasSubstr("calibration.toml"));
  EXPECT_THAT(replace({.scene = "pinch_ball", .range = broken, .stopped = true}), HasSubstr("broken.toml"));
  EXPECT_THAT(replace({.scene = "pinch_ball", .overrides = {{"rate_hz", "7"}}, .stopped = true}),
              HasSubstr("rate_hz"));
  EXPECT_THAT(replace({.scene = "pinch_ball", .source = HandSource::kDevice, .stopped = true}),
              HasSubstr("--device"));
  pass(0.5);
  EXPECT_FALSE(session->held_stopped()) << "the order would have stopped it";
  EXPECT_EQ(session->stops(), 0U);
  EXPECT_EQ(session->info()->scene, before->scene);
  EXPECT_EQ(session->info()->values, before->values);
  EXPECT_EQ(session->info()->overrides, before->overrides);
  ASSERT_FALSE(records.empty());
  for (const StepRecord& record : records) {
    EXPECT_EQ(record.station, first);
    EXPECT_EQ(record.state, SafetyState::kRunning);
  }
}

TEST_F(ReplacedStation, BeginsStoppedIfItWasStoppedOrIfTheOrderStopsIt) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  const std::uint64_t first = session->view().station;
  session->stop();
  EXPECT_EQ(replace({.scene = "pinch_ball"}), "");
  pass(1.0);
  EXPECT_EQ(session->stops(), 1U);
  EXPECT_TRUE(session->resume(1));
  ASSERT_TRUE(until_running());
  EXPECT_EQ(replace({.scene = "first_touch", .stopped = true}), "");
  EXPECT_EQ(session->stops(), 2U) << "a resume of before does not end it";
  EXPECT_FALSE(session->resume(1));
  pass(1.0);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->view().state, SafetyState::kStopped);
  std::size_t running = 0;
  for (const StepRecord& record : records) {
    running += record.station == first + 1 && record.state == SafetyState::kRunning ? 1U : 0U;
    if (record.station != first + 2) continue;
    EXPECT_EQ(record.factor, 0.0);
    for (const double torque : record.command.torque) EXPECT_EQ(torque, 0.0);
  }
  EXPECT_GT(running, 0U) << "else the test would show nothing";
}

// A stop comes at an arbitrary time of the change: before it is begun, while the scene is built, between the two
// stations, or after it.
TEST_F(ReplacedStation, AStopAtAnyTimeOfTheChangeHoldsOverIt) {
  constexpr std::uint64_t kSeed = 251;
  std::mt19937_64 random(kSeed);
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  bool during = false;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    const double wait = 1e-3 * static_cast<double>(random() % 600);
    auto [answer, done] = awaited();
    const auto got = answer;
    session->replace({.scene = i % 2 == 0 ? "pinch_ball" : "first_touch"}, done);
    pass(wait);
    during = during || !got->refused.has_value();
    session->stop();
    const double stopped = clock.now();
    ASSERT_TRUE(until([&] { return got->refused.has_value(); }));
    EXPECT_EQ(*got->refused, "");
    pass(1.5);
    for (const StepRecord& record : records) {
      if (record.input.time <= stopped) continue;
      ASSERT_NE(record.state, SafetyState::kRunning);
    }
    EXPECT_EQ(session->view().factor, 0.0);
    EXPECT_TRUE(session->held_stopped());
    records.clear();
    ASSERT_TRUE(session->resume());
    ASSERT_TRUE(until_running());
  }
  EXPECT_TRUE(during) << "no stop came while a station was replaced";
}

TEST_F(ReplacedStation, AfterAFaultBeginsStopped) {
  start(with("sliders"));
  ASSERT_TRUE(until_running());
  overload();
  records.clear();
  EXPECT_EQ(replace({.scene = "pinch_ball"}), "");
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  for (const StepRecord& record : records)
    for (const double torque : record.command.torque) EXPECT_EQ(torque, 0.0);
  EXPECT_TRUE(session->resume());
  EXPECT_TRUE(until_running());
}

}  // namespace
}  // namespace phalanx
