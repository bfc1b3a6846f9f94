// SPDX-License-Identifier: Apache-2.0
// What is typed at the terminal of a running station.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "phalanx/station/station_host.h"

namespace phalanx {

/// Reads standard input on a thread of its own. The line `stop`, and a signal that asks the program to end,
/// take the torque away at once, from that thread, whatever the others do. All lines then wait for the owner,
/// in their order. Standard input that ends is not asked again; a terminal that belongs to another job is
/// asked again once it does not.
class TypedLines {
 public:
  static constexpr std::size_t kWaiting = 1000;  ///< lines; those that come when so many wait are left out

  struct Line {
    std::string text;
    std::uint64_t stops = 0;  ///< of `stop`: StationHost::stops() right after it
  };

  /// @param host  outlives it. @throws std::system_error: no thread, or no descriptor
  explicit TypedLines(StationHost& host);
  TypedLines(const TypedLines&) = delete;
  TypedLines& operator=(const TypedLines&) = delete;
  ~TypedLines();

  [[nodiscard]] std::optional<Line> next();
  /// How many lines were left out since this was last asked.
  [[nodiscard]] std::size_t take_left_out();

 private:
  void read_all() noexcept;
  void read_some();
  void take_lines();

  StationHost& host_;
  const int wake_;  ///< eventfd: the end

  // The thread's.
  std::string pending_;  ///< the beginning of a line
  bool too_long_ = false;
  bool ended_ = false;
  bool in_background_ = false;

  std::mutex mutex_;
  std::deque<Line> lines_;
  std::size_t left_out_ = 0;
  std::thread thread_;
};

}  // namespace phalanx
