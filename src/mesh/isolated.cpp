// SPDX-License-Identifier: Apache-2.0
#include "mesh/isolated.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

namespace phalanx::mesh {
namespace {

constexpr std::uint8_t kMesh = 1;
constexpr std::uint8_t kRefusal = 2;
constexpr std::uint8_t kOutOfMemory = 3;

/// Closes a file descriptor when it goes.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const void* data, std::size_t bytes) {
  const auto* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::write(fd, at, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

bool read_all(int fd, void* data, std::size_t bytes) {
  auto* at = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::read(fd, at, bytes);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    at += done;
    bytes -= static_cast<std::size_t>(done);
  }
  return true;
}

template <typename T>
bool write_vector(int fd, const std::vector<T>& values) {
  const std::uint64_t count = values.size();
  return write_all(fd, &count, sizeof count) && write_all(fd, values.data(), values.size() * sizeof(T));
}

/// Grows with what arrives: a child gone wild may claim any count.
template <typename T>
bool read_vector(int fd, std::vector<T>& values) {
  std::uint64_t count = 0;
  if (!read_all(fd, &count, sizeof count)) return false;
  constexpr std::uint64_t kChunk = 1 << 16;
  for (std::uint64_t have = 0; have < count;) {
    const std::uint64_t more = std::min(kChunk, count - have);
    values.resize(static_cast<std::size_t>(have + more));
    if (!read_all(fd, values.data() + have, static_cast<std::size_t>(more) * sizeof(T))) return false;
    have += more;
  }
  return true;
}

void limit(int resource, rlim_t most) {
  rlimit now{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &now) != 0) return;
  now.rlim_cur = std::min(most, now.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

/// Address space of this process now [bytes].
rlim_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void run_child(const std::function<TriangleMesh()>& read, int fd, const std::string& origin,
                            const IsolationLimits& limits) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_seconds);
  limit(RLIMIT_AS, address_space() + limits.memory_bytes);
  // What a dying reader prints would only puzzle: the parent says it in one sentence.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  bool sent = false;
  try {
    const TriangleMesh mesh = read();
    sent = write_all(fd, &kMesh, 1) && write_vector(fd, mesh.vertices) && write_vector(fd, mesh.triangles);
  } catch (const std::bad_alloc&) {
    sent = write_all(fd, &kOutOfMemory, 1);
  } catch (const std::exception& e) {
    // What the reader did not mean for the user's eyes lacks the file's name.
    std::string what = e.what();
    if (dynamic_cast<const std::invalid_argument*>(&e) == nullptr)
      what = origin + ": the file is damaged (" + what + "); repair the mesh or export it again";
    sent = write_all(fd, &kRefusal, 1) && write_vector(fd, std::vector<char>(what.begin(), what.end()));
  } catch (...) {
  }
  ::_exit(sent ? 0 : 1);  // no destructors, no buffers: those belong to the parent
}

struct Received {
  std::uint8_t kind = 0;
  TriangleMesh mesh;
  std::vector<char> refusal;
};

Received receive(int fd) {
  Received r;
  std::uint8_t kind = 0;
  if (!read_all(fd, &kind, 1)) return r;
  bool whole = kind == kOutOfMemory;
  if (kind == kMesh) whole = read_vector(fd, r.mesh.vertices) && read_vector(fd, r.mesh.triangles);
  if (kind == kRefusal) whole = read_vector(fd, r.refusal);
  if (whole) r.kind = kind;
  return r;
}

}  // namespace

TriangleMesh run_isolated(const std::function<TriangleMesh()>& read, const std::string& origin,
                          const IsolationLimits& limits) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), origin + ": no pipe for the reader");
  Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  const pid_t child = ::fork();
  if (child < 0)
    throw std::system_error(errno, std::generic_category(), origin + ": no process for the reader");
  if (child == 0) run_child(read, to_parent.get(), origin, limits);
  to_parent.close();
  Received received;
  std::exception_ptr failure;
  try {
    received = receive(from_child.get());
  } catch (...) {
    failure = std::current_exception();
  }
  from_child.close();
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (failure) std::rethrow_exception(failure);
  if (received.kind == kMesh) return std::move(received.mesh);
  if (received.kind == kRefusal)
    throw std::invalid_argument(std::string(received.refusal.begin(), received.refusal.end()));
  std::string what = "crashed on it";
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
    what = "was not done after " + std::to_string(limits.cpu_seconds) + " s";
  if (received.kind == kOutOfMemory)
    what = "wanted more than " + std::to_string(limits.memory_bytes >> 20) + " MiB of memory for it";
  throw std::invalid_argument(origin + ": the file is damaged or far too large: its reader " + what +
                              "; repair the mesh or export it again");
}

}  // namespace phalanx::mesh
