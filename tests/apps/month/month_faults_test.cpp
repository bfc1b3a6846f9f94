// SPDX-License-Identifier: Apache-2.0
// The month again, with faults: link cut, device lost, program killed and interrupted, date set back, disk
// full, database lost. No exercise is lost or doubled, and what may not be scored has no score.
#include <algorithm>
#include <csignal>
#include <filesystem>

#include "apps/month/calibrated_device.h"
#include "apps/month/month_program.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr double kLongest = 600.0;  // time of the clock within which an exercise ends [s]

class CliMonthFaults : public testing::MonthProgram {
 protected:
  using Process = std::unique_ptr<testing::ChildProcess>;

  /// Adds a patient with a calibration that is measured through the link.
  /// @param more  further options of `patient add`
  void add_patient(const std::string& more) {
    done_today(fmt::format(
        "patient add {} --side right --symbol boat --consent yes --prescribe 'train_press trials=4' {}",
        code_, more));
    const testing::CalibratedDevice device = testing::calibrate_through_the_link(folder, environment());
    ASSERT_EQ(device.exit_code, 0) << device.said;
    done_today(
        fmt::format("patient edit {} --calibration {} --expires 2026-04-30", code_, device.file.string()));
  }

  /// Begins a training, and lets time pass until one of its trials runs.
  /// @param arguments  --demo or --device
  Process begun(testing::HeldPrograms& programs, const std::string& arguments) {
    Process run = programs.start(
        exercise_command(fmt::format("train_press --seed {} {}", seed_++, arguments)), "run.txt");
    EXPECT_TRUE(programs.says(*run, "recording: ", 60.0)) << run->errors();
    EXPECT_TRUE(programs.says(*run, "Rest. The next trial comes.", 200.0)) << run->output() << run->errors();
    programs.pass(6.5);  // 4 s of rest, and the ramp
    EXPECT_FALSE(run->ended()) << run->output() << run->errors();
    return run;
  }
  /// Lets a training that a fault has paused go on to its end. Its result must be kept.
  void go_on(testing::HeldPrograms& programs, testing::ChildProcess& run) const {
    ASSERT_TRUE(programs.says(run, "FAULT", 10.0)) << run.output() << run.errors();
    run.type("reset");
    programs.pass(2.0);
    run.type("resume");
    EXPECT_EQ(programs.wait(run, kLongest), 0) << run.output() << run.errors();
    EXPECT_THAT(run.output(), HasSubstr(fmt::format("kept in the registry for {}", code_)));
  }
  /// @returns the recording that was written last. Its name may be an earlier one: the date was set back.
  [[nodiscard]] std::string newest_recording() const {
    const std::vector<std::string> all = recordings();
    return *std::max_element(all.begin(), all.end(), [this](const std::string& a, const std::string& b) {
      return fs::last_write_time(folder / a) < fs::last_write_time(folder / b);
    });
  }
  /// @returns the row of the newest recording, which must be the only one
  [[nodiscard]] nlohmann::json newest_row() const {
    const nlohmann::json rows = rows_of(newest_recording());
    EXPECT_THAT(rows, SizeIs(1)) << newest_recording();
    return rows.empty() ? nlohmann::json::object() : rows.front();
  }
  /// @returns the trials of a row that have a reason not to be scored
  static int invalid_trials(const nlohmann::json& row) {
    int count = 0;
    const auto detail = nlohmann::json::parse(row["detail"].get<std::string>());
    for (const auto& trial : detail["trials"]) count += trial.contains("invalid") ? 1 : 0;
    return count;
  }

  int seed_ = 1;
};

TEST_F(CliMonthFaults, ALinkThatIsCutAndADeviceThatIsLostMakeTrialsInvalid) {
  add_patient("--entry-check 60,50 --own-force index=4");
  set_date(2);
  {
    testing::HeldPrograms programs(folder.path(), environment());
    const Process device = programs.start_device("device.txt");
    const Process run = begun(programs, "--device " + programs.address());
    ASSERT_FALSE(HasFailure());
    device->signal(SIGSTOP);
    programs.pass(3.0);
    device->signal(SIGCONT);
    go_on(programs, *run);
  }
  const nlohmann::json cut = newest_row();
  EXPECT_EQ(cut["conditions"]["calibration_method"], "goniometer+jig") << cut["conditions"];
  EXPECT_FALSE(cut["interrupted"]);
  EXPECT_GE(invalid_trials(cut), 1) << cut["detail"];
  set_date(4);
  {
    testing::HeldPrograms programs(folder.path(), environment());
    Process device = programs.start_device("device.txt");
    const std::string port = programs.port();
    const Process run = begun(programs, "--device " + programs.address());
    ASSERT_FALSE(HasFailure());
    device->signal(SIGKILL);
    programs.pass(3.0);
    device = programs.start_device("device2.txt", port);
    go_on(programs, *run);
  }
  const nlohmann::json lost = newest_row();
  EXPECT_GE(invalid_trials(lost), 1) << lost["detail"];
  const nlohmann::json rows = results();
  rebuild();
  EXPECT_EQ(results(), rows);
  const nlohmann::json compared = compare();
  ASSERT_FALSE(compared.empty());
  EXPECT_EQ(compared["rows"], 2);
  fmt::print("{}\n", compared.dump());
}

