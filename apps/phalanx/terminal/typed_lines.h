// SPDX-License-Identifier: Apache-2.0
// The lines that are typed at the terminal of a running station.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "phalanx/station/session.h"

namespace phalanx {

/// Reader of standard input on a thread of its own. The line `stop`, and a signal that asks the program to
/// end, remove the torque at once from that thread. All lines then wait for the owner, in their order. After
/// its end, standard input is not read again. A terminal that belongs to another job is read again
/// when that changes.
class TypedLines {
 public:
  static constexpr std::size_t kWaiting = 1000;  ///< largest number of waiting lines; further ones
                                                 ///< are left out

  struct Line {
    std::string text;
    std::uint64_t stops = 0;  ///< for `stop`: Session::stops() right after it
  };

  /// @param session  outlives the reader
  /// @throws std::system_error if there is no thread or no descriptor
  explicit TypedLines(Session& session);
  TypedLines(const TypedLines&) = delete;
  TypedLines& operator=(const TypedLines&) = delete;
  ~TypedLines();

  [[nodiscard]] std::optional<Line> next();
  /// @returns the number of lines left out since the last call.
  [[nodiscard]] std::size_t take_left_out();

 private:
  void read_all() noexcept;
  void read_some();
  void take_lines();

  Session& session_;
  const int wake_;   ///< eventfd that signals the end
  const int input_;  ///< standard input, opened without blocking where that is possible

  // The reading thread only.
  std::string pending_;  ///< the beginning of an incomplete line
  bool too_long_ = false;
  bool ended_ = false;
  bool in_background_ = false;

  std::mutex mutex_;
  std::deque<Line> lines_;
  std::size_t left_out_ = 0;
  std::thread thread_;
};

}  // namespace phalanx
