// SPDX-License-Identifier: Apache-2.0
// File descriptors: one that closes itself, and reading one that does not wait.
#pragma once

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace phalanx {

/// File descriptor that closes itself unless it is released; below 0: none.
class Descriptor {
 public:
  explicit Descriptor(int value) noexcept : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(other.give_away()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int value() const noexcept { return value_; }
  [[nodiscard]] int give_away() noexcept { return std::exchange(value_, -1); }

 private:
  int value_;
};

/// @returns true if a call that failed with this errno may succeed later: it would have waited, or
/// a signal came
[[nodiscard]] inline bool is_transient(int error) noexcept {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

/// Largest number of reads of a call that looks for a whole frame or line: a continuous stream
/// cannot hold it.
inline constexpr int kReadsPerCall = 16;

/// Buffer of bytes that were read from a non-blocking descriptor and not taken. Real-time: no allocation,
/// lock or throw.
template <std::size_t kSize>
class ReadBuffer {
 public:
  [[nodiscard]] bool empty() const noexcept { return begin_ == end_; }
  /// @pre !empty()
  [[nodiscard]] std::uint8_t take() noexcept { return bytes_[begin_++]; }
  /// Reads once. @pre empty()
  /// @param lost  set if the port is gone: one that was unplugged reads as its end or as an error
  /// @returns true if bytes came
  bool fill(int descriptor, bool& lost) noexcept {
    const ssize_t count = ::read(descriptor, bytes_.data(), bytes_.size());
    if (count > 0) {
      begin_ = 0;
      end_ = static_cast<std::size_t>(count);
      return true;
    }
    if (count == 0 || !is_transient(errno)) lost = true;
    return false;
  }

 private:
  std::array<std::uint8_t, kSize> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace phalanx
