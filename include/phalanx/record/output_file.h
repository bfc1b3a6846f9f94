// SPDX-License-Identifier: Apache-2.0
// A text file that appears under its name only when it is complete.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace phalanx {

/// Writes `<file>.partial` through a buffer and renames it to `file` at commit(): whoever sees `file` sees
/// all of it. What is not committed is removed. Numbers are written as the shortest decimals that read back
/// to the same bits, so that equal values give equal files. Not real-time. @throws std::runtime_error naming
/// the file and the system's reason if it cannot be opened, written or renamed.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void text(std::string_view text);
  void number(double value);
  void integer(std::uint64_t value);

  /// Flushes, closes and renames. Nothing may be written afterwards.
  void commit();

  /// Gives up, and leaves what has reached the disk where it is. Nothing may be written afterwards.
  /// @returns `<file>.partial`
  std::filesystem::path leave_partial() noexcept;

 private:
  void reserve(std::size_t bytes);
  void flush();

  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::filesystem::path file_;
  std::filesystem::path partial_;
  std::unique_ptr<std::FILE, Close> stream_;
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
