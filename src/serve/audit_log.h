// SPDX-License-Identifier: Apache-2.0
// The log of changes: who did what and when. Writing to the disk has a thread of its own, so that a slow or
// full disk delays no page and no stop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "phalanx/cockpit.pb.h"

namespace phalanx {

/// Lines that are missing in a LogFile.
struct LogGap {
  std::size_t lines = 0;
  double since = 0.0;  ///< when the first of them was added [s], since 1970
  double until = 0.0;  ///< when the last of them was added [s], since 1970
};

/// Text file to which a thread of low priority appends lines. add() does not wait for the disk. Lines are
/// lost if the disk refuses them, or if it is so slow that kWaiting lines wait already. Lost lines are
/// counted, and each further line tries to write again. The first line that succeeds follows a line that
/// names the gap.
///
/// Not real-time: allocates and locks.
class LogFile {
 public:
  static constexpr std::size_t kWaiting = 1000;  ///< lines that may wait
  static constexpr std::size_t kWaitingBytes =
      8'000'000;                                ///< their bytes; a line that waits alone may be longer
  static constexpr double kCloseTimeout = 2.0;  ///< for which the destructor waits for the disk [s]

  /// @param file         is created, with its folder
  /// @param file_length  largest length; a line that would exceed it renames the file to ".1", which
  ///                     replaces an older one, and begins a new file [bytes]
  /// @param gap_line     makes the line that names a gap, with '\n'; called on the writing thread
  /// @throws std::runtime_error if the file cannot be written
  LogFile(std::filesystem::path file, std::uintmax_t file_length,
          std::function<std::string(const LogGap&)> gap_line);
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  /// Writes the lines that wait. If the disk takes longer than kCloseTimeout, leaves them to the thread.
  ~LogFile();

  /// @param time  now [s], since 1970
  /// @param line  with '\n'
  void add(double time, std::string line);
  /// @returns true if the newest line has been lost. Any thread.
  [[nodiscard]] bool broken() const noexcept;

 private:
  struct Shared;
  static void write_all(Shared& shared);

  std::shared_ptr<Shared> shared_;  ///< with the thread, which may outlive this object
  std::thread thread_;
};

/// Log of all notices: a LogFile with one JSON line for each notice, and the newest notices in memory for
/// pages that connect. Those in memory are shortened, so that all of them fit into one small message.
/// One thread at a time. Not real-time, but does not wait for the disk.
class AuditLog {
 public:
  static constexpr std::size_t kRemembered = 100;   ///< notices in memory
  static constexpr std::size_t kTextLength = 2000;  ///< of a notice in memory [bytes]

  static constexpr std::uintmax_t kFileLength = 64'000'000;  ///< of the file [bytes]

  /// @param file         empty: in memory only
  /// @param file_length  as LogFile's
  /// @throws std::runtime_error if the file cannot be written
  explicit AuditLog(const std::filesystem::path& file, std::uintmax_t file_length = kFileLength);

  void add(const wire::Notice& notice);
  /// @returns the notices in memory, oldest first
  [[nodiscard]] const std::deque<wire::Notice>& newest() const noexcept { return newest_; }
  [[nodiscard]] bool broken() const noexcept { return file_ && file_->broken(); }  ///< LogFile::broken()

 private:
  std::optional<LogFile> file_;
  std::deque<wire::Notice> newest_;
};

}  // namespace phalanx
