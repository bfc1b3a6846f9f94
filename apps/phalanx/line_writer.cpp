// SPDX-License-Identifier: Apache-2.0
#include "line_writer.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <exception>
#include <mutex>
#include <string_view>
#include <utility>

#include "phalanx/core/nice_thread.h"

namespace phalanx {
namespace {

constexpr std::size_t kNarrowest = 20;  ///< columns; what says less is no terminal's width

bool can_clear_a_line() {
  const char* kind = std::getenv("TERM");
  return kind != nullptr && *kind != '\0' && std::string_view(kind) != "dumb";
}

/// Waits as long as it takes. A pipe that poll() calls writable takes PIPE_BUF bytes at once.
/// @returns false: the descriptor takes nothing any more
bool write_text(int descriptor, std::string_view text) noexcept {
  while (!text.empty()) {
    pollfd output{.fd = descriptor, .events = POLLOUT, .revents = 0};
    if (::poll(&output, 1, -1) < 0 && errno != EINTR) return false;
    if (output.revents == 0) continue;
    const ssize_t count = ::write(descriptor, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

/// What both threads hold.
struct LineWriter::Shared {
  explicit Shared(int to) : descriptor(to) {}

  /// With the lock.
  void add(std::string text) {
    waiting.push_back(std::move(text));
    bytes += waiting.back().size();
    changed.notify_all();
  }

  const int descriptor;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<std::string> waiting;
  std::size_t bytes = 0;     ///< of what waits
  std::size_t left_out = 0;  ///< lines behind what waits
  bool writing = false;
  bool ending = false;
  bool ended = false;  ///< nothing is written any more
};

LineWriter::LineWriter(int descriptor)
    : descriptor_(descriptor),
      terminal_(::isatty(descriptor) == 1),
      in_place_(terminal_ && can_clear_a_line()),
      shared_(std::make_shared<Shared>(descriptor)),
      thread_(start_nice_thread("phalanx-lines", [shared = shared_] { write_all(*shared); })) {}

LineWriter::~LineWriter() {
  bool ended = false;
  {
    std::unique_lock lock(shared_->mutex);
    shared_->ending = true;
    shared_->changed.notify_all();
    ended = shared_->changed.wait_for(lock, std::chrono::duration<double>(kDrainTime),
                                      [this] { return shared_->ended; });
  }
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void LineWriter::line(const std::string& text) noexcept {
  const char* begin = in_place_ ? "\r\033[K" : "";
  const std::lock_guard lock(shared_->mutex);
  if (shared_->ended) return;
  if (shared_->waiting.size() >= kWaiting || shared_->bytes + text.size() > kWaitingBytes) {
    ++shared_->left_out;
    return;
  }
  try {
    if (shared_->left_out > 0)
      shared_->add(fmt::format("{}({} lines are missing here: they were not read in time)\n", begin,
                               std::exchange(shared_->left_out, 0)));
    shared_->add(fmt::format("{}{}\n", begin, text));
  } catch (const std::exception&) {  // no memory
    ++shared_->left_out;
  }
}

bool LineWriter::status(const std::string& text) noexcept {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->ended || shared_->writing || !shared_->waiting.empty()) return false;
  try {
    shared_->add(in_place_ ? fmt::format("\r\033[K{}", text) : fmt::format("{}\n", text));
    return true;
  } catch (const std::exception&) {  // no memory
    return false;
  }
}

std::size_t LineWriter::width() const noexcept {
  winsize size{};
  if (!terminal_) return kWidth;
  if (::ioctl(descriptor_, TIOCGWINSZ, &size) != 0 || size.ws_col < kNarrowest) return 79;
  return size.ws_col - 1U;  // some terminals go on to the next line after the last column
}

void LineWriter::write_all(Shared& shared) noexcept {
  std::unique_lock lock(shared.mutex);
  for (bool open = true; open;) {
    shared.changed.wait(lock, [&] { return shared.ending || !shared.waiting.empty(); });
    if (shared.waiting.empty()) break;
    const std::string text = std::move(shared.waiting.front());
    shared.waiting.pop_front();
    shared.bytes -= text.size();
    shared.writing = true;
    lock.unlock();
    open = write_text(shared.descriptor, text);
    lock.lock();
    shared.writing = false;
  }
  shared.ended = true;
  shared.waiting.clear();
  shared.changed.notify_all();
}

}  // namespace phalanx
