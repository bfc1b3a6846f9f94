// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>

#include "phalanx/cockpit.pb.h"
#include "serve/log_file.h"

namespace phalanx {

/// Who did what and when: every notice, as a JSON line in a LogFile, and the newest in memory for pages that
/// come: these shortened, so that all of them together stay a small message. One thread at a time; not
/// real-time, but it never waits for the disk.
class AuditLog {
 public:
  static constexpr std::size_t kRemembered = 100;
  static constexpr std::size_t kTextLength = 2000;  ///< of one in memory [bytes]

  static constexpr std::uintmax_t kFileLength = 64'000'000;  ///< of the file [bytes]

  /// @param file  empty: memory alone. @param file_length  as LogFile's
  /// @throws std::runtime_error if it cannot be written
  explicit AuditLog(const std::filesystem::path& file, std::uintmax_t file_length = kFileLength);

  void add(const wire::Notice& notice);
  [[nodiscard]] const std::deque<wire::Notice>& newest() const noexcept { return newest_; }
  [[nodiscard]] bool broken() const noexcept { return file_ && file_->broken(); }  ///< LogFile::broken()

 private:
  std::optional<LogFile> file_;
  std::deque<wire::Notice> newest_;
};

}  // namespace phalanx
