// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Closes a file descriptor when it goes.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void close();
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

using Deadline = std::chrono::steady_clock::time_point;
[[nodiscard]] Deadline deadline_after(double seconds);

/// Into a pipe or a socket; blocks. @returns false: the other end is gone (no signal comes of it on a socket)
bool write_all(int fd, const void* data, std::size_t bytes);
/// @returns false: the other end is gone, or it is too late
bool read_all(int fd, void* data, std::size_t bytes, Deadline deadline);

/// How many, then what they are. @tparam Sequence  std::vector or std::string
template <typename Sequence>
bool write_sequence(int fd, const Sequence& values) {
  const std::uint64_t count = values.size();
  return write_all(fd, &count, sizeof count) &&
         write_all(fd, values.data(), values.size() * sizeof(typename Sequence::value_type));
}

/// A child gone wild may claim any count, but not more than the memory that it has.
template <typename Sequence>
bool read_sequence(int fd, Sequence& values, std::uint64_t most_bytes, Deadline deadline) {
  constexpr std::size_t kEach = sizeof(typename Sequence::value_type);
  std::uint64_t count = 0;
  if (!read_all(fd, &count, sizeof count, deadline) || count > most_bytes / kEach) return false;
  values.reserve(static_cast<std::size_t>(count));  // of address space; memory follows as it is filled
  constexpr std::uint64_t kChunk = 1 << 16;
  for (std::uint64_t have = 0; have < count;) {
    const std::uint64_t more = std::min(kChunk, count - have);
    values.resize(static_cast<std::size_t>(have + more));
    if (!read_all(fd, values.data() + have, static_cast<std::size_t>(more) * kEach, deadline)) return false;
    have += more;
  }
  return true;
}

/// The first byte of what another process says of its work; a result or the words of a refusal follow.
inline constexpr std::uint8_t kResult = 1;
inline constexpr std::uint8_t kRefusal = 2;
inline constexpr std::uint8_t kOutOfMemory = 3;

/// What work in another process came to.
bool write_result(int fd, const std::string& text);
bool write_result(int fd, const TriangleMesh& mesh);
bool read_result(int fd, std::string& text, std::uint64_t most_bytes, Deadline deadline);
bool read_result(int fd, TriangleMesh& mesh, std::uint64_t most_bytes, Deadline deadline);

}  // namespace phalanx::mesh
