// SPDX-License-Identifier: Apache-2.0
#include "serve/web/secret_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "device/descriptor.h"
#include "phalanx/serve/web_server.h"

namespace phalanx::web {
namespace {

constexpr mode_t kOwnerOnly = S_IRUSR | S_IWUSR;
constexpr mode_t kOthers = S_IRWXG | S_IRWXO;
constexpr mode_t kPermissions = S_IRWXU | kOthers;
constexpr std::size_t kLongest = 64 * 1024;  // [bytes]

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error = errno) {
  throw WebServerError(fmt::format("{}: {} ({})", path.string(), what, std::strerror(error)));
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

std::string read_whole(const std::filesystem::path& path, int descriptor) {
  std::string text;
  std::array<char, 4096> piece{};
  for (;;) {
    const ssize_t got = ::read(descriptor, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, "cannot be read");
    if (got == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(got));
    if (text.size() > kLongest) {
      throw WebServerError(
          fmt::format("{}: this is longer than {} bytes; give a key in PEM", path.string(), kLongest));
    }
  }
}

}  // namespace

void make_secret_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return;
  std::filesystem::create_directories(folder, error);
  if (error) throw WebServerError(fmt::format("{}: cannot be made ({})", folder.string(), error.message()));
  if (::chmod(folder.c_str(), S_IRWXU) != 0) fail(folder, "others cannot be kept from reading it");
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

std::string read_secret_file(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status{};
  if (file.value() < 0 || ::fstat(file.value(), &status) != 0) fail(path, "cannot be read");
  if (status.st_uid != ::geteuid() && status.st_uid != 0) {
    throw WebServerError(
        fmt::format("{}: this belongs to another user; give a key file of your own that only you may read",
                    path.string()));
  }
  if ((status.st_mode & kOthers) != 0) {
    throw WebServerError(
        fmt::format("{}: others than its owner may read or write it (mode {:04o}); make a new key if they "
                    "may have read it, and type: chmod 600 {}",
                    path.string(), status.st_mode & kPermissions, path.string()));
  }
  return read_whole(path, file.value());
}

void restrict_to_owner(const std::filesystem::path& path) {
  if (::chmod(path.c_str(), kOwnerOnly) != 0) fail(path, "others cannot be kept from reading it");
}

}  // namespace phalanx::web
