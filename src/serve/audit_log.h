// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "phalanx/cockpit.pb.h"

namespace phalanx {

/// Who did what and when: every notice, as a JSON line in a file that is only ever appended to, and the
/// newest in memory for pages that come: these shortened, so that all of them together stay a small message.
/// One thread at a time.
class AuditLog {
 public:
  static constexpr std::size_t kRemembered = 100;
  static constexpr std::size_t kTextLength = 2000;  ///< of one in memory [bytes]

  static constexpr std::uintmax_t kFileLength = 64'000'000;  ///< of the file [bytes]

  /// @param file  empty: memory alone. Its folder is made. @throws std::runtime_error if it cannot be written
  /// @param file_length  a line that would make it longer begins it anew; what it held is then in the file
  ///                     with ".1" behind its name, instead of what was there [bytes]
  explicit AuditLog(std::filesystem::path file, std::uintmax_t file_length = kFileLength);

  /// Each line is handed to the system at once. A disk that is full ends the file, not the program: from then
  /// on broken() holds.
  void add(const wire::Notice& notice);
  [[nodiscard]] const std::deque<wire::Notice>& newest() const noexcept { return newest_; }
  [[nodiscard]] bool broken() const noexcept { return broken_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  void open();
  void write(const std::string& line);
  /// @returns whether there is a file again
  bool begin_anew();

  std::filesystem::path path_;
  std::uintmax_t file_length_;
  std::uintmax_t written_ = 0;  ///< what the file holds [bytes]
  std::unique_ptr<std::FILE, Close> file_;
  std::deque<wire::Notice> newest_;
  bool broken_ = false;
};

}  // namespace phalanx
