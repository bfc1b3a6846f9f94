// SPDX-License-Identifier: Apache-2.0
#include "study/queue/point_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <system_error>
#include <utility>

#include "phalanx/core/error_text.h"
#include "study/laboratory/checked_inputs.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/measure_point.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostLog = 16384;  // of each point; the end is kept

bool write_whole(int descriptor, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t count = ::send(descriptor, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += static_cast<std::size_t>(count);
  }
  return true;
}

/// Waits for the next request. @returns false at the end of the connection
bool read_request(int descriptor, int& index) {
  for (;;) {
    const ssize_t count = ::recv(descriptor, &index, sizeof index, MSG_WAITALL);
    if (count < 0 && errno == EINTR) continue;
    return count == static_cast<ssize_t>(sizeof index);
  }
}

/// The form of an answer: "INDEX SECONDS r RESULT", or "INDEX SECONDS f REASON", and a line's end; c instead of f if a
/// file of the inputs was changed.
std::string answer_of(const Study& study, int index, const TrialFunction& trial) {
  const auto begin = std::chrono::steady_clock::now();
  char kind = 'r';
  std::string text;
  try {
    text = result_line(measure_point(study, index, trial));
    text.pop_back();
  } catch (const InputsChanged& error) {
    kind = 'c';
    text = error.what();
  } catch (const std::exception& error) {
    kind = 'f';
    text = error_text(error);
  } catch (...) {
    kind = 'f';
    text = "an exception of unknown type";
  }
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return fmt::format("{} {:.9g} {} {}\n", index, seconds, kind, text);
}

PointAnswer parsed(const std::string& line) {
  PointAnswer answer;
  char* rest = nullptr;
  answer.index = static_cast<int>(std::strtol(line.c_str(), &rest, 10));
  answer.seconds = std::strtod(rest, &rest);
  answer.failed = rest[1] != 'r';
  answer.inputs_changed = rest[1] == 'c';
  answer.text = rest + 3;
  return answer;
}

/// Reads what is there, up to a bound: one that writes without end must not hold the reader. @returns false at the end
bool read_available(int descriptor, std::string& text) {
  std::array<char, 65536> block;
  for (int reads = 0; reads < kReadsPerCall; ++reads) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return is_transient(errno);
    if (count == 0) return false;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
  return true;
}

/// @param limit  the shell's name of the limit that may be the cause
[[noreturn]] void throw_system_error(const char* limit) {
  throw std::system_error(
      errno, std::generic_category(),
      fmt::format("a process for the points of the study cannot be started (fewer --jobs, or {})", limit));
}

}  // namespace

PointProcess::PointProcess(const Study& study, const TrialFunction& trial) : answers_(-1), log_(-1) {
  std::array<int, 2> sockets{};
  std::array<int, 2> pipe{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    throw_system_error("ulimit -n");
  Descriptor here(sockets[0]);
  const Descriptor there(sockets[1]);
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw_system_error("ulimit -n");
  Descriptor log_here(pipe[0]);
  const Descriptor log_there(pipe[1]);
  for (const int descriptor : {here.value(), log_here.value()}) ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ < 0) throw_system_error("ulimit -u");
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before the call
    serve(study, trial, there.value(), log_there.value());
  }
  answers_ = std::move(here);
  log_ = std::move(log_here);
}

PointProcess::~PointProcess() {
  if (process_ > 0) ::kill(process_, SIGKILL);
  reap();
}

/// The forked process. It keeps nothing of the parent open: neither the connection to the server nor a lock.
/// An exception must not leave it: what the parent would clean up is not this process's.
void PointProcess::serve(const Study& study, const TrialFunction& trial, int requests, int log) noexcept {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(signal, SIG_DFL);
  // A signal to the whole group, by Ctrl-C or a scheduler: the parent decides.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_IGN);
  constexpr rlimit kNoCore{.rlim_cur = 0, .rlim_max = 0};
  ::setrlimit(RLIMIT_CORE, &kNoCore);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  const auto least = static_cast<unsigned>(STDERR_FILENO) + 1;
  const auto kept = static_cast<unsigned>(requests);
  if (kept > least) ::close_range(least, kept - 1, 0);
  ::close_range(kept + 1, ~0U, 0);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  tbb::task_arena arena(1);
  for (int index = 0; read_request(requests, index);) {
    const std::string answer = arena.execute([&] { return answer_of(study, index, trial); });
    if (!write_whole(requests, answer)) break;
  }
  ::_exit(0);  // runs no destructors and flushes no buffers of the parent
}

void PointProcess::give(int index) {
  pending_.push_back(index);
  std::string request(sizeof index, '\0');
  std::memcpy(request.data(), &index, sizeof index);
  static_cast<void>(write_whole(answers_.value(), request));
}

void PointProcess::read_log() {
  static_cast<void>(read_available(log_.value(), log_text_));
  if (log_text_.size() > kMostLog) log_text_.erase(0, log_text_.size() - kMostLog);
}

std::vector<PointAnswer> PointProcess::read() {
  std::vector<PointAnswer> answers;
  if (!ended_) ended_ = !read_available(answers_.value(), received_);
  std::size_t at = 0;
  for (std::size_t end; (end = received_.find('\n', at)) != std::string::npos; at = end + 1) {
    answers.push_back(parsed(received_.substr(at, end - at)));
    pending_.pop_front();
    front_s_ = 0.0;
  }
  received_.erase(0, at);
  if (!answers.empty()) log_text_.clear();  // of a point that is done
  read_log();                               // after that: it may hold why the process ended
  return answers;
}

void PointProcess::pass(double passed_s, double limit_s) {
  if (pending_.empty() || ended_ || too_long_) return;
  front_s_ += passed_s;
  if (!(front_s_ > limit_s)) return;
  too_long_ = pending_.front();
  limit_s_ = limit_s;
  ::kill(process_, SIGKILL);
}

std::string PointProcess::how_it_ended() {
  reap();
  read_log();
  std::string text = WIFSIGNALED(status_) ? fmt::format("ended by signal {} ({})", WTERMSIG(status_),
                                                        ::strsignal(WTERMSIG(status_)))
                                          : fmt::format("ended with code {}", WEXITSTATUS(status_));
  if (too_long_)
    text = fmt::format(
        "was ended: the point took {:.6g} s, longer than its limit of {:.6g} s (phalanx study work "
        "--limit)",
        front_s_, limit_s_);
  if (!log_text_.empty()) text += ", after it wrote:\n" + log_text_;
  return text;
}

void PointProcess::reap() noexcept {
  if (process_ <= 0) return;
  while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
}

}  // namespace phalanx
