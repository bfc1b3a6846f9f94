// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolation/isolated.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "mesh/isolation/end_with.h"
#include "mesh/isolation/pipe_io.h"

namespace phalanx::mesh {
namespace {

using Clock = std::chrono::steady_clock;

void limit(int resource, rlim_t most) {
  rlimit now{};
  if (::getrlimit(static_cast<__rlimit_resource_t>(resource), &now) != 0) return;
  now.rlim_cur = std::min(most, now.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

/// Returns the present address space of this process [bytes].
rlim_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

/// Prepares large memory pages. Assimp clears a buffer of 16 MB for each file. If the kernel provides pages
/// of 2 MB at the heap's end, this causes 8 page faults instead of 4096.
void prepare_memory() {
  constexpr std::size_t kBytes = std::size_t{24} << 20;
  constexpr std::uintptr_t kLargePage = std::uintptr_t{2} << 20;
  ::mallopt(M_MMAP_THRESHOLD, 2 * kBytes);
  ::mallopt(M_TRIM_THRESHOLD, 4 * kBytes);
  void* const memory = std::malloc(kBytes);
  if (memory == nullptr) return;
  const std::uintptr_t begin =
      (reinterpret_cast<std::uintptr_t>(memory) + kLargePage - 1) / kLargePage * kLargePage;
  const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(memory) + kBytes) / kLargePage * kLargePage;
  ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  std::free(memory);
}

template <typename Result>
[[noreturn]] void run_child(const std::function<Result()>& work, int fd, const std::string& origin,
                            const IsolationLimits& limits) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGTERM})
    std::signal(signal, SIG_DFL);
  // Ctrl-C reaches the whole group: the parent decides, and this process ends with it.
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_seconds);
  limit(RLIMIT_AS, address_space() + limits.memory_bytes);
  // The child must not keep open what the parent closes: a port, a lock, a connection, a file.
  ::close_range(STDERR_FILENO + 1, static_cast<unsigned>(fd) - 1, 0);
  ::close_range(static_cast<unsigned>(fd) + 1, ~0U, 0);
  // A dying reader's output would only confuse. The parent reports the failure in one sentence.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(nowhere, STDERR_FILENO);
  }
  prepare_memory();
  const Deadline deadline = deadline_after(limits.wall_seconds);  // then the parent gives up
  bool sent = false;
  try {
    const Result result = work();
    sent = write_all(fd, &kResult, 1, deadline) && write_result(fd, result, deadline);
  } catch (const std::bad_alloc&) {
    sent = write_all(fd, &kOutOfMemory, 1, deadline);
  } catch (const std::exception& e) {
    // An exception not meant for the user lacks the file's name.
    std::string what = e.what();
    if (dynamic_cast<const std::invalid_argument*>(&e) == nullptr)
      what = origin + ": the file is damaged (" + what + "); repair the mesh or export it again";
    sent = write_all(fd, &kRefusal, 1, deadline) && write_sequence(fd, what, deadline);
  } catch (...) {
  }
  ::_exit(sent ? 0 : 1);  // runs no destructors and flushes no buffers of the parent
}

template <typename Result>
struct Received {
  std::uint8_t kind = 0;
  Result result;
  std::string refusal;
};

template <typename Result>
Received<Result> receive(int fd, std::uint64_t most, Deadline deadline) {
  Received<Result> r;
  std::uint8_t kind = 0;
  if (!read_all(fd, &kind, 1, deadline)) return r;
  bool whole = kind == kOutOfMemory;
  if (kind == kResult) whole = read_result(fd, r.result, most, deadline);
  if (kind == kRefusal) whole = read_sequence(fd, r.refusal, 1 << 16, deadline);
  if (whole) r.kind = kind;
  return r;
}

/// Waits for the child's end, and ends it at the deadline.
/// @returns the child's status
int reap(pid_t child, Deadline deadline) {
  int status = 0;
  for (;;) {
    const pid_t done = ::waitpid(child, &status, WNOHANG);
    if (done == child || (done < 0 && errno != EINTR)) return status;
    if (Clock::now() >= deadline) break;
    constexpr timespec kShort{.tv_sec = 0, .tv_nsec = 200'000};
    ::nanosleep(&kShort, nullptr);
  }
  ::kill(child, SIGKILL);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

template <typename Result>
Result run(const std::function<Result()>& work, const std::string& origin, const IsolationLimits& limits) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), origin + ": no pipe for the reader");
  Descriptor from_child(ends[0]);
  Descriptor to_parent(ends[1]);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0)
    throw std::system_error(errno, std::generic_category(), origin + ": no process for the reader");
  if (child == 0) {
    end_with(parent);
    from_child.close();
    run_child(work, to_parent.get(), origin, limits);
  }
  to_parent.close();
  const Deadline deadline = deadline_after(limits.wall_seconds);
  Received<Result> received;
  std::exception_ptr failure;
  try {
    received = receive<Result>(from_child.get(), limits.memory_bytes, deadline);
  } catch (...) {
    failure = std::current_exception();
  }
  from_child.close();
  // A child that has sent its whole answer is not waited for.
  const int status = reap(child, failure || received.kind != 0 ? Clock::now() : deadline);
  if (failure) std::rethrow_exception(failure);
  if (received.kind == kResult) return std::move(received.result);
  if (received.kind == kRefusal) throw std::invalid_argument(received.refusal);
  std::string what = "crashed on it";
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    const bool slept = Clock::now() >= deadline;
    what = "was not done after " +
           std::to_string(slept ? static_cast<std::uint64_t>(limits.wall_seconds) : limits.cpu_seconds) +
           " s";
  }
  if (received.kind == kOutOfMemory)
    what = "wanted more than " + std::to_string(limits.memory_bytes >> 20) + " MiB of memory for it";
  throw std::invalid_argument(origin + ": the file is damaged or far too large: its reader " + what +
                              "; repair the mesh or export it again");
}

}  // namespace

TriangleMesh run_isolated(const std::function<TriangleMesh()>& read, const std::string& origin,
                          const IsolationLimits& limits) {
  return run(read, origin, limits);
}

std::string run_isolated_text(const std::function<std::string()>& work, const std::string& origin,
                              const IsolationLimits& limits) {
  return run(work, origin, limits);
}

}  // namespace phalanx::mesh
