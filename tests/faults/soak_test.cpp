// SPDX-License-Identifier: Apache-2.0
// The station for longer, in real time at 1 kHz: no fault.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/utsname.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "faults/child_process.h"
#include "faults/two_processes.h"
#include "record/temporary_folder.h"

namespace phalanx::testing {
namespace {

std::string kernel() {
  utsname name{};
  ::uname(&name);
  return std::string(name.release) + " " + name.version;
}

void expect_no_fault(ChildProcess& host, const TemporaryFolder& folder, double seconds) {
  const auto exit = host.wait(3.0 * seconds + 120.0);
  const std::string summary = read_file(folder / "summary.json");
  EXPECT_EQ(exit, 0) << host.output() << host.errors();
  ASSERT_FALSE(summary.empty());
  const auto json = nlohmann::json::parse(summary);
  EXPECT_EQ(json.at("fault"), "none");
  EXPECT_GE(json.at("steps").get<double>(), 990.0 * seconds - 100.0 - json.at("skipped").get<double>());
  const auto& late = json.at("lateness");
  const auto& step = json.at("step");
  fmt::print(
      "kernel {}\ngranted: {}\n{} steps of 1 ms in {:.1f} s, {} overruns (at most {} in a row), {} deadlines "
      "left out\n",
      kernel(), json.at("granted").get<std::string>(), json.at("steps").get<std::uint64_t>(),
      json.at("seconds").get<double>(), json.at("overruns").get<std::uint64_t>(),
      json.at("longest_run_of_overruns").get<std::uint64_t>(), json.at("skipped").get<std::uint64_t>());
  for (const auto& [name, times] : {std::pair{"woken late", late}, std::pair{"step", step}})
    fmt::print("{}: p50 {:.0f} us, p99 {:.0f} us, p99.9 {:.0f} us, largest {:.0f} us\n", name,
               times.at("p50_us").template get<double>(), times.at("p99_us").template get<double>(),
               times.at("p999_us").template get<double>(), times.at("max_us").template get<double>());
  const std::string said = host.output();
  const std::size_t histogram = said.find("woken late");
  if (histogram != std::string::npos) fmt::print("{}\n", said.substr(histogram));
}

std::vector<std::string> station(const TemporaryFolder& folder, const std::string& seconds) {
  return {program(),
          "run",
          "grasp_teapot",
          "--rate-hz",
          "1000",
          "--seconds",
          seconds,
          "--headless",
          "--summary",
          (folder / "summary.json").string(),
          "--fault-reports",
          (folder / "faults").string()};
}

TEST(Endurance, TheStationRuns30SecondsAt1KHz) {
#ifdef PHALANX_SANITIZED
  GTEST_SKIP() << "sanitized code is too slow for 1 kHz in real time";
#endif
  const TemporaryFolder folder;
  ChildProcess host(station(folder, "30"), folder / "host.txt");
  expect_no_fault(host, folder, 30.0);
}

TEST(SoakEndurance, TheStationRuns10MinutesAt1KHzOverUdp) {
  const TemporaryFolder folder;
  ChildProcess controller(
      {program(), "device", "simulate", "grasp_teapot", "--udp", "127.0.0.1:0", "--set", "rate_hz=1000"},
      folder / "controller.txt");
  const std::string listening = "listening on ";
  while (!controller.output().ends_with('\n') && !controller.ended()) sleep_seconds(0.01);
  const std::string said = controller.output();
  ASSERT_TRUE(said.starts_with(listening)) << controller.errors();
  std::vector<std::string> command = station(folder, "600");
  command.insert(command.end(),
                 {"--device", said.substr(listening.size(), said.find('\n') - listening.size())});
  ChildProcess host(command, folder / "host.txt");
  expect_no_fault(host, folder, 600.0);
}

}  // namespace
}  // namespace phalanx::testing
