// SPDX-License-Identifier: Apache-2.0
// A therapist's month by script: patient, calibration through the link, assessments, twelve sessions of
// training with a simulated participant that recovers slowly, assessments again. The registry equals what
// NumPy makes of the recordings.
#include <array>
#include <csignal>
#include <filesystem>

#include "apps/month/calibrated_device.h"
#include "apps/month/held_programs.h"
#include "apps/month/month_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

class CliMonth : public testing::MonthProgram {
 protected:
  /// Shows what was measured in the test's report.
  static void report(const nlohmann::json& compared) {
    fmt::print("{}\n", compared.dump());
    for (const char* key : {"recordings", "rows", "trials", "numbers", "largest"})
      RecordProperty(key, compared[key].dump());
  }
};

/// Done twice.
constexpr std::array kAssessments = {"entry_check",         "own_force",      "range_of_motion",
                                     "total_active_motion", "press_and_hold", "force_tracking",
                                     "squeeze_release",     "pinch",          "opposition",
                                     "independence",        "smoothness"};
/// Done once, since each takes ten minutes of the station.
constexpr std::array kOnce = {"feel_and_find", "object_in_hand"};

TEST_F(CliMonth, AnAssessmentAndATrainingAreWhatNumPyMakesOfThem) {
  testing::write_file(
      folder / "rom.toml",
      "format = 1\ntitle = \"Range\"\nkind = \"assessment\"\nmeasure = \"range_of_motion\"\n"
      "scene = \"wave\"\ndigits = \"index\"\ninstruction = \"Open, close, open.\"\ntrials = 1\n"
      "trial_s = 6\nrest_s = 0\n");
  testing::write_file(folder / "press.toml",
                      "format = 1\ntitle = \"Press\"\nkind = \"training\"\nmeasure = \"press_and_hold\"\n"
                      "scene = \"index_ball\"\ndigits = \"index\"\ninstruction = \"Press.\"\ntrials = 2\n"
                      "trial_s = 3\nrest_s = 1\nwarm_up_s = 0\ntarget = 0.4\n"
                      "[success]\nscore = \"time_in_target_share\"\nat_least = 0.3\n"
                      "[difficulty]\nstart = 0.3\ntolerance = [0.5, 0.1]\n");
  done_today(fmt::format(
      "patient add {} --side right --symbol boat --consent yes --entry-check 60,50 --own-force index=4",
      code_));
  session("./rom.toml", 0.6, 1);
  session("./press.toml", 0.6, 2);
  const nlohmann::json compared = compare();
  ASSERT_FALSE(compared.empty());
  EXPECT_EQ(compared["rows"], 2);
  EXPECT_EQ(compared["trials"], 3);
  EXPECT_GT(compared["numbers"], 30);
}

TEST_F(CliMonth, ASimulatedDeviceBehindTheLinkServesNoPerson) {
  code_ = "M07";
  done_today(fmt::format(
      "patient add {} --side right --symbol boat --consent yes --entry-check 60,50 --own-force index=4",
      code_));
  testing::HeldPrograms programs(folder.path(), environment());
  const auto device = programs.start_device("device.txt");
  const auto run = programs.start(
      exercise_command(fmt::format("train_press --seed 1 --device {}", programs.address())), "run.txt");
  EXPECT_EQ(programs.wait(*run, 60.0), 2) << run->output() << run->errors();
  EXPECT_THAT(run->errors(), AllOf(HasSubstr("M07"), HasSubstr("never join those of a person")));
  device->signal(SIGINT);
  EXPECT_EQ(programs.wait(*device, 10.0), 0) << device->errors();
  EXPECT_THAT(recordings(), SizeIs(0));
  EXPECT_THAT(results(), SizeIs(0));
}

TEST_F(CliMonth, TheRegistryIsWhatNumPyMakesOfTheRecordings) {
  done_today(fmt::format(
      "patient add {} --side right --symbol boat --consent yes --prescribe 'train_press trials=4'", code_));
  // Day 1: the device is calibrated through the link, and its file is the patient's.
  const testing::CalibratedDevice device = testing::calibrate_through_the_link(folder, environment());
  ASSERT_EQ(device.exit_code, 0) << device.said;
  EXPECT_LT(device.largest_error, 0.02) << "a goniometer is read in whole degrees";
  done_today(
      fmt::format("patient edit {} --calibration {} --expires 2026-03-28", code_, device.file.string()));
  EXPECT_THAT(done_today(fmt::format("patient show {}", code_)), HasSubstr("goniometer"));
  int seed = 1;
  double hour = 9.0;
  for (const char* assessment : kAssessments) {
    set_date(1, hour += 0.25);
    session(assessment, 0.3, seed++);
  }
  EXPECT_THAT(done_today(fmt::format("patient show {}", code_)),
              AllOf(HasSubstr("own range:"), HasSubstr("own force:")));
  // Twelve sessions, three a week, by a participant that recovers slowly.
  constexpr std::array kTrainings = {2, 4, 6, 9, 11, 13, 16, 18, 20, 23, 25, 27};
  double skill = 0.3;
  for (const int day : kTrainings) {
    set_date(day);
    session("train_press", skill += 0.04, seed++);
  }
  hour = 9.0;
  for (const char* assessment : kAssessments) {
    set_date(28, hour += 0.25);
    session(assessment, skill, seed++);
  }
  for (const char* assessment : kOnce) {
    set_date(28, hour += 0.25);
    session(assessment, skill, seed++);
  }
  const std::size_t exercises = 2 * kAssessments.size() + kOnce.size() + kTrainings.size();
  ASSERT_THAT(recordings(), SizeIs(exercises));
  const nlohmann::json compared = compare();
  ASSERT_FALSE(compared.empty());
  EXPECT_EQ(compared["rows"], exercises);
  EXPECT_EQ(compared["valid"], exercises);
  EXPECT_THAT(compared["measures"], SizeIs(kAssessments.size() + kOnce.size()));
  report(compared);
  // The day after its last day the calibration is refused.
  set_date(29);
  const auto refused = exercise("train_press --demo 0.8 --seed 1");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("was valid until 2026-03-28"));
  // The recordings are the truth: the same rows from them alone.
  const nlohmann::json rows = results();
  rebuild();
  EXPECT_EQ(results(), rows);
  const std::string trend = done_today(fmt::format("patient trend {}", code_));
  EXPECT_THAT(trend, AllOf(HasSubstr("change not proven"), HasSubstr("2026-03-01"), HasSubstr("2026-03-28")));
  EXPECT_THAT(trend, HasSubstr("train_press, training: "));
}

}  // namespace
}  // namespace phalanx
