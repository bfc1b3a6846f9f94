// SPDX-License-Identifier: Apache-2.0
#include "record/partial_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 1U << 16U;  ///< bytes read at a time

/// Descriptor that is closed at the end of a scope.
struct Descriptor {
  explicit Descriptor(int number) : value(number) {}
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int value;
};

off_t size_of(int descriptor) noexcept {
  struct stat status{};
  return ::fstat(descriptor, &status) == 0 ? status.st_size : 0;
}

/// Calls `look(block)` for blocks from the beginning of the file, until it returns true.
template <class Look>
void read_blocks(int descriptor, Look look) noexcept {
  std::array<char, kBlock> block;
  off_t at = 0;
  for (;;) {
    const ssize_t count = ::pread(descriptor, block.data(), block.size(), at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0 || look(std::string_view(block.data(), static_cast<std::size_t>(count)))) return;
    at += count;
  }
}

/// @returns the end of the file's last whole line [bytes].
off_t end_of_last_line(int descriptor) noexcept {
  std::array<char, kBlock> block;
  for (off_t end = size_of(descriptor); end > 0;) {
    const off_t begin = std::max<off_t>(0, end - static_cast<off_t>(kBlock));
    const ssize_t count = ::pread(descriptor, block.data(), static_cast<std::size_t>(end - begin), begin);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return 0;
    const std::size_t last = std::string_view(block.data(), static_cast<std::size_t>(count)).rfind('\n');
    if (last != std::string_view::npos) return begin + static_cast<off_t>(last) + 1;
    end = begin;
  }
  return 0;
}

/// @returns "x-recovered.csv", "x-recovered-2.csv", ...
fs::path recovered_name(const fs::path& file, int number) {
  fs::path name = file;
  name.replace_filename(fmt::format("{}-recovered{}{}", file.stem().string(),
                                    number > 1 ? fmt::format("-{}", number) : "", file.extension().string()));
  return name;
}

/// Renames to a name that no file has. @returns the new name
fs::path rename_to_free_name(const fs::path& partial, const fs::path& file) {
  for (int number = 1;; ++number) {
    const fs::path to = recovered_name(file, number);
    if (::renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return to;
    if (errno == EINVAL || errno == ENOSYS) {  // a file system that cannot do it atomically
      if (::link(partial.c_str(), to.c_str()) == 0) {
        ::unlink(partial.c_str());
        return to;
      }
    }
    if (errno != EEXIST) fail_to("finish the log that an earlier run left in", partial, errno);
  }
}

void remove_partial(const fs::path& partial) {
  if (::unlink(partial.c_str()) != 0 && errno != ENOENT) fail_to("write", partial, errno);
}

/// @returns true if `partial` is still the name of the open file: its writer may have renamed it meanwhile.
bool is_name_of(const fs::path& partial, int descriptor) noexcept {
  struct stat named{};
  struct stat open{};
  return ::lstat(partial.c_str(), &named) == 0 && ::fstat(descriptor, &open) == 0 &&
         named.st_ino == open.st_ino && named.st_dev == open.st_dev;
}

/// Cuts the file of an earlier run to its last whole line. A file with a second name may belong to another
/// program, and is not cut.
fs::path finish(int descriptor, const fs::path& partial, const fs::path& file) {
  struct stat status{};
  if (::fstat(descriptor, &status) == 0 && status.st_nlink == 1 &&
      ::ftruncate(descriptor, end_of_last_line(descriptor)) != 0)
    fail_to("finish the log that an earlier run left in", partial, errno);
  return rename_to_free_name(partial, file);
}

/// Refuses a file that another program writes, or may be writing: it must be neither cut nor removed.
void refuse_if_written(int descriptor, const fs::path& partial, const fs::path& file) {
  switch (lock_file(descriptor, partial)) {
    case FileLock::kTaken:
      return;
    case FileLock::kBusy:
      throw std::runtime_error(fmt::format(
          "cannot write '{}': another program is writing it; wait until that has ended, or name another file",
          file.string()));
    case FileLock::kNotPossible:
      throw std::runtime_error(fmt::format(
          "cannot write '{}': '{}' is there, and this file system has no locks that tell whether "
          "another program is writing it; if none is, rename or remove it, else name another file",
          file.string(), partial.string()));
  }
}

/// Removes an existing file in the partial file's place. @returns OutputFile::finished_earlier()
fs::path make_way(const fs::path& partial, const fs::path& file, Unfinished unfinished) {
  struct stat status{};
  if (::lstat(partial.c_str(), &status) != 0) return {};
  if (!S_ISREG(status.st_mode)) {
    remove_partial(partial);
    return {};
  }
  const Descriptor there(::open(partial.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC));
  if (there.value < 0) {
    if (errno == ENOENT || errno == ELOOP) return {};  // it has changed meanwhile
    throw std::runtime_error(
        fmt::format("cannot write '{}': '{}' is there and cannot be opened: {}; rename or remove it, or name "
                    "another file",
                    file.string(), partial.string(), std::strerror(errno)));
  }
  refuse_if_written(there.value, partial, file);
  if (!is_name_of(partial, there.value)) return {};
  if (unfinished == Unfinished::kLeft && has_rows(there.value)) return finish(there.value, partial, file);
  remove_partial(partial);
  return {};
}

}  // namespace

