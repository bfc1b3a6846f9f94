// SPDX-License-Identifier: Apache-2.0
#include "mesh/isolation/pipe_io.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace phalanx::mesh {
namespace {

/// Returns the milliseconds until the deadline, for poll(); 0 if it has passed.
int left_until(Deadline deadline) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now())
          .count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000));
}

/// Writes as much as possible. Writing to a pipe may block: its reader ends the writer at its own deadline.
ssize_t write_some(int fd, const char* data, std::size_t bytes) {
  const ssize_t done = ::send(fd, data, bytes, MSG_NOSIGNAL | MSG_DONTWAIT);
  return done < 0 && errno == ENOTSOCK ? ::write(fd, data, bytes) : done;
}

}  // namespace

void Descriptor::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Deadline deadline_after(double seconds) {
  return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                                std::chrono::duration<double>(seconds));
}

bool write_all(int fd, const void* data, std::size_t bytes, Deadline deadline) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    pollfd ready{.fd = fd, .events = POLLOUT, .revents = 0};
    const int events = ::poll(&ready, 1, left_until(deadline));
    if (events < 0 && errno == EINTR) continue;
    if (events <= 0) return false;
    const ssize_t done = write_some(fd, at, bytes);
    if (done < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (done <= 0) return false;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

bool read_all(int fd, void* data, std::size_t bytes, Deadline deadline) {
  auto* at = static_cast<char*>(data);
  while (bytes > 0) {
    pollfd ready{.fd = fd, .events = POLLIN, .revents = 0};
    const int events = ::poll(&ready, 1, left_until(deadline));
    if (events < 0 && errno == EINTR) continue;
    if (events <= 0) return false;
    const ssize_t done = ::read(fd, at, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

bool write_result(int fd, const std::string& text, Deadline deadline) {
  return write_sequence(fd, text, deadline);
}

bool write_result(int fd, const TriangleMesh& mesh, Deadline deadline) {
  return write_sequence(fd, mesh.vertices, deadline) && write_sequence(fd, mesh.triangles, deadline);
}

bool read_result(int fd, std::string& text, std::uint64_t most_bytes, Deadline deadline) {
  return read_sequence(fd, text, most_bytes, deadline);
}

bool read_result(int fd, TriangleMesh& mesh, std::uint64_t most_bytes, Deadline deadline) {
  return read_sequence(fd, mesh.vertices, most_bytes, deadline) &&
         read_sequence(fd, mesh.triangles, most_bytes, deadline);
}

}  // namespace phalanx::mesh
