// SPDX-License-Identifier: Apache-2.0
// The temporary file of an output that is not complete.
#pragma once

#include <filesystem>
#include <utility>

#include "phalanx/record/output_file.h"

namespace phalanx {

/// Throws std::runtime_error  "cannot WHAT 'FILE': REASON". @param error  an errno
[[noreturn]] void fail_to(const char* what, const std::filesystem::path& file, int error);

/// "<file>.partial", new and empty. If the file system has locks, it is locked (flock) as long as
/// this object lives.
class PartialFile {
 public:
  /// Removes an existing file in its place. With Unfinished::kLeft, a regular file is finished as OutputFile
  /// describes. A file that another program may be writing is left alone.
  /// @throws std::runtime_error as OutputFile
  PartialFile(std::filesystem::path file, Unfinished unfinished);
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile();  ///< keeps the file under its present name

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }  ///< for reading and writing
  /// @returns OutputFile::finished_earlier(), once.
  [[nodiscard]] std::filesystem::path take_finished_earlier() noexcept {
    return std::move(finished_earlier_);
  }

  /// Renames the file to the output's name. @throws std::runtime_error also if another program has put a file
  /// of its own in its place
  void rename_to_output();
  /// Removes the file, unless another program has put one in its place.
  void remove() const noexcept;

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
  std::filesystem::path finished_earlier_;
  int descriptor_ = -1;
};

/// @returns "<file>.partial".
[[nodiscard]] std::filesystem::path partial_name(const std::filesystem::path& file);

/// @returns true if the file has a whole second line: the first one is a log's header.
[[nodiscard]] bool has_rows(int descriptor) noexcept;

/// @returns true if `file` is a device or a pipe, for example, which a rename would replace by a file.
[[nodiscard]] bool stands_in_the_way(const std::filesystem::path& file);

/// Result of locking a file.
enum class FileLock {
  kTaken,
  kBusy,        ///< another program holds the lock
  kNotPossible  ///< the file system has no locks: other programs are unknown
};
/// Takes the lock of an open file (flock), for as long as it is open. A process that was killed may hold its
/// lock for a moment after its end: this waits for up to a second.
/// @param file  name for messages. @throws std::runtime_error
[[nodiscard]] FileLock lock_file(int descriptor, const std::filesystem::path& file);

}  // namespace phalanx
