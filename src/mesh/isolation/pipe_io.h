// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::mesh {

/// Owner of a file descriptor, which its destructor closes.
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

/// Writes to a pipe or a socket.
/// @returns false if the other end is closed (without a signal on a socket), or the deadline has passed
bool write_all(int fd, const void* data, std::size_t bytes, Deadline deadline);
/// @returns false if the other end is closed, or the deadline has passed
bool read_all(int fd, void* data, std::size_t bytes, Deadline deadline);

/// Writes the number of values, then the values. @tparam Sequence  std::vector or std::string
template <typename Sequence>
bool write_sequence(int fd, const Sequence& values, Deadline deadline) {
  const std::uint64_t count = values.size();
  return write_all(fd, &count, sizeof count, deadline) &&
         write_all(fd, values.data(), values.size() * sizeof(typename Sequence::value_type), deadline);
}

/// Reads a sequence. A defective child may claim any count, but not more than `most_bytes`.
template <typename Sequence>
bool read_sequence(int fd, Sequence& values, std::uint64_t most_bytes, Deadline deadline) {
  constexpr std::size_t kEach = sizeof(typename Sequence::value_type);
  std::uint64_t count = 0;
  if (!read_all(fd, &count, sizeof count, deadline) || count > most_bytes / kEach) return false;
  values.reserve(static_cast<std::size_t>(count));  // address space only; memory follows as it is filled
  constexpr std::uint64_t kChunk = 1 << 16;
  for (std::uint64_t have = 0; have < count;) {
    const std::uint64_t more = std::min(kChunk, count - have);
    values.resize(static_cast<std::size_t>(have + more));
    if (!read_all(fd, values.data() + have, static_cast<std::size_t>(more) * kEach, deadline)) return false;
    have += more;
  }
  return true;
}

/// First byte of another process's answer; a result or the message of a refusal follows.
inline constexpr std::uint8_t kResult = 1;
inline constexpr std::uint8_t kRefusal = 2;
inline constexpr std::uint8_t kOutOfMemory = 3;

/// Write or read the result of work in another process.
/// @returns false if the other end is closed, the deadline has passed, or a received count is out of range
bool write_result(int fd, const std::string& text, Deadline deadline);
bool write_result(int fd, const TriangleMesh& mesh, Deadline deadline);
bool read_result(int fd, std::string& text, std::uint64_t most_bytes, Deadline deadline);
bool read_result(int fd, TriangleMesh& mesh, std::uint64_t most_bytes, Deadline deadline);

}  // namespace phalanx::mesh
