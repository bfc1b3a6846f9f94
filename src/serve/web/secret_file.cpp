// SPDX-License-Identifier: Apache-2.0
#include "serve/web/secret_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "device/descriptor.h"

namespace phalanx::web {
namespace {

constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error = errno) {
  throw std::runtime_error(fmt::format("{}: {} ({})", path.string(), what, std::strerror(error)));
}

bool write_whole(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void make_secret_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw std::runtime_error(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
  if (::chmod(folder.c_str(), S_IRWXU) != 0) fail(folder, "cannot be closed to others");
}

void write_secret_file(const std::filesystem::path& path, std::string_view text) {
  std::string name = path.string() + ".XXXXXX";
  const Descriptor file(::mkostemp(name.data(), O_CLOEXEC));  // mode 0600
  if (file.value() < 0) fail(path, "cannot be written");
  const bool written = write_whole(file.value(), text) && ::fsync(file.value()) == 0;
  if (written && ::rename(name.c_str(), path.c_str()) == 0) return;
  const int error = errno;
  ::unlink(name.c_str());
  fail(path, "cannot be written", error);
}

void keep_secret(const std::filesystem::path& path) {
  if (::chmod(path.c_str(), kOwnerOnly) != 0) fail(path, "cannot be closed to others");
}

}  // namespace phalanx::web
