// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace phalanx {

/// Synchronises a folder: names that were made, renamed or removed in it outlive a power failure. A file system that cannot
/// do it is accepted. @throws std::system_error if the folder cannot be opened, or the disk fails
inline void synchronise_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), folder.string());
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  if (result != 0 && (reason == EIO || reason == ENOSPC))
    throw std::system_error(reason, std::generic_category(), folder.string());
}

}  // namespace phalanx
