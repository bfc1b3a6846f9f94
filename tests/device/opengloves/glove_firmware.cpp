// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_firmware.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>

namespace phalanx::test {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(1);  // of its loop
constexpr auto kPatience = std::chrono::minutes(5);

int new_master() {
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0)
    throw std::runtime_error("no pseudo-terminal");
  return master;
}

int open_raw(const std::string& port) {
  const int slave = ::open(port.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  if (slave < 0 || ::tcgetattr(slave, &settings) != 0) throw std::runtime_error("no pseudo-terminal");
  ::cfmakeraw(&settings);
  ::tcsetattr(slave, TCSANOW, &settings);
  return slave;
}

}  // namespace

GloveFirmware::GloveFirmware(std::string line) : master_(new_master()), line_(std::move(line)) {
  std::array<char, 64> name{};
  if (::ptsname_r(master_, name.data(), name.size()) != 0) throw std::runtime_error("no pseudo-terminal");
  port_ = name.data();
  slave_ = open_raw(port_);
  thread_ = std::thread([this] { run(); });
}

GloveFirmware::~GloveFirmware() { unplug(); }

int GloveFirmware::host_descriptor() const { return ::open(port_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC); }

void GloveFirmware::say(std::string line) {
  const std::lock_guard lock(mutex_);
  line_ = std::move(line);
}

void GloveFirmware::blurt(std::string bytes) {
  const std::lock_guard lock(mutex_);
  blurted_ += bytes;
}

void GloveFirmware::unplug() {
  quit_ = true;
  if (thread_.joinable()) thread_.join();
  if (master_ >= 0) ::close(master_);
  if (slave_ >= 0) ::close(slave_);
  master_ = slave_ = -1;
}

std::vector<std::string> GloveFirmware::answers() const {
  const std::lock_guard lock(mutex_);
  return answers_;
}

std::string GloveFirmware::last_answer() const {
  const std::lock_guard lock(mutex_);
  return answers_.empty() ? std::string() : answers_.back();
}

std::size_t GloveFirmware::newlines() const {
  const std::lock_guard lock(mutex_);
  return newlines_;
}

template <class Condition>
bool GloveFirmware::wait_until(Condition condition) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, kPatience, condition);
}

bool GloveFirmware::wait_for_answers(std::size_t more) {
  const std::size_t goal = answers().size() + more;
  return wait_until([&] { return answers_.size() >= goal; });
}

bool GloveFirmware::wait_for_newlines(std::size_t more) {
  const std::size_t goal = newlines() + more;
  return wait_until([&] { return newlines_ >= goal; });
}

bool GloveFirmware::wait_for_answer(const std::string& answer) {
  return wait_until([&] { return !answers_.empty() && answers_.back() == answer; });
}

void GloveFirmware::write_all(const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size() && !quit_;) {
    const ssize_t count = ::write(master_, bytes.data() + at, bytes.size() - at);
    if (count <= 0) return;
    at += static_cast<std::size_t>(count);
  }
}

void GloveFirmware::listen(bool until_a_line) {
  while (!quit_) {
    pollfd poll_for{.fd = master_, .events = POLLIN, .revents = 0};
    if (::poll(&poll_for, 1, 5) <= 0) {
      if (until_a_line) continue;
      return;
    }
    char c = 0;
    if (::read(master_, &c, 1) != 1) return;
    if (c != '\n') {
      heard_ += c;
      continue;
    }
    const std::lock_guard lock(mutex_);
    if (heard_.empty()) {
      ++newlines_;
    } else {
      answers_.push_back(heard_);
    }
    heard_.clear();
    changed_.notify_all();
    return;
  }
}

void GloveFirmware::run() {
  while (!quit_) {
    std::string bytes;
    bool speaks = false;
    {
      const std::lock_guard lock(mutex_);
      bytes.swap(blurted_);
      speaks = !line_.empty();
      if (speaks) bytes += line_ + "\n";
    }
    write_all(bytes);
    if (speaks) ++lines_sent_;
    listen(speaks);
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace phalanx::test
