// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "record/partial_file.h"

namespace phalanx {
namespace {

constexpr std::size_t kBufferBytes = 1U << 20U;
constexpr std::size_t kLongestNumber = 32;  // "-2.2250738585072014e-308" has 24

/// A rename would put a file in the place of a device or a pipe.
bool stands_in_the_way(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
}

void rename_or_fail(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (stands_in_the_way(to)) fail_to("write", to, EEXIST);
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) fail_to("write", to, error.value());
}

/// Takes what was written off `text`. @returns 0, or the system's reason
int write_off(int descriptor, std::string& text) noexcept {
  std::size_t written = 0;
  int error = 0;
  while (error == 0 && written < text.size()) {
    const ssize_t count = ::write(descriptor, text.data() + written, text.size() - written);
    if (count > 0) written += static_cast<std::size_t>(count);
    if (count < 0 && errno != EINTR) error = errno;
    if (count == 0) error = EIO;
  }
  text.erase(0, written);
  return error;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file, Unfinished unfinished)
    : file_(std::move(file)), partial_(partial_name(file_)), unfinished_(unfinished) {
  if (stands_in_the_way(file_))
    throw std::runtime_error(
        fmt::format("cannot write '{}': it is no ordinary file; name another", file_.string()));
  buffer_.reserve(kBufferBytes);
  PartialFile made = open_partial(file_, unfinished_);
  descriptor_ = made.descriptor;
  finished_earlier_ = std::move(made.finished_earlier);
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  if (unfinished_ == Unfinished::kLeft) write_off(descriptor_, buffer_);
  if (unfinished_ == Unfinished::kRemoved || !has_rows(descriptor_)) ::unlink(partial_.c_str());
  ::close(descriptor_);
}

void OutputFile::reserve(std::size_t bytes) {
  if (buffer_.size() + bytes > kBufferBytes) write_through();
}

void OutputFile::write_through() {
  if (const int error = write_off(descriptor_, buffer_); error != 0) fail_to("write", file_, error);
}

void OutputFile::text(std::string_view text) {
  reserve(text.size());
  buffer_.append(text);
}

void OutputFile::number(double value) {
  reserve(kLongestNumber);
  std::array<char, kLongestNumber> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  buffer_.append(digits.data(), end);
}

void OutputFile::integer(std::uint64_t value) {
  reserve(kLongestNumber);
  std::array<char, kLongestNumber> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  buffer_.append(digits.data(), end);
}

void OutputFile::commit() {
  write_through();
  // A log is made but once. Where a file system cannot do it, there is nothing to be done.
  if (unfinished_ == Unfinished::kLeft && ::fsync(descriptor_) != 0 && (errno == EIO || errno == ENOSPC))
    fail_to("write", file_, errno);
  rename_or_fail(partial_, file_);
  ::close(std::exchange(descriptor_, -1));  // and with it the lock
}

void write_then_rename(const std::filesystem::path& file,
                       const std::function<void(const std::filesystem::path&)>& write) {
  const std::filesystem::path partial = partial_name(file);
  ::close(open_partial(file, Unfinished::kRemoved).descriptor);
  try {
    write(partial);
    rename_or_fail(partial, file);
  } catch (...) {
    ::unlink(partial.c_str());
    throw;
  }
}

void write_text_file(const std::filesystem::path& file, std::string_view content) {
  OutputFile out(file);
  out.text(content);
  out.commit();
}

void prepare_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  const auto status = std::filesystem::status(folder, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_directory(status)) {
    throw std::invalid_argument(fmt::format(
        "output folder '{}' is a file; name a folder, or one that does not exist yet", folder.string()));
  }
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::invalid_argument(
        fmt::format("output folder '{}' cannot be made ({}); name one in a place you may write to",
                    folder.string(), error.message()));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw std::invalid_argument(
        fmt::format("output folder '{}' cannot be written to ({}); name one that you own", folder.string(),
                    std::strerror(errno)));
  }
}

}  // namespace phalanx
