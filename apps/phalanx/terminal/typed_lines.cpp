// SPDX-License-Identifier: Apache-2.0
#include "terminal/typed_lines.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <exception>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "terminal/end_signals.h"

namespace phalanx {
namespace {

constexpr int kAskAgain = 200;               ///< interval while the terminal belongs to another job [ms]
constexpr std::size_t kLongestLine = 65536;  ///< [bytes]

int make_event() {
  const int event = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (event < 0) throw std::system_error(errno, std::generic_category(), "what is typed cannot be read");
  return event;
}

/// Opens standard input once more, without blocking: another reader may take a line between poll() and
/// read(), and a reader that waits inside read() could be neither woken nor joined. The flag of standard
/// input itself is shared with the shell and stays as it is.
/// @returns standard input itself if its reads do not block (files), or if it cannot be opened again
int open_input() noexcept {
  struct stat status = {};
  std::array<char, 64> name;
  const bool pipe = ::fstat(STDIN_FILENO, &status) == 0 && S_ISFIFO(status.st_mode);
  const bool terminal =
      ::isatty(STDIN_FILENO) == 1 && ::ptsname_r(STDIN_FILENO, name.data(), name.size()) != 0;
  if (!pipe && !terminal) return STDIN_FILENO;
  const int own = ::open("/proc/self/fd/0", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  return own < 0 ? STDIN_FILENO : own;
}

/// @returns the number of bytes read; 0 at the end; -1 with errno, EAGAIN if nothing waits
ssize_t read_waiting(int input, char* text, std::size_t size) noexcept {
  const ssize_t count = ::recv(input, text, size, MSG_DONTWAIT);
  return count < 0 && errno == ENOTSOCK ? ::read(input, text, size) : count;
}

bool terminal_belongs_to_another_job() noexcept {
  const pid_t owner = ::tcgetpgrp(STDIN_FILENO);
  return owner >= 0 && owner != ::getpgrp();
}

/// @returns true for `stop` in any letter case: it is typed in a hurry.
bool is_stop(std::string_view line) noexcept {
  constexpr std::string_view kStop = "stop";
  return std::equal(line.begin(), line.end(), kStop.begin(), kStop.end(),
                    [](char typed, char wanted) { return (typed | 0x20) == wanted; });
}

}  // namespace

TypedLines::TypedLines(Session& session)
    : session_(session),
      wake_(make_event()),
      input_(open_input()),
      thread_(start_nice_thread("phalanx-typed", [this] { read_all(); })) {}

TypedLines::~TypedLines() {
  ::eventfd_write(wake_, 1);
  thread_.join();
  ::close(wake_);
  if (input_ != STDIN_FILENO) ::close(input_);
}

std::optional<TypedLines::Line> TypedLines::next() {
  const std::lock_guard lock(mutex_);
  if (lines_.empty()) return std::nullopt;
  Line line = std::move(lines_.front());
  lines_.pop_front();
  return line;
}

std::size_t TypedLines::take_left_out() {
  const std::lock_guard lock(mutex_);
  return std::exchange(left_out_, 0);
}

void TypedLines::read_all() noexcept {
  std::array<pollfd, 3> events{{{.fd = input_, .events = POLLIN, .revents = 0},
                                {.fd = wake_, .events = POLLIN, .revents = 0},
                                {.fd = end_descriptor, .events = POLLIN, .revents = 0}}};
  auto& [input, wake, end] = events;
  for (;;) {
    input.fd = ended_ || in_background_ ? -1 : input_;
    const int count = ::poll(events.data(), events.size(), in_background_ ? kAskAgain : -1);
    if (count < 0) continue;
    if (wake.revents != 0) return;
    if (end.revents != 0) {
      session_.stop();
      end.fd = -1;
    }
    if (count == 0) in_background_ = terminal_belongs_to_another_job();
    if (count == 0 || input.revents == 0) continue;
    try {
      read_some();
    } catch (const std::exception&) {  // no memory for the typed text: it may have been `stop`
      session_.stop();
      pending_.clear();
      const std::lock_guard lock(mutex_);
      ++left_out_;
    }
  }
}

void TypedLines::read_some() {
  std::array<char, 4096> text;
  const ssize_t count = read_waiting(input_, text.data(), text.size());
  if (count > 0) {
    pending_.append(text.data(), static_cast<std::size_t>(count));
    return take_lines();
  }
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  in_background_ = count < 0 && errno == EIO && terminal_belongs_to_another_job();
  ended_ = !in_background_;
  if (!ended_ || pending_.empty()) return;
  pending_ += '\n';  // the last line may lack its line end
  take_lines();
}

void TypedLines::take_lines() {
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = pending_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    Line line{.text = pending_.substr(begin, end - begin), .stops = 0};
    line.text.erase(line.text.find_last_not_of(" \t\r") + 1);
    line.text.erase(0, line.text.find_first_not_of(" \t"));
    if (std::exchange(too_long_, false)) continue;  // the rest of a line that was too long
    // Under the lock: next() does not miss the line of a stop() that has happened.
    const std::lock_guard lock(mutex_);
    if (is_stop(line.text)) {
      line.text = "stop";
      session_.stop();
      line.stops = session_.stops();
    }
    if (lines_.size() < kWaiting)
      lines_.push_back(std::move(line));
    else
      ++left_out_;
  }
  pending_.erase(0, begin);
  if (pending_.size() <= kLongestLine) return;
  pending_.clear();
  too_long_ = true;
}

}  // namespace phalanx
