// SPDX-License-Identifier: Apache-2.0
#include "device/controller_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace phalanx {
namespace {

constexpr std::chrono::milliseconds kBetweenWrites{100};

std::string_view state_name(std::uint8_t state) {
  constexpr std::array<std::string_view, 6> kNames{"no_session", "ready",  "starting",
                                                   "active",     "fading", "latched"};
  return state < kNames.size() ? kNames[state] : "unknown";
}

}  // namespace

ControllerLog::ControllerLog(const std::string& path, const SimulatedController& controller) : path_(path) {
  for (const ExoJoint& joint : controller.exoskeleton().exoskeleton().joints) joints_.push_back(joint.joint);
  file_ = std::fopen(path.c_str(), "w");
  if (file_ == nullptr)
    throw std::invalid_argument(fmt::format("--log {}: {}; name a file in a folder that can be written to",
                                            path, std::strerror(errno)));
  write_header();
  writer_ = std::thread([this] { work(); });
}

ControllerLog::~ControllerLog() {
  ending_ = true;
  if (writer_.joinable()) writer_.join();
  if (file_ != nullptr) std::fclose(file_);
}

void ControllerLog::add(const SimulatedController& controller, std::uint64_t newest_command) noexcept {
  const phx_controller& c = controller.controller();
  Row row{.tick = controller.ticks(),
          .time_us = controller.time_us(),
          .state = c.state,
          .fault = c.fault,
          .acted_tick = c.acting ? c.step.command.tick : 0,
          .acted_age_us = 0,
          .factor = c.factor,
          .corrupt = c.corrupt,
          .refused = c.refused,
          .outdated = c.outdated,
          .newest_command = newest_command};
  if (c.acting && row.time_us > c.step.command.sample_time_us)
    row.acted_age_us = row.time_us - c.step.command.sample_time_us;
  std::copy(std::begin(controller.output().torque), std::end(controller.output().torque), row.torque.begin());
  const JointArray& angle = controller.exoskeleton().plant().angle();
  std::transform(angle.begin(), angle.end(), row.angle.begin(),
                 [](double q) { return static_cast<float>(q); });
  if (!rows_.push(row)) lost_.fetch_add(1, std::memory_order_relaxed);
}

void ControllerLog::finish() {
  ending_ = true;
  if (writer_.joinable()) writer_.join();
  const bool wrong = std::ferror(file_) != 0;
  const bool unclosed = std::fclose(file_) != 0;
  file_ = nullptr;
  if (wrong || unclosed)
    throw std::runtime_error(
        fmt::format("--log {}: some of it could not be written; is the disk full?", path_));
  if (const std::uint64_t lost = lost_.load(std::memory_order_relaxed); lost > 0)
    throw std::runtime_error(
        fmt::format("--log {}: {} rows are missing; the disk was too slow", path_, lost));
}

void ControllerLog::write_header() const {
  fmt::print(
      file_,
      "tick,time_s,state,fault,acted_tick,acted_age_us,factor,max_abs_torque_nm,corrupt,refused,outdated,"
      "newest_command_tick");
  for (const int joint : joints_) fmt::print(file_, ",torque_{}_nm", joint_name(joint));
  for (const int joint : joints_) fmt::print(file_, ",angle_{}_rad", joint_name(joint));
  fmt::print(file_, "\n");
}

void ControllerLog::write(const Row& row) {
  float largest = 0.0F;
  for (const float torque : row.torque) largest = std::max(largest, std::abs(torque));
  line_.clear();
  const auto out = std::back_inserter(line_);
  fmt::format_to(out, "{},{}.{:06},{},{},{},{},{},{},{},{},{},{}", row.tick, row.time_us / 1000000U,
                 row.time_us % 1000000U, state_name(row.state), fault_name(static_cast<Fault>(row.fault)),
                 row.acted_tick, row.acted_age_us, row.factor, largest, row.corrupt, row.refused,
                 row.outdated, row.newest_command);
  for (const int joint : joints_) fmt::format_to(out, ",{}", row.torque[static_cast<std::size_t>(joint)]);
  for (const int joint : joints_) fmt::format_to(out, ",{}", row.angle[static_cast<std::size_t>(joint)]);
  line_ += '\n';
  std::fwrite(line_.data(), 1, line_.size(), file_);
}

void ControllerLog::write_all() {
  Row row;
  while (rows_.pop(row)) write(row);
  std::fflush(file_);
}

void ControllerLog::work() {
  while (!ending_.load()) {
    write_all();
    std::this_thread::sleep_for(kBetweenWrites);
  }
  write_all();
}

}  // namespace phalanx
