// SPDX-License-Identifier: Apache-2.0
// Lines for a terminal, a pipe or a file, which may take them late or never.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <thread>

namespace phalanx {

/// Writer of lines to a descriptor, on a thread of its own. The callers do not wait for the reader, and do
/// not learn whether a line was written. A descriptor that fails (the terminal is closed, the pipe's reader
/// has gone, the disk is full) is not written to again. Not real-time: allocates and locks.
class LineWriter {
 public:
  static constexpr std::size_t kWaiting = 1000;            ///< largest number of waiting lines
  static constexpr std::size_t kWaitingBytes = 1'000'000;  ///< largest number of their bytes
  static constexpr double kDrainTime = 2.0;   ///< longest time that the destructor waits for the reader [s]
  static constexpr std::size_t kWidth = 100;  ///< columns if the output is not a terminal

  /// @param descriptor  open for as long as the process lives
  /// @throws std::system_error if no thread can be made
  explicit LineWriter(int descriptor);
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;
  /// Waits until the waiting lines are written; after kDrainTime, leaves them to the thread.
  ~LineWriter();

  /// Appends text. Lines beyond the capacity, or for which there is no memory, are left out; a line in their
  /// place states how many.
  /// @param text  a line, or several; without the last '\n'
  void line(const std::string& text) noexcept;
  /// Appends a line that is useless later: it is left out while another line waits. On a terminal that can,
  /// the next status is written over it. @returns false if it was left out
  [[nodiscard]] bool status(const std::string& text) noexcept;

  [[nodiscard]] bool is_terminal() const noexcept { return terminal_; }
  /// @returns the columns that a line may have; on a terminal one less than it has now.
  [[nodiscard]] std::size_t width() const noexcept;

 private:
  struct Shared;
  static void write_all(Shared& shared) noexcept;

  const int descriptor_;
  const bool terminal_;
  const bool in_place_;             ///< a terminal that can clear a line
  std::shared_ptr<Shared> shared_;  ///< shared with the thread, which may live longer
  std::thread thread_;
};

}  // namespace phalanx
