// SPDX-License-Identifier: Apache-2.0
#include "terminal/line_writer.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <deque>
#include <exception>
#include <mutex>
#include <string_view>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "terminal/emphasis.h"

namespace phalanx {
namespace {

constexpr std::size_t kNarrowest = 20;  ///< columns; a smaller reported width is ignored

/// Writes a text, however long it takes. A pipe that poll() reports as writable takes PIPE_BUF bytes at once.
/// @returns false if the descriptor takes nothing any more
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

/// State that both threads share.
struct LineWriter::Shared : ThreadEnd {
  struct Line {
    std::size_t left_out = 0;  ///< lines before it
    std::string text;
  };

  Shared(int to, const char* before) : descriptor(to), begin(before) {}

  /// Appends a text. Call it with the lock. @throws std::bad_alloc, and then nothing has changed
  void add(std::string text) {
    waiting.push_back({.left_out = left_out, .text = std::move(text)});
    left_out = 0;
    bytes += waiting.back().text.size();
    changed.notify_all();
  }
  /// Counts a line that is left out. Call it with the lock.
  void leave_out() noexcept {
    ++left_out;
    changed.notify_all();
  }
  /// Writes how many lines were left out, without memory. @returns false: the descriptor takes
  /// nothing any more
  [[nodiscard]] bool say_left_out(std::size_t count) const noexcept {
    std::array<char, 100> text;
    const auto made =
        fmt::format_to_n(text.data(), text.size(),
                         "{}({} lines are missing here: they were not read in time)\n", begin, count);
    return write_text(descriptor, {text.data(), made.size});
  }

  const int descriptor;
  const char* const begin;  ///< start of each line
  std::deque<Line> waiting;
  std::size_t bytes = 0;     ///< bytes of the waiting lines
  std::size_t left_out = 0;  ///< lines left out after the waiting ones
  bool writing = false;
};

LineWriter::LineWriter(int descriptor)
    : descriptor_(descriptor),
      terminal_(::isatty(descriptor) == 1),
      in_place_(takes_sequences(descriptor)),
      shared_(std::make_shared<Shared>(descriptor, in_place_ ? "\r\033[K" : "")),
      thread_(start_nice_thread("phalanx-lines", [shared = shared_] { write_all(*shared); })) {}

LineWriter::~LineWriter() { end_or_leave(*shared_, thread_, kDrainTime); }

void LineWriter::line(const std::string& text) noexcept {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->ended) return;
  if (shared_->waiting.size() >= kWaiting || shared_->bytes + text.size() > kWaitingBytes) {
    shared_->leave_out();
    return;
  }
  try {
    shared_->add(fmt::format("{}{}\n", shared_->begin, text));
  } catch (const std::exception&) {  // no memory
    shared_->leave_out();
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
  return size.ws_col - 1U;  // some terminals continue on the next line after the last column
}

void LineWriter::write_all(Shared& shared) noexcept {
  std::unique_lock lock(shared.mutex);
  for (bool open = true; open;) {
    shared.changed.wait(lock,
                        [&] { return shared.ending || shared.left_out > 0 || !shared.waiting.empty(); });
    Shared::Line line;
    if (!shared.waiting.empty()) {
      line = std::move(shared.waiting.front());
      shared.waiting.pop_front();
    } else if (shared.left_out > 0) {
      line.left_out = std::exchange(shared.left_out, 0);
    } else {
      break;
    }
    shared.bytes -= line.text.size();
    shared.writing = true;
    lock.unlock();
    open = (line.left_out == 0 || shared.say_left_out(line.left_out)) &&
           write_text(shared.descriptor, line.text);
    lock.lock();
    shared.writing = false;
  }
  shared.ended = true;
  shared.waiting.clear();
  shared.changed.notify_all();
}

}  // namespace phalanx
