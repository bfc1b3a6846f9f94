// SPDX-License-Identifier: Apache-2.0
#include "apps/month/held_programs.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace phalanx::testing {
namespace {

constexpr double kRealPatience = 240.0;  // only against hangs [s]
constexpr double kLook = 0.02;           // time between two looks at a program [s]

}  // namespace

HeldPrograms::HeldPrograms(std::filesystem::path folder, std::vector<std::string> environment)
    : folder_(std::move(folder)), environment_(std::move(environment)) {}

std::unique_ptr<ChildProcess> HeldPrograms::start(const std::vector<std::string>& command,
                                                  const std::string& output) {
  // env's --chdir is the working folder; the date's library stands before the clock's.
  std::vector<std::string> whole{"/usr/bin/env", fmt::format("--chdir={}", folder_.string())};
  const auto append = [&whole](const std::vector<std::string>& more) {
    whole.insert(whole.end(), more.begin(), more.end());
  };
  append(clock_.environment(PHALANX_SHIFTED_DATE_LIBRARY ":" PHALANX_HELD_CLOCK_LIBRARY));
  append(environment_);
  append(command);
  auto process = std::make_unique<ChildProcess>(whole, folder_ / output);
  const double give_up = wall_seconds() + kRealPatience;
  while (!clock_.holds(process->pid())) {
    if (process->ended() || wall_seconds() > give_up)
      throw std::runtime_error(fmt::format("{} does not begin: {}", command.front(), process->errors()));
    sleep_seconds(0.001);
  }
  return process;
}

std::unique_ptr<ChildProcess> HeldPrograms::start_device(const std::string& output, const std::string& port,
                                                         const std::vector<std::string>& more) {
  std::vector<std::string> command{PHALANX_PROGRAM, "device", "simulate",
                                   "index_ball",    "--udp",  fmt::format("127.0.0.1:{}", port)};
  command.insert(command.end(), more.begin(), more.end());
  auto process = start(command, output);
  const std::string listening = "listening on ";
  if (!says(*process, listening, 60.0) || !says(*process, "\n", 60.0))
    throw std::runtime_error(fmt::format("the device does not listen: {}", process->errors()));
  const std::string said = process->output();
  const std::size_t begin = said.find(listening) + listening.size();
  address_ = said.substr(begin, said.find('\n', begin) - begin);
  return process;
}

bool HeldPrograms::pass_until(const std::function<bool()>& holds, double seconds) {
  const double give_up = now() + seconds;
  while (!holds()) {
    if (now() >= give_up) return false;
    pass(kLook);
  }
  return true;
}

bool HeldPrograms::says(ChildProcess& process, const std::string& text, double seconds) {
  const auto said = [&] { return process.output().find(text) != std::string::npos; };
  return pass_until([&] { return said() || process.ended(); }, seconds) && said();
}

std::optional<int> HeldPrograms::wait(ChildProcess& process, double seconds) {
  if (!pass_until([&] { return process.ended(); }, seconds)) return std::nullopt;
  return process.wait(0.0);
}

}  // namespace phalanx::testing
