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
struct LineWriter::Desk {
  explicit Desk(int to) : descriptor(to) {}

  /// With the lock.
  void add(std::string text) {
    bytes += text.size();
    waiting.push_back(std::move(text));
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
      desk_(std::make_shared<Desk>(descriptor)),
      thread_(start_nice_thread("phalanx-lines", [desk = desk_] { write_all(*desk); })) {}

LineWriter::~LineWriter() {
  bool ended = false;
  {
    std::unique_lock lock(desk_->mutex);
    desk_->ending = true;
    desk_->changed.notify_all();
    ended = desk_->changed.wait_for(lock, std::chrono::duration<double>(kGoodbye),
                                    [this] { return desk_->ended; });
  }
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void LineWriter::line(const std::string& text) noexcept {
  const char* begin = in_place_ ? "\r\033[K" : "";
  const std::lock_guard lock(desk_->mutex);
  if (desk_->ended) return;
  if (desk_->waiting.size() >= kWaiting || desk_->bytes + text.size() > kWaitingBytes) {
    ++desk_->left_out;
    return;
  }
  try {
    if (desk_->left_out > 0)
      desk_->add(fmt::format("{}({} lines are missing here: they were not read in time)\n", begin,
                             std::exchange(desk_->left_out, 0)));
    desk_->add(fmt::format("{}{}\n", begin, text));
  } catch (const std::exception&) {  // no memory
    ++desk_->left_out;
  }
}

bool LineWriter::status(const std::string& text) noexcept {
  const std::lock_guard lock(desk_->mutex);
  if (desk_->ended || desk_->writing || !desk_->waiting.empty()) return false;
  try {
    desk_->add(in_place_ ? fmt::format("\r\033[K{}", text) : fmt::format("{}\n", text));
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

void LineWriter::write_all(Desk& desk) noexcept {
  std::unique_lock lock(desk.mutex);
  for (bool open = true; open;) {
    desk.changed.wait(lock, [&] { return desk.ending || !desk.waiting.empty(); });
    if (desk.waiting.empty()) break;
    const std::string text = std::move(desk.waiting.front());
    desk.waiting.pop_front();
    desk.bytes -= text.size();
    desk.writing = true;
    lock.unlock();
    open = write_text(desk.descriptor, text);
    lock.lock();
    desk.writing = false;
  }
  desk.ended = true;
  desk.waiting.clear();
  desk.changed.notify_all();
}

}  // namespace phalanx
