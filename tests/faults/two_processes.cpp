// SPDX-License-Identifier: Apache-2.0
#include "faults/two_processes.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace phalanx::testing {
namespace {

constexpr double kHang = 240.0;      ///< real seconds for a program to begin or to end: only against hangs
constexpr double kEndWithin = 60.0;  ///< of the held clock, for a program to listen or to end [s]

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

std::vector<std::string> faults_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> reports;
  if (std::filesystem::exists(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      reports.push_back(entry.path() / "report.json");
  }
  std::sort(reports.begin(), reports.end());
  std::vector<std::string> faults;
  for (const auto& report : reports)
    faults.push_back(nlohmann::json::parse(read_file(report)).at("fault").get<std::string>());
  return faults;
}

}  // namespace

std::string program() {
  const char* given = std::getenv("PHALANX_PROGRAM");
  return given != nullptr && *given != '\0' ? given : PHALANX_PROGRAM_BUILT;
}

TwoProcesses::TwoProcesses(const Scenario& scenario) : scenario_(scenario) {
  start_controller();
  start_host();
}

std::unique_ptr<ChildProcess> TwoProcesses::start(const std::vector<std::string>& command,
                                                  const std::string& output) {
  std::vector<std::string> under_clock{"/usr/bin/env"};
  append(under_clock, clock_.environment(PHALANX_HELD_CLOCK_LIBRARY));
  append(under_clock, command);
  auto process = std::make_unique<ChildProcess>(under_clock, path(output));
  const double give_up = wall_seconds() + kHang;
  while (!clock_.holds(process->pid())) {
    if (process->ended() || wall_seconds() > give_up)
      throw std::runtime_error(command[1] + " does not begin: " + process->errors());
    sleep_seconds(0.001);
  }
  return process;
}

std::optional<int> TwoProcesses::wait_for(ChildProcess& process) {
  const double give_up = clock_.now() + kEndWithin;
  while (!process.ended() && clock_.now() < give_up) pass(0.01);
  // What looks for leaks at a program's end is a process of its own, which the clock does not know: while it
  // works, the program sleeps and time passes.
  return process.wait(kHang);
}

std::vector<std::string> TwoProcesses::device_command() const {
  if (!scenario_.glove_watchdog_ms.empty())
    return {PHALANX_GLOVE_PROGRAM, path("glove.csv").string(), scenario_.glove_watchdog_ms};
  std::vector<std::string> command{program(),       "device", "simulate",
                                   scenario_.scene, "--log",  path("controller.csv").string()};
  append(command, scenario_.pty ? std::vector<std::string>{"--pty"}
                                : std::vector<std::string>{"--udp", "127.0.0.1:0"});
  append(command, scenario_.controller);
  append(command, scenario_.both);
  return command;
}

void TwoProcesses::start_controller() {
  controller_ = start(device_command(), "controller.txt");
  const std::string listening = "listening on ";
  const double give_up = clock_.now() + kEndWithin;
  std::string said;
  while (!said.ends_with('\n')) {
    if (controller_->ended() || clock_.now() > give_up)
      throw std::runtime_error("the controller does not listen: " + controller_->errors());
    pass(0.001);
    said = controller_->output();
  }
  begin_ = clock_.now();
  if (!said.starts_with(listening)) throw std::runtime_error("the controller says: " + said);
  address_ = said.substr(listening.size(), said.find('\n') - listening.size());
  if (scenario_.pty || !scenario_.glove_watchdog_ms.empty()) return;
  controller_port_ = static_cast<std::uint16_t>(std::stoul(address_.substr(address_.rfind(':') + 1)));
  if (!scenario_.middle) return;
  middle_ = std::make_unique<UdpMiddle>(controller_port_);
  clock_.watch_thread(middle_->thread_id());
  address_ = "udp:127.0.0.1:" + std::to_string(middle_->port());
}

void TwoProcesses::start_host() {
  if (scenario_.conform) {
    host_ = start(
        {program(), "device", "conform", address_, "--no-hand-in-device", "--out", path("report").string()},
        "host.txt");
    return;
  }
  std::vector<std::string> command{program(),
                                   "run",
                                   scenario_.scene,
                                   "--device",
                                   address_,
                                   "--headless",
                                   "--no-realtime",
                                   "--log",
                                   path("host.csv").string(),
                                   "--summary",
                                   path("summary.json").string(),
                                   "--fault-reports",
                                   path("faults").string()};
  append(command, scenario_.host);
  append(command, scenario_.both);
  host_ = start(command, "host.txt");
}

double TwoProcesses::now() const { return clock_.now() - begin_; }

Outcome TwoProcesses::go() {
  for (const Event& event : scenario_.events) {
    if (event.at > now()) pass(event.at - now());
    event.act(*this);
  }
  if (scenario_.conform) {
    while (!host_->ended() && now() < scenario_.seconds) pass(0.1);
  } else if (scenario_.seconds > now()) {
    pass(scenario_.seconds - now());
  }
  host_->signal(SIGINT);
  outcome_.host_exit = wait_for(*host_);
  controller_->signal(SIGINT);
  outcome_.controller_exit = wait_for(*controller_);
  gather();
  return outcome_;
}

void TwoProcesses::gather() {
  outcome_.logs = read_logs(folder_.path());
  outcome_.controller_output = controller_->output();
  outcome_.controller_errors = controller_->errors();
  outcome_.host_output = host_->output();
  outcome_.host_errors = host_->errors();
  outcome_.summary = read_file(scenario_.conform ? path("report/conform.json") : path("summary.json"));
  outcome_.faults = faults_below(path("faults"));
}

}  // namespace phalanx::testing