void fail_to(const char* what, const fs::path& file, int error) {
  throw std::runtime_error(fmt::format("cannot {} '{}': {}", what, file.string(), std::strerror(error)));
}

fs::path partial_name(const fs::path& file) {
  fs::path partial = file;
  partial += ".partial";
  return partial;
}

bool has_rows(int descriptor) noexcept {
  int lines = 0;
  read_blocks(descriptor, [&](std::string_view block) {
    for (const char c : block)
      if (c == '\n' && ++lines == 2) return true;
    return false;
  });
  return lines == 2;
}

bool stands_in_the_way(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
}

FileLock lock_file(int descriptor, const fs::path& file) {
  constexpr int kTries = 20;
  constexpr auto kPause = std::chrono::milliseconds(50);
  for (int i = 0; i < kTries; ++i) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return FileLock::kTaken;
    if (errno == EOPNOTSUPP || errno == ENOSYS || errno == EINVAL || errno == ENOLCK)
      return FileLock::kNotPossible;
    if (errno != EWOULDBLOCK && errno != EINTR) fail_to("lock", file, errno);
    std::this_thread::sleep_for(kPause);
  }
  return FileLock::kBusy;
}

PartialFile::PartialFile(fs::path file, Unfinished unfinished)
    : file_(std::move(file)), path_(partial_name(file_)) {
  constexpr int kTries = 8;  ///< against programs that repeatedly put a file in its place
  for (int i = 0; i < kTries; ++i) {
    Descriptor made(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (made.value >= 0) {
      if (lock_file(made.value, path_) != FileLock::kBusy && is_name_of(path_, made.value)) {
        descriptor_ = std::exchange(made.value, -1);
        return;
      }  // else another start has taken it for a left-over
    } else if (errno != EEXIST) {
      fail_to("write", file_, errno);
    }
    if (fs::path earlier = make_way(path_, file_, unfinished); !earlier.empty())
      finished_earlier_ = std::move(earlier);
  }
  fail_to("write", file_, EEXIST);
}

PartialFile::~PartialFile() { ::close(descriptor_); }

void PartialFile::rename_to_output() {
  if (stands_in_the_way(file_)) fail_to("write", file_, EEXIST);
  if (!is_name_of(path_, descriptor_))
    throw std::runtime_error(
        fmt::format("cannot write '{}': another program has put a file of its own in the place of '{}'; end "
                    "that program, or name another file",
                    file_.string(), path_.string()));
  if (::rename(path_.c_str(), file_.c_str()) != 0) fail_to("write", file_, errno);
}

void PartialFile::remove() const noexcept {
  if (is_name_of(path_, descriptor_)) ::unlink(path_.c_str());
}

}  // namespace phalanx
