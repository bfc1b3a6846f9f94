// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/summary.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::size_t kIndexDistal = 5;

Summary two_ticks() {
  Summary summary;
  Snapshot a;
  a.time_s = 0.25;
  a.segment[kIndexDistal] = {.contact = true, .depth = 2e-3, .force = 1.5};
  a.segment[0] = {.contact = true, .force = 1.0};
  a.torque[4] = -0.08;
  a.status = Status::kForceLimited | Status::kSampleJump;
  Snapshot b;
  b.time_s = 0.255;
  b.segment[kIndexDistal] = {.contact = true, .depth = 1e-3, .force = 2.0, .slid = 6e-3};
  b.torque[4] = 0.05;
  b.status = Status::kSlid | Status::kForceLimited;
  add_tick(summary, a);
  add_tick(summary, b);
  return summary;
}

TEST(Summary, CountsTicksAndKeepsPeaks) {
  const Summary summary = two_ticks();
  EXPECT_EQ(summary.ticks, 2U);
  EXPECT_EQ(summary.contact_ticks[kIndexDistal], 2U);
  EXPECT_EQ(summary.contact_ticks[0], 1U);
  EXPECT_EQ(summary.peak_force[kIndexDistal], 2.0);
  EXPECT_EQ(summary.peak_depth[kIndexDistal], 2e-3);
  EXPECT_EQ(summary.peak_torque[4], 0.08);
  EXPECT_EQ(summary.peak_total_force, 2.5);
  EXPECT_EQ(summary.peak_total_force_time_s, 0.25);
}

TEST(Summary, OfNoTicksIsNothing) {
  const Summary summary{};
  EXPECT_EQ(summary.ticks, 0U);
  EXPECT_EQ(summary.rate_hz, 0.0);
  EXPECT_EQ(summary.seconds, 0.0);
  EXPECT_EQ(summary.hand_triangles, 0);
  EXPECT_EQ(summary.object_triangles, 0);
  EXPECT_EQ(summary.peak_total_force, 0.0);
  EXPECT_EQ(summary.peak_total_force_time_s, 0.0);
  EXPECT_EQ(summary.largest_slid, 0.0);
}

TEST(Summary, ThePeakForcesTimeIsThatOfItsFirstTick) {
  Summary summary;
  for (const double time : {0.25, 0.255}) {
    Snapshot snapshot;
    snapshot.time_s = time;
    snapshot.segment[kIndexDistal] = {.contact = true, .force = 2.0};
    add_tick(summary, snapshot);
  }
  EXPECT_EQ(summary.peak_total_force, 2.0);
  EXPECT_EQ(summary.peak_total_force_time_s, 0.25);
}

TEST(Summary, ReportsLimitersByTheTicksInWhichTheyActed) {
  const auto activity = limiters(two_ticks());
  EXPECT_STREQ(activity[0].name, "fingertip_force");
  EXPECT_EQ(activity[0].ticks, 2U);
  EXPECT_STREQ(activity[3].name, "joint_speed");
  EXPECT_EQ(activity[3].ticks, 1U);
  EXPECT_EQ(activity[1].ticks + activity[2].ticks, 0U);
}

// Torques were limited in two ticks, their rate in three; a contact slid in two.
TEST(Summary, TellsEachLimiterByItsTicksAndTheKeyThatSetsIt) {
  Summary summary;
  for (const Status status :
       {Status::kTorqueLimited | Status::kTorqueRateLimited, Status::kTorqueLimited | Status::kSlid,
        Status::kTorqueRateLimited | Status::kSlid, Status::kTorqueRateLimited}) {
    Snapshot snapshot;
    snapshot.status = status;
    add_tick(summary, snapshot);
  }
  const auto activity = limiters(summary);
  EXPECT_EQ(activity[0].ticks, 0U);
  EXPECT_STREQ(activity[1].name, "joint_torque");
  EXPECT_STREQ(activity[1].key, "limits.joint_torque_nm");
  EXPECT_EQ(activity[1].ticks, 2U);
  EXPECT_STREQ(activity[2].name, "torque_rate");
  EXPECT_STREQ(activity[2].key, "limits.torque_rate_nm_per_s");
  EXPECT_EQ(activity[2].ticks, 3U);
  EXPECT_THAT(warnings(summary), ElementsAre(HasSubstr("2 ticks: a contact slid")));
}

