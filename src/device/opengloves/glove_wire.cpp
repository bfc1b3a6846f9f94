// SPDX-License-Identifier: Apache-2.0
#include "device/opengloves/glove_wire.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace phalanx {

GloveWire::GloveWire(int descriptor) noexcept : descriptor_(descriptor) {
  const int flags = ::fcntl(descriptor_, F_GETFL);
  if (flags < 0 || ::fcntl(descriptor_, F_SETFL, flags | O_NONBLOCK) != 0) lost_ = true;
}

GloveWire::~GloveWire() { ::close(descriptor_); }

GloveWire::Piece GloveWire::next() noexcept {
  if (line_ended_) {
    line_size_ = 0;
    too_long_ = false;
    line_ended_ = false;
  }
  int reads = 0;
  while (!in_.empty() || (!lost_ && reads++ < kReadsPerCall && in_.fill(descriptor_, lost_))) {
    const char c = static_cast<char>(in_.take());
    if (c == '\n') {
      line_ended_ = true;
      return too_long_ ? Piece::kTooLong : Piece::kLine;
    }
    if (line_size_ == line_.size()) {
      too_long_ = true;
    } else {
      line_[line_size_++] = c;
    }
  }
  return Piece::kNone;
}

void GloveWire::flush() noexcept {
  if (lost_ || out_begin_ == out_end_) return;
  const ssize_t count = ::write(descriptor_, out_.data() + out_begin_, out_end_ - out_begin_);
  if (count >= 0) {
    out_begin_ += static_cast<std::size_t>(count);
  } else if (!is_transient(errno)) {
    lost_ = true;
  }
}

bool GloveWire::send(std::string_view answer) noexcept {
  flush();
  if (lost_ || out_begin_ < out_end_ || answer.size() > out_.size()) return false;
  std::copy(answer.begin(), answer.end(), out_.begin());
  out_begin_ = 0;
  out_end_ = answer.size();
  flush();
  return !lost_;
}

void GloveWire::wait(double seconds) noexcept {
  // poll() would return at once on a lost port, without end.
  pollfd poll_for{.fd = lost_ ? -1 : descriptor_, .events = POLLIN, .revents = 0};
  if (out_begin_ < out_end_) poll_for.events |= POLLOUT;
  const int milliseconds = static_cast<int>(1e3 * std::clamp(seconds, 0.0, 60.0)) + 1;
  if (::poll(&poll_for, 1, milliseconds) > 0 && (poll_for.revents & POLLOUT) != 0) flush();
}

}  // namespace phalanx
