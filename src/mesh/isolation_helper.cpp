// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolation_helper.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>

#include "mesh/end_with.h"
#include "mesh/pipe_io.h"

namespace phalanx::mesh {
namespace {

constexpr std::uint64_t kMostInput = std::uint64_t{2} << 30;  // [bytes]
constexpr std::uint64_t kMostWords = std::uint64_t{1} << 16;  // of an origin or a refusal [bytes]
constexpr double kPatience = 60.0;                            // for input and answer to get through [s]
constexpr int kNice = 5;  // below the loop where it has no better scheduling
constexpr timespec kBetweenHelpers{.tv_sec = 0, .tv_nsec = 100'000'000};  // one that cannot live costs little

/// The program's end of the line to its helper; -1: it has none.
std::atomic<int> the_helper{-1};

/// Goes over the line as it is: both ends are one program.
struct Job {
  IsolatedWork text = nullptr;
  IsolatedReading mesh = nullptr;  ///< one of the two
  IsolationLimits limits;
};

/// A job as sendmsg() and recvmsg() take it, with room for one descriptor beside it.
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
  Parcel parcel(job);
  cmsghdr* head = CMSG_FIRSTHDR(&parcel.message());
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof fd);
  std::memcpy(CMSG_DATA(head), &fd, sizeof fd);
  return ::sendmsg(line, &parcel.message(), MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof job);
}

/// @returns the descriptor that came with it; -1: the program has ended
int receive_job(int line, Job& job) {
  Parcel parcel(job);
  ssize_t got = 0;
  do {
    got = ::recvmsg(line, &parcel.message(), MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  const cmsghdr* head = CMSG_FIRSTHDR(&parcel.message());
  if (got != static_cast<ssize_t>(sizeof job) || head == nullptr) return -1;
  int fd = -1;
  std::memcpy(&fd, CMSG_DATA(head), sizeof fd);
  return fd;
}

/// In a process of its own, which forks the one that does the work, waits for it and tells how it went.
void do_job(const Job& job, int fd) {
  std::string origin;
  std::string input;
  const Deadline deadline = deadline_after(kPatience);
  if (!read_sequence(fd, origin, kMostWords, deadline) || !read_sequence(fd, input, kMostInput, deadline))
    return;
  try {
    if (job.mesh != nullptr) {
      const TriangleMesh mesh = run_isolated([&] { return job.mesh(input); }, origin, job.limits);
      if (write_all(fd, &kResult, 1)) write_result(fd, mesh);
    } else {
      const std::string text = run_isolated_text([&] { return job.text(input); }, origin, job.limits);
      if (write_all(fd, &kResult, 1)) write_result(fd, text);
    }
  } catch (const std::exception& refused) {
    const std::string words = refused.what();
    if (write_all(fd, &kRefusal, 1)) write_sequence(fd, words.substr(0, kMostWords));
  }
}

/// The helper: forks once for each job.
[[noreturn]] void serve(int line, pid_t supervisor) {
  end_with(supervisor);
  ::prctl(PR_SET_NAME, "phalanx-helper");
  std::signal(SIGCHLD, SIG_IGN);  // the end of a job's process needs no answer
  Job job;
  for (int fd = receive_job(line, job); fd >= 0; fd = receive_job(line, job)) {
    const pid_t helper = ::getpid();
    if (::fork() == 0) {
      end_with(helper);
      std::signal(SIGCHLD, SIG_DFL);
      do_job(job, fd);
      ::_exit(0);
    }
    ::close(fd);
  }
  ::_exit(0);
}

/// To standard error in one piece, so that it stays one line beside what the program writes.
void tell_of_end(int status) {
  const bool killed = WIFSIGNALED(status);
  std::array<char, 160> line{};
  const int length =
      std::snprintf(line.data(), line.size(),
                    "phalanx: the process that reads meshes was ended (%s %d); another one "
                    "takes its place\n",
                    killed ? "signal" : "exit code", killed ? WTERMSIG(status) : WEXITSTATUS(status));
  write_all(STDERR_FILENO, line.data(), static_cast<std::size_t>(length));
}

/// Keeps one helper alive as long as the program lives. Jobs that are sent meanwhile wait in the line.
[[noreturn]] void supervise(int line, pid_t program) {
  end_with(program);
  ::prctl(PR_SET_NAME, "phalanx-superv");
  ::setpriority(PRIO_PROCESS, 0, kNice);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches the whole group; the program decides
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);  // standard error may be closed
  const pid_t supervisor = ::getpid();
  for (;;) {
    const pid_t helper = ::fork();
    if (helper == 0) serve(line, supervisor);
    int status = 0;
    while (helper > 0 && ::waitpid(helper, &status, 0) < 0 && errno == EINTR) {
    }
    if (helper > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) ::_exit(0);  // the program has ended
    if (helper > 0) tell_of_end(status);
    ::nanosleep(&kBetweenHelpers, nullptr);
  }
}

/// @throws std::invalid_argument  refused, as run_isolated_text(), or no process could be asked
template <typename Result>
Result ask_helper(const Job& job, const std::string& input, const std::string& origin) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw std::invalid_argument(origin + ": no socket for the reader (" + std::strerror(errno) +
                                "); close other programs");
  const Descriptor ours(ends[0]);
  Descriptor theirs(ends[1]);
  if (!send_job(the_helper.load(), job, theirs.get()))
    throw std::invalid_argument(origin +
                                ": the processes that read meshes were ended from outside; end this program "
                                "and start it again");
  theirs.close();
  // What cannot be written is noticed when the answer is read.
  if (write_sequence(ours.get(), origin)) write_sequence(ours.get(), input);
  const Deadline deadline = deadline_after(job.limits.wall_seconds + kPatience);
  std::uint8_t kind = 0;
  Result answer;
  std::string refusal;
  const bool told = read_all(ours.get(), &kind, 1, deadline);
  if (told && kind == kResult && read_result(ours.get(), answer, job.limits.memory_bytes, deadline))
    return answer;
  if (told && kind == kRefusal && read_sequence(ours.get(), refusal, kMostWords, deadline))
    throw std::invalid_argument(refusal);
  throw std::invalid_argument(origin +
                              ": the process that was to read it was ended from outside, perhaps because "
                              "memory ran out; another one takes its place: try again, with a smaller file "
                              "if it ends once more");
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
  ::kill(process_, SIGKILL);  // what it forked ends with it
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