TEST(Summary, WarnsOfWhatMakesTheResultLessThanItLooks) {
  EXPECT_THAT(warnings(two_ticks()), ElementsAre(HasSubstr("1 tick: a measured angle moved faster"),
                                                 HasSubstr("slid, up to 6.0 mm")));
}

TEST(Summary, NamesEachDigitThatGivesNoForceSinceItStartedInside) {
  Summary summary;
  for (int tick = 0; tick < 3; ++tick) {
    Snapshot snapshot;
    snapshot.status = Status::kStartInside;
    snapshot.opening[1].phase = OpeningPhase::kUnconfirmed;
    if (tick == 0) snapshot.opening[3].phase = OpeningPhase::kConfirmed;
    add_tick(summary, snapshot);
  }
  EXPECT_EQ(summary.inside_ticks, (std::array<std::uint64_t, kDigits>{0, 3, 0, 1, 0}));
  EXPECT_THAT(warnings(summary),
              ElementsAre(HasSubstr("3 ticks: index (3 ticks), ring (1 tick) started inside")));
}

TEST(Summary, WarnsOfNothingInACleanRun) {
  Summary summary;
  add_tick(summary, Snapshot{});
  EXPECT_THAT(warnings(summary), IsEmpty());
}

// A limit that acts does its work; every other bit has a sentence.
TEST(Summary, HasAWarningForEveryStatusThatIsNotALimit) {
  for (int bit = 0; bit < kStatusBits; ++bit) {
    Summary summary;
    Snapshot snapshot;
    snapshot.status = static_cast<Status>(1U << bit);
    add_tick(summary, snapshot);
    const bool limit =
        has(snapshot.status, Status::kForceLimited | Status::kTorqueLimited | Status::kTorqueRateLimited);
    EXPECT_EQ(warnings(summary).size(), limit ? 0U : 1U) << status_name(bit);
  }
}

TEST(SummaryJson, HoldsWhatTheDocumentationPromises) {
  Summary summary = two_ticks();
  summary.scene = "grasp \"teapot\"";
  summary.rate_hz = 200.0;
  summary.seconds = 0.01;
  summary.hand_triangles = 2248;
  summary.object_triangles = 992;
  summary.step_us = {.p50 = 1, .p90 = 2, .p99 = 3, .p999 = 4, .max = 5};
  summary.notes = {"a note"};
  summary.made = {.commit = "c", .cpu = "x", .compiler = "g", .build_type = "Release", .date = "d"};
  const auto json = nlohmann::json::parse(summary_json(summary));
  EXPECT_EQ(json["scene"], "grasp \"teapot\"");
  EXPECT_EQ(json["ticks"], 2);
  EXPECT_EQ(json["rate_hz"], 200.0);
  EXPECT_EQ(json["triangles"]["hand"], 2248);
  EXPECT_EQ(json["triangles"]["object"], 992);
  EXPECT_EQ(json["step_us"]["p999"], 4.0);
  EXPECT_EQ(json["contact_ticks"].size(), static_cast<std::size_t>(kSegments));
  EXPECT_EQ(json["contact_ticks"]["index-finger-phalanx-distal"], 2);
  EXPECT_EQ(json["peak_force_n"]["index-finger-phalanx-distal"], 2.0);
  EXPECT_EQ(json["peak_torque_nm"].size(), static_cast<std::size_t>(kJoints));
  EXPECT_EQ(json["peak_torque_nm"]["index_mcp_flexion"], 0.08);
  EXPECT_EQ(json["limiter_ticks"]["fingertip_force"], 2);
  EXPECT_EQ(json["status_ticks"]["slid"], 1);
  EXPECT_EQ(json["status_ticks"].size(), static_cast<std::size_t>(kStatusBits));
  EXPECT_EQ(json["warnings"].size(), 3U);
  EXPECT_EQ(json["made"]["commit"], "c");
}

