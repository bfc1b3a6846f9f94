// SPDX-License-Identifier: Apache-2.0
// The simulated controller's own log: a row of CSV a tick.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/device/simulated_controller.h"

namespace phalanx {

/// add() puts a row into a ring of fixed size; a thread of its own writes the rows every 100 ms and flushes.
/// The tick never waits for the disk; should the ring be full, rows are lost and counted.
class ControllerLog {
 public:
  /// @throws std::invalid_argument if the file cannot be written
  ControllerLog(const std::string& path, const SimulatedController& controller);
  ~ControllerLog();
  ControllerLog(const ControllerLog&) = delete;
  ControllerLog& operator=(const ControllerLog&) = delete;

  /// After a tick. Real-time.
  /// @param newest_command  tick of the newest command that has come in, used or not
  void add(const SimulatedController& controller, std::uint64_t newest_command) noexcept;
  /// Writes the rest. @throws std::runtime_error if rows were lost or could not be written
  void finish();

 private:
  struct Row {
    std::uint64_t tick = 0;
    std::uint64_t time_us = 0;
    std::uint8_t state = 0;
    std::uint16_t fault = 0;
    std::uint64_t acted_tick = 0;
    std::uint64_t acted_age_us = 0;
    float factor = 0.0F;
    std::uint32_t corrupt = 0, refused = 0, outdated = 0;
    std::uint64_t newest_command = 0;
    std::array<float, kJoints> torque{};
    std::array<float, kJoints> angle{};
  };
  void write_header() const;
  void write(const Row& row);
  void write_all();
  void work();

  static constexpr std::size_t kRows = 8192;

  std::string path_;
  std::FILE* file_ = nullptr;
  std::vector<int> joints_;  ///< the device's
  boost::lockfree::spsc_queue<Row, boost::lockfree::capacity<kRows>> rows_;
  std::atomic<std::uint64_t> lost_ = 0;
  std::atomic<bool> ending_ = false;
  std::string line_;
  std::thread writer_;
};

}  // namespace phalanx
