// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace phalanx::mcap {

/// Bytes that are read as a file.
struct InMemory {
  std::string_view bytes;
};

/// A part of a file that could not be read.
struct Damage {
  std::uint64_t place = 0;
  std::uint64_t length = 0;  ///< [bytes]
  std::string what;
};

/// Bytes of a file as they are on the disk, or in memory.
class StoredBytes {
 public:
  /// @throws std::system_error if it cannot be opened; McapError if it is no regular file
  explicit StoredBytes(const std::filesystem::path& file);
  /// Reads from memory, which must outlive this object.
  explicit StoredBytes(InMemory memory) : bytes_(memory.bytes), size_(memory.bytes.size()) {}
  StoredBytes(const StoredBytes&) = delete;
  StoredBytes& operator=(const StoredBytes&) = delete;
  ~StoredBytes();

  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }  ///< when it was opened
  /// Reads up to `length` bytes into `out`; fewer if the file ends before. @throws std::system_error
  void read(std::uint64_t place, std::uint64_t length, std::string& out) const;

 private:
  int descriptor_ = -1;
  std::string_view bytes_;
  std::uint64_t size_ = 0;
};

}  // namespace phalanx::mcap
