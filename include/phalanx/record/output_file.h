// SPDX-License-Identifier: Apache-2.0
// A text file that appears under its name only when it is complete.
//
// All outputs of the folder are written with it. ticks_csv.h, poses_csv.h and contacts_csv.h hold the steps of a
// simulation, and summary.h its result. station_csv.h holds the log and the fault reports of a station.
// mesh_report_json.h holds the report of a mesh import. made.h states commit and machine in each result.
// docs/outputs.md describes the files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace phalanx {

class PartialFile;

/// Treatment of an output that is not committed.
enum class Unfinished {
  kRemoved,  ///< a result exists as a whole or not at all
  kLeft,     ///< a log: each written line is worth keeping
};

/// Output that is written to `<file>.partial` through a buffer, and renamed to `file` at commit(). A file
/// with the name `file` is therefore complete. The partial file is always a new one: a symbolic link in its
/// place is removed, not followed. It is locked while it is written, so that no other program takes it for a
/// left-over. On a file system without locks, an existing partial file is left alone, and the output refused.
/// Numbers are written as the shortest decimals that read back to the same bits, so that equal values give
/// equal files. Not real-time.
/// @throws std::runtime_error naming the file and the system's reason if it cannot be opened, written or
/// renamed, or if another program is writing it.
class OutputFile {
 public:
  /// Opens the output. With Unfinished::kLeft, a partial file of an earlier run is finished first: it is cut
  /// to its last whole line and renamed to a free name beside it. One without a second line holds no data
  /// and is removed.
  explicit OutputFile(std::filesystem::path file, Unfinished unfinished = Unfinished::kRemoved);
  /// Removes a file that was not committed, or writes its rest as far as possible and leaves it.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void text(std::string_view text);
  void number(double value);
  void integer(std::uint64_t value);

  /// Hands all text to the system: from here on, it outlives this process.
  void write_through();
  /// Calls write_through(), and writes to the disk itself: the text outlives a power failure, too.
  void synchronise();
  /// Writes the rest (a log also to the disk itself) and renames. Nothing may be written afterwards.
  void commit();

  /// @returns the path `<file>.partial`.
  [[nodiscard]] const std::filesystem::path& partial() const noexcept { return partial_; }
  /// @returns the new path of an earlier run's partial file; empty if there was none.
  [[nodiscard]] const std::filesystem::path& finished_earlier() const noexcept { return finished_earlier_; }

 private:
  void reserve(std::size_t bytes);

  std::filesystem::path file_;
  std::filesystem::path partial_;
  std::filesystem::path finished_earlier_;
  Unfinished unfinished_;
  std::unique_ptr<PartialFile> part_;  ///< null: committed
  std::string buffer_;
};

/// Calls `write` with `<file>.partial`, which exists, empty and locked; then renames that to `file`. It
/// removes the partial file if `write` throws. @throws as OutputFile, also if `write` puts another file
/// in its place
void write_then_rename(const std::filesystem::path& file,
                       const std::function<void(const std::filesystem::path&)>& write);

/// Writes `content` as a whole, to the disk itself: file, new name and folder outlive a power failure.
/// @throws as OutputFile.
void write_text_file(const std::filesystem::path& file, std::string_view content);

/// Checks that `folder` is a folder in which files can be made; creates it and its parents if necessary.
/// @throws std::invalid_argument naming the folder, the obstacle and the remedy.
/// @throws std::invalid_argument naming the folder, what is in the way and the remedy.
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace phalanx
