// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/station_csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

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
  report.steps[1].torque[5] = 0.25;
  return report;
}

TEST(StationCsv, EveryStepHasAsManyColumnsAsTheHeader) {
  const TemporaryFolder folder;
  OutputFile file(folder / "steps.csv");
  write_step_header(file);
  StepRecord record;
  record.torque[19] = 1.0 / 3.0;
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

TEST(StationCsv, TwoReportsOfTheSameSecondDoNotShareAFolder) {
  const TemporaryFolder folder;
  const auto first = write_fault_report(folder.path(), report_of_three_samples());
  const auto second = write_fault_report(folder.path(), report_of_three_samples());
  EXPECT_NE(first, second);
  EXPECT_TRUE(std::filesystem::exists(first / "report.json"));
  EXPECT_TRUE(std::filesystem::exists(second / "report.json"));
}

}  // namespace
}  // namespace phalanx
