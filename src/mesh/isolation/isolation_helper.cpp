// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolation/isolation_helper.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "mesh/isolation/end_with.h"
#include "mesh/isolation/pipe_io.h"

namespace phalanx::mesh {
namespace {

constexpr std::uint64_t kMostInput = std::uint64_t{2} << 30;  // [bytes]
constexpr std::uint64_t kMostWords = std::uint64_t{1} << 16;  // longest origin or message [bytes]
constexpr int kNice = 5;  // lower priority than the loop, if that has no better scheduling
constexpr timespec kBetweenHelpers{.tv_sec = 0, .tv_nsec = 100'000'000};  // limits the rate of new helpers

/// Program's end of the socket to its helper; -1 without a helper.
std::atomic<int> the_helper{-1};

/// Request, sent as raw bytes because both ends are one program.
struct Job {
  IsolatedWork text = nullptr;
  IsolatedReading mesh = nullptr;  ///< exactly one of the two is set
  IsolationLimits limits;
};

/// Job in the form of sendmsg() and recvmsg(), with room for one descriptor.
class Parcel {
 public:
  explicit Parcel(Job& job) : data_{.iov_base = &job, .iov_len = sizeof job} {
    message_.msg_iov = &data_;
    message_.msg_iovlen = 1;
    message_.msg_control = room_.data();
    message_.msg_controllen = room_.size();
  }
  Parcel(const Parcel&) = delete;
  Parcel& operator=(const Parcel&) = delete;
  [[nodiscard]] msghdr& message() { return message_; }

