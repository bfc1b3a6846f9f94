// SPDX-License-Identifier: Apache-2.0
// Lines for a terminal, a pipe or a file that may take them late, or never.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <thread>

namespace phalanx {

/// Writes lines to a descriptor on a thread of its own: the callers never wait for who reads them, and
/// nothing that becomes of the lines reaches the callers. A descriptor that fails (the terminal is closed,
/// the pipe's reader has gone, the disk is full) is not written to again. Not real-time: allocates and locks.
class LineWriter {
 public:
  static constexpr std::size_t kWaiting = 1000;            ///< lines
  static constexpr std::size_t kWaitingBytes = 1'000'000;  ///< of them
  static constexpr double kDrainTime = 2.0;                ///< how long the end waits for the reader [s]
  static constexpr std::size_t kWidth = 100;               ///< columns where there is no terminal

  /// @param descriptor  open for as long as the process lives. @throws std::system_error: no thread
  explicit LineWriter(int descriptor);
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;
  /// Waits for what still waits; after kDrainTime the thread is left alone with it.
  ~LineWriter();

  /// Lines beyond those that may wait are left out, and a line in their place says how many.
  /// @param text  a line, or several; without the last '\n'
  void line(const std::string& text) noexcept;
  /// A line that is of no use later: left out while another one waits. On a terminal that can, the next
  /// status is written over it. @returns false if it was left out
  [[nodiscard]] bool status(const std::string& text) noexcept;

  [[nodiscard]] bool is_terminal() const noexcept { return terminal_; }
  /// Columns that a line may have; on a terminal one less than it has now.
  [[nodiscard]] std::size_t width() const noexcept;

 private:
  struct Shared;
  static void write_all(Shared& shared) noexcept;

  const int descriptor_;
  const bool terminal_;
  const bool in_place_;             ///< a terminal that can clear a line
  std::shared_ptr<Shared> shared_;  ///< the thread's, too: it may be there longer
  std::thread thread_;
};

}  // namespace phalanx
