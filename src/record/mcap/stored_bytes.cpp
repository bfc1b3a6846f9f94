// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/stored_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "record/mcap/mcap_bytes.h"

namespace phalanx::mcap {

StoredBytes::StoredBytes(const std::filesystem::path& file)
    : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), file.string());
  struct stat status{};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw McapError(fmt::format("{} is no regular file; name a recording", file.string()));
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

StoredBytes::~StoredBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void StoredBytes::read(std::uint64_t place, std::uint64_t length, std::string& out) const {
  out.clear();
  if (place >= size_) return;
  length = std::min(length, size_ - place);
  if (descriptor_ < 0) {
    out.assign(bytes_.substr(static_cast<std::size_t>(place), static_cast<std::size_t>(length)));
    return;
  }
  out.resize(static_cast<std::size_t>(length));
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t count =
        ::pread(descriptor_, out.data() + done, out.size() - done, static_cast<off_t>(place + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category(), "read");
    if (count == 0) break;  // it was cut meanwhile
    done += static_cast<std::size_t>(count);
  }
  out.resize(done);
}

}  // namespace phalanx::mcap
