// SPDX-License-Identifier: Apache-2.0
// The file below an McapWriter: what is written where, and what is on the disk for good.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace phalanx::mcap {

/// A new file that is written at given places. Tests put a file system in its place that loses what was not synchronised.
class WritableFile {
 public:
  WritableFile() = default;
  WritableFile(const WritableFile&) = delete;
  WritableFile& operator=(const WritableFile&) = delete;
  virtual ~WritableFile() = default;

  /// Writes bytes at a place. After a failure, what is there is unknown; the caller writes the same again, or truncates.
  /// @throws std::system_error with the system's reason
  virtual void write(std::uint64_t place, std::string_view bytes) = 0;
  /// Waits until all that was written is on the disk: fdatasync(). @throws std::system_error
  virtual void synchronise() = 0;
  /// @throws std::system_error
  virtual void truncate(std::uint64_t size) = 0;
};

/// The file system's file. It is locked (flock) while it is open, so that another program can see that it is being written.
class DiskFile final : public WritableFile {
 public:
  /// Creates the file, and synchronises its folder, so that its name outlives a power failure, too.
  /// @throws std::system_error if it exists already, or cannot be made; what() names it
  explicit DiskFile(const std::filesystem::path& file);
  ~DiskFile() override;

  void write(std::uint64_t place, std::string_view bytes) override;
  void synchronise() override;
  void truncate(std::uint64_t size) override;

 private:
  int descriptor_;
};

/// @returns true if a DiskFile, of this or of another program, has the file open
[[nodiscard]] bool is_being_written(const std::filesystem::path& file);

}  // namespace phalanx::mcap