TEST_F(CliMonthFaults, TheMonthWithFaultsLosesAndDoublesNothing) {
  add_patient("");
  std::size_t exercises = 4;
  for (const char* assessment : {"entry_check", "own_force", "range_of_motion", "press_and_hold"})
    session(assessment, 0.4, seed_++);
  const auto trained = [&](int day) {
    set_date(day);
    session("train_press", 0.4 + 0.01 * day, seed_++);
    ++exercises;
  };
  trained(2);
  // The program is killed in the middle of an exercise: the next run makes its row from the recording, for the dose.
  set_date(4);
  {
    testing::HeldPrograms programs(folder.path(), environment());
    const Process run = begun(programs, "--demo 0.4");
    ASSERT_FALSE(HasFailure());
    run->signal(SIGKILL);
    ++exercises;
  }
  const std::string left = newest_recording();
  EXPECT_THAT(rows_of(left), SizeIs(0)) << "the program could not add it";
  trained(4);
  const nlohmann::json killed = rows_of(left);
  ASSERT_THAT(killed, SizeIs(1)) << left;
  EXPECT_FALSE(killed.front()["valid"]);
  EXPECT_THAT(killed.front()["invalid"].get<std::string>(), HasSubstr("ends before the exercise"));
  // It is interrupted: it ends at zero torque, and keeps an interrupted result.
  set_date(6);
  {
    testing::HeldPrograms programs(folder.path(), environment());
    const Process run = begun(programs, "--demo 0.4");
    run->signal(SIGINT);
    EXPECT_TRUE(programs.wait(*run, 30.0)) << run->output() << run->errors();
    EXPECT_THAT(run->output(), HasSubstr("kept in the registry"));
    ++exercises;
  }
  EXPECT_TRUE(newest_row()["interrupted"]);
  // The date is set back by two hours in the middle: times of trials are those of the station, and the next
  // recording has another name.
  set_date(9, 12.0);
  {
    testing::HeldPrograms programs(folder.path(), environment());
    const Process run = begun(programs, "--demo 0.4");
    set_date(9, 10.0);
    EXPECT_EQ(programs.wait(*run, kLongest), 0) << run->output() << run->errors();
    ++exercises;
  }
  const nlohmann::json back = newest_row();
  EXPECT_TRUE(back["valid"]) << back["invalid"];
  EXPECT_EQ(back["repetitions"], 4);
  trained(9);
  set_date(9, 12.0);  // the names of the recordings of that hour are taken
  session("train_press", 0.5, seed_++);
  ++exercises;
  // The disk takes no more: the recording has no end.
  set_date(11);
  const auto full = exercise(fmt::format("train_press --demo 0.5 --seed {}", seed_++), "ulimit -f 1000");
  ++exercises;
  EXPECT_EQ(full.exit_code, 1) << full.out;
  EXPECT_THAT(full.err, HasSubstr("the recording cannot be ended"));
  // The database is lost.
  EXPECT_TRUE(fs::exists(folder / "data/registry.sqlite"));
  for (const char* file : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
    fs::remove(folder / "data" / file);
  rebuild();
  trained(13);
  done_today("patient backup saved");
  trained(16);
  // The whole data folder is lost. What is newer than the backup comes from the recordings.
  const nlohmann::json before = results();
  fs::remove_all(folder / "data");
  done_today("patient restore saved");
  rebuild();
  EXPECT_EQ(results(), before);
  set_date(28);
  for (const char* assessment : {"range_of_motion", "press_and_hold"}) {
    session(assessment, 0.7, seed_++);
    ++exercises;
  }
  EXPECT_THAT(recordings(), SizeIs(exercises));
  const nlohmann::json compared = compare();
  ASSERT_FALSE(compared.empty());
  EXPECT_EQ(compared["rows"], exercises);
  EXPECT_EQ(compared["valid"], exercises - 2) << "all but those whose recording has no end";
  fmt::print("{}\n", compared.dump());
}

}  // namespace
}  // namespace phalanx
