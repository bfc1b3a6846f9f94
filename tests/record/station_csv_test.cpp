// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/station_csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using testing::read_file;
using testing::TemporaryFolder;

std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(std::count(line.begin(), line.end(), ',')) + 1;
}

FaultReport report_of_three_samples() {
  FaultReport report;
  report.event = {.fault = Fault::kJump, .channel = 2, .time = 1.5, .tick = 300, .from_device = false};
  report.device.name = "bench";
  report.device.serial = "A7";
  report.device.channels.resize(4);
  report.samples.resize(3);
  report.samples[2].raw[3] = -17;
  report.steps.resize(2);
  report.steps[1].command.torque[5] = 0.25;
  return report;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

/// The first row of a CSV text, by the names in its header.
std::map<std::string, std::string> first_row(const std::string& text) {
  std::istringstream lines(text);
  std::string header;
  std::string row;
  std::getline(lines, header);
  std::getline(lines, row);
  const std::vector<std::string> names = cells_of(header);
  const std::vector<std::string> values = cells_of(row);
  EXPECT_EQ(values.size(), names.size());
  std::map<std::string, std::string> by_name;
  for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) by_name[names[i]] = values[i];
  EXPECT_EQ(by_name.size(), names.size()) << "a name stands twice";
  for (const std::string& name : names)
    EXPECT_THAT(name, ::testing::MatchesRegex("[a-z][a-z0-9_]*")) << "a name in any programming language";
  return by_name;
}

/// A step that woke up 12.5 us late and took 340 us; every field has a number of its own.
StepRecord numbered_step() {
  StepRecord record{.input = {.time = 1.25, .late = true},
                    .command = {.tick = 300},
                    .lateness = 12.5e-6,
                    .duration = 340e-6,
                    .samples = 2,
                    .sample_sequence = 4001,
                    .sample_time_us = 1'249'750,
                    .state = SafetyState::kStopping,
                    .fault = Fault::kJump,
                    .factor = 0.75,
                    .status = static_cast<Status>(6),
                    .stiffness = 1400.0};
  for (std::size_t j = 0; j < kJoints; ++j) {
    record.command.torque[j] = 0.25 + static_cast<double>(j);
    record.angle[j] = -0.125 - static_cast<double>(j);
  }
  for (std::size_t d = 0; d < kDigits; ++d) record.force[d] = 100.5 + static_cast<double>(d);
  return record;
}

void expect_numbered_step(const std::map<std::string, std::string>& row) {
  EXPECT_EQ(row.at("tick"), "300");
  EXPECT_EQ(row.at("time_s"), "1.25");
  EXPECT_EQ(row.at("lateness_us"), "12.5") << "12.5e-6 s";
  EXPECT_EQ(row.at("duration_us"), "340.0") << "340e-6 s";
  EXPECT_EQ(row.at("overrun"), "1");
  EXPECT_EQ(row.at("samples"), "2");
  EXPECT_EQ(row.at("sample_sequence"), "4001");
  EXPECT_EQ(row.at("sample_time_us"), "1249750");
  EXPECT_EQ(row.at("state"), "stopping");
  EXPECT_EQ(row.at("fault"), "jump");
  EXPECT_EQ(row.at("factor"), "0.75");
  EXPECT_EQ(row.at("status"), "6");
  EXPECT_EQ(row.at("stiffness_n_per_m"), "1400") << "1.4 N/mm";
  // By hand: 13 columns that are not numbered, then digit d, joint j, joint j.
  EXPECT_EQ(row.size(), 13U + 5U + 20U + 20U);
  EXPECT_EQ(row.at("force_n_thumb"), "100.5");
  EXPECT_EQ(row.at("force_n_index"), "101.5");
  EXPECT_EQ(row.at("force_n_middle"), "102.5");
  EXPECT_EQ(row.at("force_n_ring"), "103.5");
  EXPECT_EQ(row.at("force_n_little"), "104.5");
  for (int j = 0; j < kJoints; ++j) {
    const std::string name(joint_name(j));
    EXPECT_EQ(row.at("torque_nm_" + name), std::to_string(j) + ".25");
    EXPECT_EQ(row.at("angle_rad_" + name), "-" + std::to_string(j) + ".125");
  }
}

TEST(StationCsv, EveryColumnOfAStepIsInTheUnitOfItsName) {
  const TemporaryFolder folder;
  OutputFile file(folder / "steps.csv");
  write_step_header(file);
  write_step(file, numbered_step());
  StepRecord in_time = numbered_step();
  in_time.input.late = false;
  write_step(file, in_time);
  file.commit();
  const std::string text = read_file(folder / "steps.csv");
  expect_numbered_step(first_row(text));
  EXPECT_NE(text.find("\n300,1.25,12.5,340.0,0,2,"), std::string::npos) << "the second step is in time";
}