 private:
  iovec data_;
  msghdr message_{};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room_{};
};

bool send_job(int line, Job job, int fd) {
  const auto seconds = static_cast<time_t>(job.limits.transfer_seconds);
  const timeval patience{
      .tv_sec = seconds,
      .tv_usec = std::lround(1e6 * (job.limits.transfer_seconds - static_cast<double>(seconds)))};
  ::setsockopt(line, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  Parcel parcel(job);
  cmsghdr* head = CMSG_FIRSTHDR(&parcel.message());
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof fd);
  std::memcpy(CMSG_DATA(head), &fd, sizeof fd);
  return ::sendmsg(line, &parcel.message(), MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof job);
}

/// Receives a job. Ends this process if no further job can come, with status 0 only if the program has ended.
/// @returns the descriptor that came with the job, or -1 if none could be created for it; the job
/// is then refused
int receive_job(int line, Job& job) {
  Parcel parcel(job);
  ssize_t got = 0;
  do {
    got = ::recvmsg(line, &parcel.message(), MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  if (got <= 0) ::_exit(got == 0 ? 0 : 1);
  const cmsghdr* head = CMSG_FIRSTHDR(&parcel.message());
  if (head == nullptr) return -1;
  int fd = -1;
  std::memcpy(&fd, CMSG_DATA(head), sizeof fd);
  return fd;
}

/// Runs a job in a process of its own. It forks the process that does the work, waits for it, and
/// sends the result.
void do_job(const Job& job, int fd) {
  std::string origin;
  std::string input;
  const auto patience = [&job] { return deadline_after(job.limits.transfer_seconds); };
  const Deadline deadline = patience();
  if (!read_sequence(fd, origin, kMostWords, deadline) || !read_sequence(fd, input, kMostInput, deadline))
    return;
  const auto answer = [&](std::uint8_t kind, const auto& what) {
    const Deadline end = patience();
    if (write_all(fd, &kind, 1, end)) write_result(fd, what, end);
  };
  try {
    if (job.mesh != nullptr)
      answer(kResult, run_isolated([&] { return job.mesh(input); }, origin, job.limits));
    else
      answer(kResult, run_isolated_text([&] { return job.text(input); }, origin, job.limits));
  } catch (const std::exception& refused) {
    answer(kRefusal, std::string(refused.what()).substr(0, kMostWords));
  }
}

/// Runs the helper, which forks once for each job.
[[noreturn]] void serve(int line, pid_t supervisor) {
  end_with(supervisor);
  ::prctl(PR_SET_NAME, "phalanx-helper");
  std::signal(SIGCHLD, SIG_IGN);  // jobs' processes are not waited for
  Job job;
  for (;;) {
    const int fd = receive_job(line, job);
    if (fd < 0) continue;
    const pid_t helper = ::getpid();
    if (::fork() == 0) {
      end_with(helper);
      std::signal(SIGCHLD, SIG_DFL);
      do_job(job, fd);
      ::_exit(0);
    }
    ::close(fd);
  }
}

/// Writes the message about a helper's end to standard error in one piece, so that it stays one line. A
/// process of its own does this, because standard error may block for long (Ctrl-S, a pipe that is not read).
/// @returns that process; 0 if it could not be created
pid_t tell_of_end(int status, pid_t supervisor) {
  if (const pid_t teller = ::fork(); teller != 0) return std::max(teller, 0);
  end_with(supervisor);
  const bool killed = WIFSIGNALED(status);
  std::array<char, 160> line{};
  const int length =
      std::snprintf(line.data(), line.size(),
                    "phalanx: the process that reads meshes was ended (%s %d); another one "
                    "takes its place\n",
                    killed ? "signal" : "exit code", killed ? WTERMSIG(status) : WEXITSTATUS(status));
  const ssize_t written = ::write(STDERR_FILENO, line.data(), static_cast<std::size_t>(length));
  ::_exit(written == length ? 0 : 1);
}

/// Keeps one helper alive as long as the program lives. Jobs sent meanwhile wait in the socket. If the
/// message about one end cannot be written, only the newest of the later ends waits.
[[noreturn]] void supervise(int line, pid_t program) {
  end_with(program);
  ::prctl(PR_SET_NAME, "phalanx-superv");
  ::setpriority(PRIO_PROCESS, 0, kNice);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches the whole group; the program decides
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);  // standard error may be closed
  const pid_t supervisor = ::getpid();
  std::optional<int> untold;  ///< unreported status of the last helper
  pid_t teller = 0;           ///< 0: none
  for (;; ::nanosleep(&kBetweenHelpers, nullptr)) {
    const pid_t helper = ::fork();
    if (helper == 0) serve(line, supervisor);
    if (helper < 0) continue;
    int status = 0;
    for (pid_t ended = 0; ended != helper && (ended >= 0 || errno == EINTR);) {
      if (untold && teller == 0) teller = tell_of_end(*std::exchange(untold, std::nullopt), supervisor);
      ended = ::waitpid(-1, &status, 0);
      if (ended == teller) teller = 0;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) ::_exit(0);  // the program has ended
    untold = status;
  }
}

/// Sends a job to the helper and returns its result.
/// @throws std::invalid_argument if the job is refused, as run_isolated_text(), or the helper
/// cannot be reached
template <typename Result>
Result ask_helper(const Job& job, const std::string& input, const std::string& origin) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::invalid_argument(origin + ": no socket for the reader (" + std::strerror(errno) +
                                "); close other programs");
  const Descriptor ours(ends[0]);
  Descriptor theirs(ends[1]);
  if (!send_job(the_helper.load(), job, theirs.get()))
    throw std::invalid_argument(
        origin + (errno == EAGAIN
                      ? ": the process that reads meshes takes no work; try again when it has gone on"
                      : ": the processes that read meshes were ended from outside; end this program and "
                        "start it again"));
  theirs.close();
  const Deadline input_deadline = deadline_after(job.limits.transfer_seconds);
  const bool asked =
      write_sequence(ours.get(), origin, input_deadline) && write_sequence(ours.get(), input, input_deadline);
  const Deadline deadline = deadline_after(job.limits.wall_seconds + job.limits.transfer_seconds);
  std::uint8_t kind = 0;
  Result answer;
  std::string refusal;
  const bool told = asked && read_all(ours.get(), &kind, 1, deadline);
  if (told && kind == kResult && read_result(ours.get(), answer, job.limits.memory_bytes, deadline))
    return answer;
  if (told && kind == kRefusal && read_sequence(ours.get(), refusal, kMostWords, deadline))
    throw std::invalid_argument(refusal);
  throw std::invalid_argument(
      origin +
      ": the process that was to read it was ended from outside, perhaps because "
      "memory ran out, or did not go on; try again, with a smaller file if that comes "
      "once more");
}

}  // namespace

IsolationHelper::IsolationHelper() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "no socket for the helper process");
  const pid_t program = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[0]);
    supervise(ends[1], program);
  }
  ::close(ends[1]);
  control_ = ends[0];
  if (process_ < 0) {
    ::close(control_);
    throw std::system_error(errno, std::generic_category(), "no helper process");
  }
  the_helper = control_;
}

IsolationHelper::~IsolationHelper() {
  the_helper = -1;
  ::kill(process_, SIGKILL);  // the processes that it forked end with it
  ::close(control_);
  while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string run_isolated_work(IsolatedWork work, const std::string& input, const std::string& origin,
                              const IsolationLimits& limits) {
  if (!has_isolation_helper()) return run_isolated_text([&] { return work(input); }, origin, limits);
  return ask_helper<std::string>({.text = work, .mesh = nullptr, .limits = limits}, input, origin);
}

TriangleMesh run_isolated_mesh(IsolatedReading work, const std::string& input, const std::string& origin,
                               const IsolationLimits& limits) {
  if (!has_isolation_helper()) return run_isolated([&] { return work(input); }, origin, limits);
  return ask_helper<TriangleMesh>({.text = nullptr, .mesh = work, .limits = limits}, input, origin);
}

bool has_isolation_helper() noexcept { return the_helper.load() >= 0; }

}  // namespace phalanx::mesh
