// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/mcap_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "record/synchronise_folder.h"

namespace phalanx::mcap {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

DiskFile::DiskFile(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600)) {
  if (descriptor_ < 0) fail(file.c_str());
  // Waits for a program that looks whether the file is being written. A file system without locks is accepted.
  while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
  try {
    synchronise_folder(file.parent_path());
  } catch (...) {
    ::close(descriptor_);
    ::unlink(file.c_str());
    throw;
  }
}

DiskFile::~DiskFile() { ::close(descriptor_); }

void DiskFile::write(std::uint64_t place, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = EIO;
    if (written <= 0) fail("write");
    place += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void DiskFile::synchronise() {
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL) fail("synchronise");
}

void DiskFile::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) fail("truncate");
}

bool is_being_written(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return locked;
}

}  // namespace phalanx::mcap
