// SPDX-License-Identifier: Apache-2.0
#include "apps/run/running_station.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace phalanx::testing {
namespace {

constexpr double kHang = 240.0;      ///< real seconds for a program to begin or to end: only against hangs
constexpr double kEndWithin = 60.0;  ///< of the held clock, for a program to end [s]

/// Not of the programs that the test starts.
void keep(int descriptor) { ::fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this == &other) return *this;
  close();
  number_ = std::exchange(other.number_, -1);
  return *this;
}

void Descriptor::close() {
  if (number_ >= 0) ::close(std::exchange(number_, -1));
}

Ends make_terminal(unsigned short columns) {
  int ours = -1;
  int theirs = -1;
  const winsize size{.ws_row = 24, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  if (::openpty(&ours, &theirs, nullptr, nullptr, &size) != 0) throw std::runtime_error("no terminal");
  keep(ours);
  keep(theirs);
  return {Descriptor(ours), Descriptor(theirs)};
}

Ends pipe_to_program() {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  return {Descriptor(pipe[1]), Descriptor(pipe[0])};
}

Ends pipe_from_program() {
  Ends ends = pipe_to_program();
  std::swap(ends.ours, ends.theirs);
  return ends;
}

std::vector<LoggedStep> read_steps(const std::filesystem::path& log) {
  std::ifstream file(log);
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> header = cells_of(line);
  std::vector<LoggedStep> steps;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != header.size()) throw std::runtime_error("a row that is not whole: " + line);
    LoggedStep step;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (header[i] == "time_s") step.time = std::stod(cells[i]);
      if (header[i] == "state") step.state = cells[i];
      if (header[i] == "fault") step.fault = cells[i];
      if (header[i] == "stiffness_n_per_m") step.stiffness = std::stod(cells[i]);
      if (header[i].starts_with("torque_nm_"))
        step.largest_torque = std::max(step.largest_torque, std::abs(std::stod(cells[i])));
    }
    steps.push_back(step);
  }
  return steps;
}

RunningStation::RunningStation(const TemporaryFolder& folder, const Descriptors& descriptors,
                               const std::vector<std::string>& arguments, const std::string& script) {
  std::vector<std::string> command{"/usr/bin/env", "-C", folder.path().string()};
  const auto add = [&](const std::vector<std::string>& more) {
    command.insert(command.end(), more.begin(), more.end());
  };
  add(clock_.environment(PHALANX_HELD_CLOCK_LIBRARY));
  add({"PHALANX_DATA_DIR=" PHALANX_SOURCE_DIR, "TERM=xterm",
       "SSH_CONNECTION=", "XDG_CONFIG_HOME=" + folder.path().string()});
  if (!script.empty()) add({"/bin/sh", "-c", script, "sh"});
  add({PHALANX_PROGRAM, "run", "grasp_teapot", "--rate-hz", "200", "--log", "x.csv", "--summary", "x.json"});
  add(arguments);
  process_ = std::make_unique<ChildProcess>(command, descriptors);
  const double give_up = wall_seconds() + kHang;
  while (!clock_.holds(process_->pid())) {
    if (process_->ended() || wall_seconds() > give_up) throw std::runtime_error("it does not begin");
    sleep_seconds(0.001);
  }
}

std::optional<int> RunningStation::wait() {
  const double give_up = clock_.now() + kEndWithin;
  while (!process_->ended() && clock_.now() < give_up) pass(0.01);
  return process_->wait(process_->ended() ? 0.0 : kHang);
}

std::string read_waiting(const Descriptor& descriptor) {
  std::string text;
  pollfd input{.fd = descriptor.number(), .events = POLLIN, .revents = 0};
  while (::poll(&input, 1, 0) == 1) {
    std::array<char, 4096> block;
    const ssize_t count = ::read(descriptor.number(), block.data(), block.size());
    if (count <= 0) break;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
  return text;
}

void write_text(const Descriptor& descriptor, const std::string& text) {
  if (::write(descriptor.number(), text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("what is typed does not arrive");
}

}  // namespace phalanx::testing
