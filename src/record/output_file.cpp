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
#include "record/synchronise_folder.h"

namespace phalanx {
namespace {

constexpr std::size_t kBufferBytes = 1U << 20U;
constexpr std::size_t kLongestNumber = 32;  // "-2.2250738585072014e-308" has 24

/// Writes text, and removes the written part from `text`. @returns 0, or the system's reason
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
  part_ = std::make_unique<PartialFile>(file_, unfinished_);
  finished_earlier_ = part_->take_finished_earlier();  // nothing may throw from here on, or the
                                                       // file would stay
}

OutputFile::~OutputFile() {
  if (!part_) return;
  if (unfinished_ == Unfinished::kLeft) write_off(part_->descriptor(), buffer_);
  if (unfinished_ == Unfinished::kRemoved || !has_rows(part_->descriptor())) part_->remove();
}

void OutputFile::reserve(std::size_t bytes) {
  if (buffer_.size() + bytes > kBufferBytes) write_through();
}

void OutputFile::write_through() {
  if (const int error = write_off(part_->descriptor(), buffer_); error != 0) fail_to("write", file_, error);
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

void OutputFile::synchronise() {
  write_through();
  // A file system that cannot do it is accepted.
  if (::fsync(part_->descriptor()) != 0 && (errno == EIO || errno == ENOSPC)) fail_to("write", file_, errno);
}

void OutputFile::commit() {
  write_through();
  if (unfinished_ == Unfinished::kLeft) synchronise();  // a log exists only once
  part_->rename_to_output();
  part_.reset();  // releases the lock
}

void write_then_rename(const std::filesystem::path& file,
                       const std::function<void(const std::filesystem::path&)>& write) {
  PartialFile part(file, Unfinished::kRemoved);
  try {
    write(part.path());
    part.rename_to_output();
  } catch (...) {
    part.remove();
    throw;
  }
}

void write_text_file(const std::filesystem::path& file, std::string_view content) {
  OutputFile out(file);
  out.text(content);
  out.synchronise();
  out.commit();
  try {
    synchronise_folder(file.parent_path());
  } catch (const std::system_error& error) {
    fail_to("write", file, error.code().value());
  }
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