// Every field of summary.json, each with a number of its own.
TEST(SummaryJson, EveryFieldIsInTheUnitOfItsName) {
  Summary summary = two_ticks();
  summary.scene = "press";
  summary.rate_hz = 200.0;
  summary.seconds = 0.01;
  summary.hand_triangles = 2248;
  summary.object_triangles = 992;
  summary.step_us = {.p50 = 1.5, .p90 = 2.5, .p99 = 3.5, .p999 = 4.5, .max = 5.5, .mean = 6.5};
  summary.made = {.commit = "c", .cpu = "x", .compiler = "g", .build_type = "Release", .date = "d"};
  const auto json = nlohmann::json::parse(summary_json(summary));
  const auto number = [](double value) { return nlohmann::json(value); };
  EXPECT_EQ(json["seconds"], number(0.01));
  EXPECT_EQ(json["step_us"],
            (nlohmann::json{{"p50", 1.5}, {"p90", 2.5}, {"p99", 3.5}, {"p999", 4.5}, {"max", 5.5}}));
  // 1.5 N on the fingertip and 1.0 N on the thumb at once, at 0.25 s; later 2.0 N alone.
  EXPECT_EQ(json["peak_total_force"], (nlohmann::json{{"force_n", 2.5}, {"time_s", 0.25}}));
  EXPECT_EQ(json["contact_ticks"]["thumb-metacarpal"], 1);
  EXPECT_EQ(json["peak_force_n"]["thumb-metacarpal"], number(1.0));
  EXPECT_EQ(json["peak_force_n"].size(), static_cast<std::size_t>(kSegments));
  EXPECT_EQ(
      json["limiter_ticks"],
      (nlohmann::json{{"fingertip_force", 2}, {"joint_torque", 0}, {"torque_rate", 0}, {"joint_speed", 1}}));
  EXPECT_EQ(json["status_ticks"]["force_limited"], 2);
  EXPECT_EQ(json["status_ticks"]["sample_jump"], 1);
  EXPECT_EQ(json["made"],
            (nlohmann::json{
                {"commit", "c"}, {"cpu", "x"}, {"compiler", "g"}, {"build_type", "Release"}, {"date", "d"}}));
  EXPECT_EQ(json["angle_origin"].size(), static_cast<std::size_t>(kJoints));
  EXPECT_EQ(json.size(), 15U) << "a field without a check";
}

TEST(SummaryJson, MarksJointsThatAreNotMeasured) {
  Summary summary;
  Snapshot snapshot;
  snapshot.angle_origin[7] = AngleOrigin::kCompleted;
  snapshot.angle_origin[5] = AngleOrigin::kFixed;
  snapshot.angle_origin[6] = AngleOrigin::kMeasured;
  add_tick(summary, snapshot);
  const auto json = nlohmann::json::parse(summary_json(summary))["angle_origin"];
  EXPECT_EQ(json["index_dip_flexion"], "completed");
  EXPECT_EQ(json["index_mcp_abduction"], "fixed");
  EXPECT_EQ(json["index_pip_flexion"], "measured");
  EXPECT_EQ(json["index_mcp_flexion"], "unknown");
}

// A torque of -0.08 Nm is larger than one of 0.05 Nm that comes after it, and smaller than one of 0.09 Nm.
TEST(Summary, ThePeakTorqueIsTheLargestWhicheverItsSign) {
  Summary summary = two_ticks();
  EXPECT_EQ(summary.peak_torque[4], 0.08);
  Snapshot later;
  later.torque[4] = 0.09;
  add_tick(summary, later);
  EXPECT_EQ(summary.peak_torque[4], 0.09);
}

TEST(MadeHere, FillsEveryField) {
  const Made made = made_here();
  EXPECT_FALSE(made.commit.empty());
  EXPECT_FALSE(made.cpu.empty());
  EXPECT_THAT(made.compiler, ::testing::AnyOf(HasSubstr("GCC "), HasSubstr("Clang ")));
  EXPECT_THAT(made.date, ::testing::MatchesRegex("20[0-9]+-[0-9]+-[0-9]+T[0-9]+:[0-9]+:[0-9]+Z"));
}

}  // namespace
}  // namespace phalanx
