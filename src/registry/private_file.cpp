// SPDX-License-Identifier: Apache-2.0
#include "registry/private_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>
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

constexpr std::chrono::milliseconds kBetweenTries{5};  // to take a lock

Descriptor open_lock(const fs::path& file) {
  Descriptor opened(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!opened.valid()) fail(file, "opened", errno);
  return opened;
}

/// @returns false if another program or thread has a lock that excludes this one
bool try_lock(const fs::path& file, const Descriptor& opened, int kind) {
  while (::flock(opened.number(), kind | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) fail(file, "locked", errno);
  }
  return true;
}

/// @returns true for a word of a command, such as "rebuild": no code, no name and no path
bool is_command_word(const std::string& word) {
  return !word.empty() && word.front() != '-' && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::islower(c) != 0 || c == '-';
  });
}

/// @returns program and command of a process, as "phalanx patient rebuild (process 1234)". What follows the command is
/// left out: it may name a patient
std::string process_name(long process) {
  std::ifstream file(fmt::format("/proc/{}/cmdline", process), std::ios::binary);
  std::string name;
  std::string word;
  for (int i = 0; i < 3 && std::getline(file, word, '\0'); ++i) {
    if (i == 0) {
      name = fs::path(word).filename().string();
      continue;
    }
    if (!is_command_word(word)) break;
    name.append(" ").append(word);
    if (word == "run") break;  // a scene follows
  }
  return fmt::format("{} (process {})", name.empty() ? "a program" : name, process);
}

/// @returns the program that the system's list of locks names for a file
std::string named_holder(const fs::path& file) {
  constexpr const char* kUnknown = "another program";
  struct stat state{};
  if (::stat(file.c_str(), &state) != 0) return kUnknown;
  const std::string place =
      fmt::format("{:02x}:{:02x}:{}", major(state.st_dev), minor(state.st_dev), state.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream fields(line);
    std::string number;
    std::string kind;
    std::string advisory;
    std::string mode;
    long process = 0;
    std::string inode;
    if (fields >> number >> kind >> advisory >> mode >> process >> inode && kind == "FLOCK" &&
        inode == place && process > 0)
      return process_name(process);
  }
  return kUnknown;
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

FileLock::FileLock(const fs::path& file) : file_(open_lock(file)) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience);
  while (!try_lock(file, file_, LOCK_EX)) {
    if (std::chrono::steady_clock::now() >= give_up)
      throw RegistryError(RegistryFault::kBusy,
                          fmt::format("{} has held {} for more than {} s; wait until it is done, or end it, "
                                      "then try again",
                                      named_holder(file), file.string(), kPatience));
    std::this_thread::sleep_for(kBetweenTries);
  }
}

SharedLock::SharedLock(const fs::path& file) : file_(open_lock(file)) {
  if (!try_lock(file, file_, LOCK_SH))
    throw RegistryError(RegistryFault::kBusy,
                        fmt::format("{} holds {}; try again", named_holder(file), file.string()));
}

std::optional<std::string> holder_of(const fs::path& file) {
  const Descriptor opened(::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW));
  if (!opened.valid()) {
    if (errno == ENOENT) return std::nullopt;
    fail(file, "opened", errno);
  }
  if (try_lock(file, opened, LOCK_EX)) return std::nullopt;
  return named_holder(file);
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
