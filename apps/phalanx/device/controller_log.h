// SPDX-License-Identifier: Apache-2.0
// The simulated controller's own log: one row of CSV (comma-separated values) a tick.
#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "phalanx/simulation/simulated_controller.h"

namespace phalanx {

/// Log with a ring of fixed size. add() puts a row into the ring; a thread of its own writes the rows every
/// 100 ms and flushes. The tick never waits for the disk. If the ring is full, rows are lost and counted.
class ControllerLog {
 public:
  /// Opens the log.
  /// @throws std::invalid_argument if the file cannot be written
  ControllerLog(const std::string& path, const SimulatedController& controller);
  ~ControllerLog();
  ControllerLog(const ControllerLog&) = delete;
  ControllerLog& operator=(const ControllerLog&) = delete;

  /// Adds the row of a tick. Real-time.
  /// @param newest_command  tick of the newest command that was received, used or not
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
  std::vector<int> joints_;  ///< the joints of the device
  boost::lockfree::spsc_queue<Row, boost::lockfree::capacity<kRows>> rows_;
  std::atomic<std::uint64_t> lost_ = 0;
  std::atomic<bool> ending_ = false;
  std::string line_;
  std::thread writer_;
};

}  // namespace phalanx
