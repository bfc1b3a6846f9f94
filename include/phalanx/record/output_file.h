// SPDX-License-Identifier: Apache-2.0
// A text file that appears under its name only when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace phalanx {

/// What becomes of an output that is not committed.
enum class Unfinished {
  kRemoved,  ///< a result is whole or not there
  kLeft,     ///< a log: each line that was written is worth keeping
};

/// Writes `<file>.partial` through a buffer and renames it to `file` at commit(): `file`, where it is seen,
/// is complete. The partial file is always a new one: a symbolic link in its place is removed, not followed.
/// It is locked while it is written, so that no other program takes it for one that was left behind. Numbers
/// are written as the shortest decimals that read back to the same bits, so that equal values give equal
/// files. Not real-time. @throws std::runtime_error naming the file and the system's reason if it cannot be
/// opened, written or renamed, or if another program is writing it.
class OutputFile {
 public:
  /// With Unfinished::kLeft, a partial file that an earlier run left behind is finished first: cut to its
  /// last whole line and renamed to a free name beside it. One without a second line holds no data and is
  /// removed.
  explicit OutputFile(std::filesystem::path file, Unfinished unfinished = Unfinished::kRemoved);
  /// What is not committed is removed, or written out as far as possible and left.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void text(std::string_view text);
  void number(double value);
  void integer(std::uint64_t value);

  /// Hands all of it to the system: from here on it outlives this process, however that ends.
  void write_through();
  /// Writes the rest, a log to the disk itself, and renames. Nothing may be written afterwards.
  void commit();

  /// `<file>.partial`
  [[nodiscard]] const std::filesystem::path& partial() const noexcept { return partial_; }
  /// Where what an earlier run left behind is now; empty if it left nothing.
  [[nodiscard]] const std::filesystem::path& finished_earlier() const noexcept { return finished_earlier_; }

 private:
  void reserve(std::size_t bytes);

  std::filesystem::path file_;
  std::filesystem::path partial_;
  std::filesystem::path finished_earlier_;
  Unfinished unfinished_;
  int descriptor_ = -1;
  std::string buffer_;
};

/// Lets `write` write `<file>.partial`, then renames that to `file`; removes it if `write` throws.
void write_then_rename(const std::filesystem::path& file,
                       const std::function<void(const std::filesystem::path&)>& write);

/// Writes `content` as a whole. @throws as OutputFile.
void write_text_file(const std::filesystem::path& file, std::string_view content);

/// Makes sure that `folder` is a folder in which files can be made, creating it and its parents.
/// @throws std::invalid_argument naming the folder, what is in the way and the remedy.
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace phalanx