LinkStatistics numbered_link() {
  return {.received = 901,
          .lost = 902,
          .outdated = 903,
          .corrupt = 904,
          .refused = 905,
          .overflowed = 906,
          .sent = 907,
          .device_corrupt = 908,
          .device_refused = 909,
          .device_outdated = 910};
}

void expect_numbered_link(const nlohmann::json& link) {
  EXPECT_EQ(link, (nlohmann::json{{"received", 901},
                                  {"lost", 902},
                                  {"outdated", 903},
                                  {"corrupt", 904},
                                  {"refused", 905},
                                  {"overflowed", 906},
                                  {"sent", 907},
                                  {"device_corrupt", 908},
                                  {"device_refused", 909},
                                  {"device_outdated", 910}}));
}

// The device counts microseconds, the host seconds: both columns are there, each in its own unit.
TEST(StationCsv, EveryColumnOfAFaultReportIsInTheUnitOfItsName) {
  const TemporaryFolder folder;
  FaultReport report;
  report.event = {.fault = Fault::kJump, .channel = 2, .time = 1.5, .tick = 300, .from_device = true};
  report.device.name = "bench";
  report.device.serial = "A7";
  report.device.channels.resize(3);
  DeviceSample sample{.sequence = 77,
                      .time_us = 2'500'000,
                      .received = 2.625,
                      .state = DeviceState::kFading,
                      .fault = Fault::kDrive,
                      .estop = true,
                      .factor = 0.375,
                      .acted_tick = 299};
  sample.raw = {-17, 18, 2'147'483'647};
  DeviceSample released = sample;
  released.estop = false;
  report.samples = {sample, released};
  report.steps = {numbered_step()};
  report.link = numbered_link();
  report.angle_origin[7] = AngleOrigin::kCompleted;
  const auto path = write_fault_report(folder.path(), report);

  EXPECT_EQ(read_file(path / "samples.csv"),
            "sequence,time_us,received_s,state,fault,estop,factor,acted_tick,raw_0,raw_1,raw_2\n"
            "77,2500000,2.625,4,drive,1,0.375,299,-17,18,2147483647\n"
            "77,2500000,2.625,4,drive,0,0.375,299,-17,18,2147483647\n");
  expect_numbered_step(first_row(read_file(path / "steps.csv")));

  auto json = nlohmann::json::parse(read_file(path / "report.json"));
  EXPECT_EQ(json["fault"], "jump");
  EXPECT_EQ(json["meaning"], fault_meaning(Fault::kJump));
  EXPECT_EQ(json["remedy"], fault_remedy(Fault::kJump));
  EXPECT_EQ(json["found_by"], "device");
  EXPECT_EQ(json["channel"], 2);
  EXPECT_EQ(json["host_time_s"], 1.5);
  EXPECT_EQ(json["tick"], 300);
  EXPECT_EQ(json["device"], (nlohmann::json{{"name", "bench"}, {"serial", "A7"}}));
  EXPECT_EQ(json["samples"], 2);
  EXPECT_EQ(json["steps"], 1);
  expect_numbered_link(json["link"]);
  EXPECT_FALSE(json["made"]["commit"].get<std::string>().empty());
  EXPECT_EQ(json["angle_origin"]["index_dip_flexion"], "completed");
  EXPECT_EQ(json["angle_origin"]["index_pip_flexion"], "unknown") << "not stated";
  EXPECT_EQ(json.size(), 13U) << "a field without a check";

  report.event.from_device = false;
  json = nlohmann::json::parse(read_file(write_fault_report(folder.path(), report) / "report.json"));
  EXPECT_EQ(json["found_by"], "host");
}

// By hand, of 10,000 durations: rank 5,000 is the one behind the first 4,999, rank 9,900 the last of the next
// 4,900, rank 9,990 among the next 95. A bin is [0.1 us 2^k, 1.0625 of that), so its middle is 0.103125 us
// 2^k; the largest is exact.
TEST(StationCsv, EveryNumberOfARunsSummaryIsInTheUnitOfItsName) {
  const auto add = [](Histogram& histogram, int count, double duration) {
    for (int i = 0; i < count; ++i) histogram.add(duration);
  };
  DeadlineStatistics deadlines;
  deadlines.period = 5e-3;
  deadlines.steps = 10'000;
  deadlines.overruns = 31;
  deadlines.overruns_in_row = 3;
  deadlines.longest_run = 7;
  deadlines.skipped = 41;
  add(deadlines.lateness, 4999, 1.65e-6);
  add(deadlines.lateness, 1, 3.3e-6);  // k = 5: the middle of [3.2, 3.4) us
  add(deadlines.lateness, 4900, 6.6e-6);
  add(deadlines.lateness, 95, 13.2e-6);
  add(deadlines.lateness, 5, 27e-6);
  add(deadlines.step, 4999, 52.8e-6);
  add(deadlines.step, 1, 105.6e-6);  // k = 10: the middle of [102.4, 108.8) us
  add(deadlines.step, 4900, 211.2e-6);
  add(deadlines.step, 95, 422.4e-6);
  add(deadlines.step, 4, 850e-6);
  StationView last;
  last.state = SafetyState::kFault;
  last.fault.fault = Fault::kNoSample;
  last.snapshot.angle_origin[7] = AngleOrigin::kFixed;
  const SessionStatistics session{.deadlines = deadlines, .link = numbered_link(), .records_lost = 43};
  const auto json = nlohmann::json::parse(station_summary_json(session, last, "SCHED_FIFO 80", 50.0));
  EXPECT_EQ(json["seconds"], 50.0);
  EXPECT_EQ(json["steps"], 10'000);
  EXPECT_NEAR(json["period_us"].get<double>(), 5000.0, 1e-9) << "5e-3 s";
  EXPECT_EQ(json["granted"], "SCHED_FIFO 80");
  const auto expect_durations = [](const nlohmann::json& durations, int count, double p50, double largest) {
    EXPECT_EQ(durations["count"], count);
    EXPECT_NEAR(durations["p50_us"].get<double>(), p50, 1e-9);
    EXPECT_NEAR(durations["p99_us"].get<double>(), 2.0 * p50, 1e-9);
    EXPECT_NEAR(durations["p999_us"].get<double>(), 4.0 * p50, 1e-9);
    EXPECT_NEAR(durations["max_us"].get<double>(), largest, 1e-9);
    EXPECT_EQ(durations.size(), 5U);
  };
  expect_durations(json["lateness"], 10'000, 3.3, 27.0);
  expect_durations(json["step"], 9'999, 105.6, 850.0);
  EXPECT_EQ(json["overruns"], 31);
  EXPECT_EQ(json["longest_run_of_overruns"], 7);
  EXPECT_EQ(json["skipped"], 41);
  EXPECT_EQ(json["records_lost"], 43);
  EXPECT_EQ(json["state"], "fault");
  EXPECT_EQ(json["fault"], "no_sample");
  expect_numbered_link(json["link"]);
  EXPECT_FALSE(json["made"]["commit"].get<std::string>().empty());
  EXPECT_EQ(json["angle_origin"]["index_dip_flexion"], "fixed");
  EXPECT_EQ(json["angle_origin"]["index_pip_flexion"], "unknown") << "not stated";
  EXPECT_EQ(json.size(), 15U) << "a field without a check";
}

TEST(StationCsv, EveryStepHasAsManyColumnsAsTheHeader) {
  const TemporaryFolder folder;
  OutputFile file(folder / "steps.csv");
  write_step_header(file);
  StepRecord record;
  record.command.torque[19] = 1.0 / 3.0;
  write_step(file, record);
  file.commit();
  std::istringstream lines(read_file(folder / "steps.csv"));
  std::string header;
  std::string row;
  std::getline(lines, header);
  std::getline(lines, row);
  EXPECT_EQ(columns(header), 13U + 5U + 20U + 20U);
  EXPECT_EQ(columns(row), columns(header));
  EXPECT_NE(row.find("0.3333333333333333"), std::string::npos);
}

TEST(StationCsv, AFaultReportSaysWhatAndHoldsEverySample) {
  const TemporaryFolder folder;
  const auto path = write_fault_report(folder.path(), report_of_three_samples());
  const auto json = nlohmann::json::parse(read_file(path / "report.json"));
  EXPECT_EQ(json["fault"], "jump");
  EXPECT_EQ(json["channel"], 2);
  EXPECT_EQ(json["device"]["serial"], "A7");
  const std::string samples = read_file(path / "samples.csv");
  EXPECT_EQ(std::count(samples.begin(), samples.end(), '\n'), 4);
  EXPECT_NE(samples.find(",-17\n"), std::string::npos);
  const std::string steps = read_file(path / "steps.csv");
  EXPECT_EQ(std::count(steps.begin(), steps.end(), '\n'), 3);
}

// 1,700,000,000 s after 1970 it was 22:13:20 on 14 November 2023 in UTC.
TEST(StationCsv, AReportsFolderIsNamedByItsTimeAndFaultAndNumberedFromTheSecondOn) {
  const char* const set = std::getenv("TZ");
  const std::string zone = set == nullptr ? "" : set;
  ::setenv("TZ", "UTC0", 1);
  ::tzset();
  const TemporaryFolder folder;
  constexpr std::time_t kNow = 1'700'000'000;
  std::vector<std::string> names;
  for (int i = 0; i < 3; ++i) {
    const auto path = write_fault_report(folder.path(), report_of_three_samples(), kNow);
    EXPECT_TRUE(std::filesystem::exists(path / "report.json"));
    names.push_back(path.filename().string());
  }
  set == nullptr ? ::unsetenv("TZ") : ::setenv("TZ", zone.c_str(), 1);
  ::tzset();
  const std::string name = "20231114-221320-" + std::string(fault_name(Fault::kJump));
  EXPECT_EQ(names, (std::vector<std::string>{name, name + "-2", name + "-3"}));
}

}  // namespace
}  // namespace phalanx
