// SPDX-License-Identifier: Apache-2.0
#include "device/calibration_terminal.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "phalanx/device/opengloves/opengloves_device.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/station/open_device.h"
#include "terminal/end_signals.h"

namespace phalanx {

CalibrationTerminal::CalibrationTerminal() : shows_live_(::isatty(STDOUT_FILENO) != 0) {}

void CalibrationTerminal::say(const std::string& line) {
  wipe();
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::optional<std::string> CalibrationTerminal::answer(const std::function<std::string()>& live) {
  while (true) {
    if (auto line = take_line()) {
      shown_ = 0;  // the typed line end has moved on
      return line;
    }
    if (ended_ || asked_to_end != 0) return std::nullopt;
    const std::string values = live();
    if (shows_live_ && !values.empty()) show(values);
    read_more();
  }
}

std::optional<std::string> CalibrationTerminal::take_line() {
  const std::size_t end = typed_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = typed_.substr(0, end);
  typed_.erase(0, end + 1);
  return line;
}

void CalibrationTerminal::read_more() {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  if (::poll(&input, 1, 100) <= 0) return;
  std::array<char, 256> bytes{};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count > 0) typed_.append(bytes.data(), static_cast<std::size_t>(count));
  if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) ended_ = true;
}

void CalibrationTerminal::show(const std::string& values) {
  fmt::print("\r{:<{}}", values, shown_);
  shown_ = values.size();
  std::fflush(stdout);
}

void CalibrationTerminal::wipe() {
  if (shown_ > 0) fmt::print("\r{:<{}}\r", "", shown_);
  shown_ = 0;
}

void check_out(const std::string& out, bool force) {
  namespace fs = std::filesystem;
  const fs::path file = out;
  if (fs::is_directory(file))
    throw std::invalid_argument(fmt::format("--out '{}' is a folder; name a file in it", out));
  if (fs::exists(file) && !force)
    throw std::invalid_argument(
        fmt::format("--out '{}' is there already; name another file, or say --force to replace it", out));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::invalid_argument(fmt::format(
        "--out '{}': no file can be made in '{}'; name one in a folder of yours", out, folder.string()));
}

HandParameters hand_of_options(const std::string& hand, const std::string& profile) {
  if (!hand.empty() && !profile.empty())
    throw std::invalid_argument("--hand and --profile: the profile says which hand; leave out --hand");
  HandDescription description;
  description.profile = profile;
  if (!hand.empty()) description.file = hand;
  return load_hand_numbers(description).parameters;
}

std::unique_ptr<Device> open_to_measure(const std::string& address, const HandParameters& hand,
                                        const Clock& clock) {
  std::unique_ptr<Device> device = open_device(address, clock);
  if (auto* glove = dynamic_cast<OpenGlovesDevice*>(device.get())) glove->set_hand(hand);
  device->open();
  return device;
}

}  // namespace phalanx
