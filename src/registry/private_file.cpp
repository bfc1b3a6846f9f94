// SPDX-License-Identifier: Apache-2.0
#include "registry/private_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "phalanx/registry/registry_error.h"
#include "record/synchronise_folder.h"
#include "registry/crypto.h"

namespace phalanx::registry {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const char* what, int reason) {
  throw RegistryError(RegistryFault::kDisk,
                      fmt::format("{} cannot be {}: {}; check the disk and its rights", file.string(), what,
                                  std::generic_category().message(reason)));
}

void synchronise_parent(const fs::path& file) {
  try {
    synchronise_folder(file.parent_path());
  } catch (const std::system_error& error) {
    fail(file.parent_path(), "synchronised", error.code().value());
  }
}

/// @returns 0, or the reason
int write_all(int descriptor, std::string_view content) noexcept {
  while (!content.empty()) {
    const ssize_t count = ::write(descriptor, content.data(), content.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    content.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

void overwrite_bytes(const fs::path& name, int descriptor) {
  struct stat state{};
  if (::fstat(descriptor, &state) != 0) fail(name, "overwritten", errno);
  if (::lseek(descriptor, 0, SEEK_SET) < 0) fail(name, "overwritten", errno);
  constexpr std::uint64_t kPart = 1U << 16U;
  for (auto left = static_cast<std::uint64_t>(state.st_size); left > 0;) {
    const std::uint64_t part = std::min(left, kPart);
    const int reason = write_all(descriptor, random_bytes(part));
    if (reason != 0) fail(name, "overwritten", reason);
    left -= part;
  }
  if (::fsync(descriptor) != 0) fail(name, "overwritten", errno);
}

fs::path old_name(const fs::path& file) { return file.string() + ".old"; }

Descriptor open_new(const fs::path& file) {
  erase_private_file(file);  // of a program that was killed
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!out.valid()) fail(file, "made", errno);
  return out;
}

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

FileLock::FileLock(const fs::path& file)
    : file_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)) {
  if (!file_.valid()) fail(file, "opened", errno);
  while (::flock(file_.number(), LOCK_EX) != 0)
    if (errno != EINTR) fail(file, "locked", errno);
}

std::optional<FileStamp> stamp_of(const fs::path& file) {
  struct stat state{};
  if (::stat(file.c_str(), &state) != 0) return std::nullopt;
  return FileStamp{.inode = state.st_ino,
                   .bytes = static_cast<std::uint64_t>(state.st_size),
                   .changed_ns = state.st_mtim.tv_sec * 1'000'000'000 + state.st_mtim.tv_nsec};
}

std::optional<std::string> read_private_file(const fs::path& file, std::uint64_t begin) {
  const Descriptor from(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!from.valid()) {
    if (errno == ENOENT) return std::nullopt;
    fail(file, "read", errno);
  }
  if (begin > 0 && ::lseek(from.number(), static_cast<off_t>(begin), SEEK_SET) < 0) fail(file, "read", errno);
  std::string out;
  std::string part(1U << 16U, '\0');
  for (;;) {
    const ssize_t count = ::read(from.number(), part.data(), part.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(file, "read", errno);
    if (count == 0) return out;
    out.append(part, 0, static_cast<std::size_t>(count));
  }
}

void replace_private_file(const fs::path& file, std::string_view content, bool overwrite) {
  const fs::path made = file.string() + ".new";
  Descriptor to = open_new(made);
  int reason = write_all(to.number(), content);
  if (reason == 0 && ::fsync(to.number()) != 0) reason = errno;
  if (reason != 0) {
    ::unlink(made.c_str());
    fail(file, "written", reason);
  }
  Descriptor unnamed;  // on file systems without hard links
  if (overwrite) {
    finish_replacement(file);
    if (::link(file.c_str(), old_name(file).c_str()) != 0 && errno != ENOENT)
      unnamed = Descriptor(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW));
  }
  if (::rename(made.c_str(), file.c_str()) != 0) {
    reason = errno;
    ::unlink(made.c_str());
    fail(file, "replaced", reason);
  }
  synchronise_parent(file);
  if (unnamed.valid()) overwrite_bytes(file, unnamed.number());
  if (overwrite) finish_replacement(file);
}

void finish_replacement(const fs::path& file) {
  const fs::path old = old_name(file);
  const std::optional<FileStamp> replaced = stamp_of(old);
  if (!replaced) return;
  const std::optional<FileStamp> current = stamp_of(file);
  if (current && current->inode == replaced->inode) {  // it was not replaced: both names are the same file
    if (::unlink(old.c_str()) != 0) fail(old, "removed", errno);
    return;
  }
  erase_private_file(old);
}

void synchronise_file(const fs::path& file) {
  const Descriptor written(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!written.valid() || ::fsync(written.number()) != 0) fail(file, "synchronised", errno);
  synchronise_parent(file);
}

void append_private_file(const fs::path& file, std::string_view content) {
  const bool existed = stamp_of(file).has_value();
  const Descriptor to(::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!to.valid()) fail(file, "written", errno);
  const off_t before = ::lseek(to.number(), 0, SEEK_END);
  int reason = write_all(to.number(), content);
  if (reason == 0 && ::fsync(to.number()) != 0) reason = errno;
  if (reason != 0) {
    static_cast<void>(::ftruncate(to.number(), before) == 0);
    fail(file, "written", reason);
  }
  if (!existed) synchronise_parent(file);
}

void cut_private_file(const fs::path& file, std::uint64_t bytes) {
  const Descriptor to(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW));
  if (!to.valid()) fail(file, "cut", errno);
  if (::ftruncate(to.number(), static_cast<off_t>(bytes)) != 0 || ::fsync(to.number()) != 0)
    fail(file, "cut", errno);
}

void erase_private_file(const fs::path& file) {
  {
    const Descriptor old(::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW));
    if (!old.valid() && errno == ENOENT) return;
    if (old.valid()) overwrite_bytes(file, old.number());
  }
  if (::unlink(file.c_str()) != 0 && errno != ENOENT) fail(file, "removed", errno);
  synchronise_parent(file);
}

void make_private_folder(const fs::path& folder) {
  if (fs::is_directory(folder)) return;
  std::error_code error;
  if (folder.has_parent_path()) fs::create_directories(folder.parent_path(), error);
  if (error) fail(folder.parent_path(), "made", error.value());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) fail(folder, "made", errno);
  synchronise_parent(folder);
}

}  // namespace phalanx::registry
