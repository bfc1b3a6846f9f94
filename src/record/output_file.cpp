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

namespace phalanx {
namespace {

constexpr std::size_t kBufferBytes = 1U << 20U;
constexpr std::size_t kLongestNumber = 32;  // "-2.2250738585072014e-308" has 24

std::filesystem::path partial_name(const std::filesystem::path& file) {
  std::filesystem::path partial = file;
  partial += ".partial";
  return partial;
}

[[noreturn]] void fail(const char* what, const std::filesystem::path& file, int error) {
  throw std::runtime_error(fmt::format("cannot {} '{}': {}", what, file.string(), std::strerror(error)));
}

/// A rename would put a file in the place of a device or a pipe.
bool stands_in_the_way(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
}

void rename_or_fail(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code ignored;
  std::error_code error;
  if (stands_in_the_way(to)) {
    error = std::make_error_code(std::errc::file_exists);
  } else {
    std::filesystem::rename(from, to, error);
  }
  if (!error) return;
  std::filesystem::remove(from, ignored);
  fail("write", to, error.value());
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)), partial_(partial_name(file_)) {
  if (stands_in_the_way(file_))
    throw std::runtime_error(
        fmt::format("cannot write '{}': it is no ordinary file; name another", file_.string()));
  stream_.reset(std::fopen(partial_.c_str(), "wb"));
  if (!stream_) fail("write", file_, errno);
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (!stream_) return;
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

std::filesystem::path OutputFile::leave_partial() noexcept {
  stream_.reset();
  return partial_;
}

void OutputFile::reserve(std::size_t bytes) {
  if (buffer_.size() + bytes > kBufferBytes) flush();
}

void OutputFile::flush() {
  if (std::fwrite(buffer_.data(), 1, buffer_.size(), stream_.get()) != buffer_.size()) {
    fail("write", file_, errno);
  }
  buffer_.clear();
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
  flush();
  if (std::fflush(stream_.get()) != 0) fail("write", file_, errno);
  stream_.reset();
  rename_or_fail(partial_, file_);
}

void write_then_rename(const std::filesystem::path& file,
                       const std::function<void(const std::filesystem::path&)>& write) {
  const std::filesystem::path partial = partial_name(file);
  try {
    write(partial);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw;
  }
  rename_or_fail(partial, file);
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
