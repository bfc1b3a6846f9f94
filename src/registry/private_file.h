// SPDX-License-Identifier: Apache-2.0
// Files of mode 0600: read, replaced as a whole, appended to, overwritten, locked. Every
// write is synchronised.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace phalanx::registry {

/// An open file, closed with this object.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) noexcept : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] bool valid() const noexcept { return number_ >= 0; }

 private:
  int number_;
};

/// Exclusive lock among programs and threads, by a file of its own. The system ends it with the process.
class FileLock {
 public:
  static constexpr double kPatience = 10.0;  ///< [s]

  /// Waits for the lock, at most kPatience. @throws RegistryError kDisk; kBusy, naming the program that holds it
  explicit FileLock(const std::filesystem::path& file);

 private:
  Descriptor file_;
};

/// Shared lock of a file: any number of programs hold it, and no program can have it alone meanwhile.
class SharedLock {
 public:
  /// Makes the file and takes the lock. @throws RegistryError kDisk; kBusy if a program has it alone
  explicit SharedLock(const std::filesystem::path& file);

 private:
  Descriptor file_;
};

/// @returns the program that holds a lock of this file, such as "phalanx run (process 1234)"; none: no program holds one
/// @throws RegistryError kDisk
[[nodiscard]] std::optional<std::string> holder_of(const std::filesystem::path& file);

/// Identity of a file's content as far as the file system tells it: another one means that it
/// may have changed.
struct FileStamp {
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;
  [[nodiscard]] bool operator==(const FileStamp&) const = default;
};
/// @returns none if there is no such file
[[nodiscard]] std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// Synchronises a file that another library wrote, and its folder. @throws RegistryError kDisk
void synchronise_file(const std::filesystem::path& file);
/// @returns the bytes from `begin` on; none if there is no such file. @throws RegistryError kDisk
[[nodiscard]] std::optional<std::string> read_private_file(const std::filesystem::path& file,
                                                           std::uint64_t begin = 0);
/// Puts a new file in the place of an old one, at one moment. @param overwrite  then overwrites the old
/// file's bytes. They have the name `<file>.old` until then, so that finish_replacement() can do it
/// after a kill.
/// @throws RegistryError kDisk; the old file is then still there
void replace_private_file(const std::filesystem::path& file, std::string_view content,
                          bool overwrite = false);
/// Overwrites and removes the old file that a killed replace_private_file() left. The caller holds the lock
/// of all writers.
/// @throws RegistryError kDisk
void finish_replacement(const std::filesystem::path& file);
/// Appends to a file, which is made if necessary. @throws RegistryError kDisk; the file then has
/// its old length
void append_private_file(const std::filesystem::path& file, std::string_view content);
/// Cuts a file to a length. @throws RegistryError kDisk
void cut_private_file(const std::filesystem::path& file, std::uint64_t bytes);
/// Overwrites a file's bytes and removes it; accepts that it does not exist. @throws RegistryError kDisk
void erase_private_file(const std::filesystem::path& file);
/// Makes a folder with mode 0700 and its parents. @throws RegistryError kDisk
void make_private_folder(const std::filesystem::path& folder);

}  // namespace phalanx::registry
