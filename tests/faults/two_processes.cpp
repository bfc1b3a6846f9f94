// SPDX-License-Identifier: Apache-2.0
#include "faults/two_processes.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace phalanx::testing {
namespace {

constexpr double kHang = 240.0;  ///< real seconds for anything to begin or end: only against hangs

std::string of_environment(const char* name, const std::string& otherwise) {
  const char* given = std::getenv(name);
  return given != nullptr && *given != '\0' ? given : otherwise;
}

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

double slow_motion() {
#ifdef PHALANX_SANITIZED
  const std::string otherwise = "20";
#else
  const std::string otherwise = "8";
#endif
  return std::stod(of_environment("PHALANX_FAULTS_SLOW_MOTION", otherwise));
}

std::string program() { return of_environment("PHALANX_PROGRAM", PHALANX_PROGRAM_BUILT); }

TwoProcesses::TwoProcesses(const Scenario& scenario) : scenario_(scenario) {
  start_controller();
  start_host();
}

void TwoProcesses::start_controller() {
  std::vector<std::string> command{program(),       "device",
                                   "simulate",      "grasp_teapot",
                                   "--slow-motion", std::to_string(slow_),
                                   "--log",         path("controller.csv").string()};
  append(command, scenario_.pty ? std::vector<std::string>{"--pty"}
                                : std::vector<std::string>{"--udp", "127.0.0.1:0"});
  append(command, scenario_.controller);
  append(command, scenario_.both);
  controller_ = std::make_unique<ChildProcess>(command, path("controller.txt"));
  const std::string listening = "listening on ";
  const double give_up = wall_seconds() + kHang;
  std::string said;
  while (!said.ends_with('\n')) {
    if (controller_->ended() || wall_seconds() > give_up)
      throw std::runtime_error("the controller does not listen: " + controller_->errors());
    sleep_seconds(0.005);
    said = controller_->output();
  }
  begin_ = wall_seconds();
  if (!said.starts_with(listening)) throw std::runtime_error("the controller says: " + said);
  address_ = said.substr(listening.size(), said.find('\n') - listening.size());
  if (scenario_.pty) return;
  controller_port_ = static_cast<std::uint16_t>(std::stoul(address_.substr(address_.rfind(':') + 1)));
  if (!scenario_.middle) return;
  middle_ = std::make_unique<UdpMiddle>(controller_port_);
  address_ = "udp:127.0.0.1:" + std::to_string(middle_->port());
}

void TwoProcesses::start_host() {
  std::vector<std::string> command{program(),
                                   "run",
                                   "grasp_teapot",
                                   "--device",
                                   address_,
                                   "--slow-motion",
                                   std::to_string(slow_),
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
  host_ = std::make_unique<ChildProcess>(command, path("host.txt"));
}

double TwoProcesses::now() const { return (wall_seconds() - begin_) / slow_; }

Outcome TwoProcesses::go() {
  for (const Event& event : scenario_.events) {
    if (event.at > now()) pass(event.at - now());
    event.act(*this);
  }
  if (scenario_.seconds > now()) pass(scenario_.seconds - now());
  host_->signal(SIGINT);
  outcome_.host_exit = host_->wait(kHang);
  controller_->signal(SIGINT);
  outcome_.controller_exit = controller_->wait(kHang);
  gather();
  return outcome_;
}

void TwoProcesses::gather() {
  outcome_.logs = read_logs(path("controller.csv"), path("host.csv"));
  outcome_.controller_output = controller_->output();
  outcome_.controller_errors = controller_->errors();
  outcome_.host_output = host_->output();
  outcome_.host_errors = host_->errors();
  outcome_.summary = read_file(path("summary.json"));
  outcome_.faults = faults_below(path("faults"));
}

}  // namespace phalanx::testing
