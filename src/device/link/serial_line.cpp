// SPDX-License-Identifier: Apache-2.0
#include "device/link/serial_line.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "device/link/wait_for.h"

namespace phalanx {
namespace {

/// Reads that one receive() makes before it answers "none for now", so that a flood cannot keep it.
constexpr int kReadsPerCall = 16;

bool passing(int error) noexcept { return error == EAGAIN || error == EWOULDBLOCK || error == EINTR; }

}  // namespace

SerialLine::SerialLine() {
  phx_receiver_init(&receiver_);
  // A zero byte first: whatever the other side has half received before us ends there.
  out_[0] = 0;
  out_size_ = 1;
}

std::size_t SerialLine::take_buffered(std::span<std::uint8_t> out) noexcept {
  while (in_begin_ < in_end_) {
    const std::size_t size = phx_receiver_take(&receiver_, in_[in_begin_++]);
    if (size == 0) continue;
    if (size <= out.size()) {
      std::copy_n(&receiver_.frame[0], size, out.data());
      return size;
    }
    ++too_large_;
  }
  return 0;
}

bool SerialLine::read_more() noexcept {
  const ssize_t count = ::read(descriptor_, in_.data(), in_.size());
  if (count > 0) {
    in_begin_ = 0;
    in_end_ = static_cast<std::size_t>(count);
    return true;
  }
  // A terminal that was hung up (unplugged) reads as its end or as an error.
  if (count == 0 || !passing(errno)) lost_ = true;
  return false;
}

std::size_t SerialLine::receive(std::span<std::uint8_t> out, Peer& from) noexcept {
  from = 0;
  flush();
  for (int reads = 0;; ++reads) {
    if (const std::size_t size = take_buffered(out); size > 0) return size;
    if (lost_ || reads == kReadsPerCall || !read_more()) return 0;
  }
}

void SerialLine::flush() noexcept {
  if (lost_ || out_size_ == 0) return;
  const ssize_t count = ::write(descriptor_, out_.data(), out_size_);
  if (count < 0) {
    if (!passing(errno)) lost_ = true;
    return;
  }
  const auto written = static_cast<std::size_t>(count);
  std::copy(out_.begin() + count, out_.begin() + static_cast<ssize_t>(out_size_), out_.begin());
  out_size_ -= written;
}

bool SerialLine::send(std::span<const std::uint8_t> frame, Peer) noexcept {
  flush();
  if (lost_) return false;
  const std::size_t added =
      phx_cobs_encode(frame.data(), frame.size(), out_.data() + out_size_, out_.size() - out_size_);
  if (added == 0) return false;
  out_size_ += added;
  flush();
  return !lost_;
}

bool SerialLine::wait(double seconds) noexcept {
  if (in_begin_ < in_end_) return true;
  if (lost_) {
    wait_for(-1, 0, seconds);
    return false;
  }
  const short events = out_size_ > 0 ? POLLIN | POLLOUT : POLLIN;
  const short came = wait_for(descriptor_, events, seconds);
  if ((came & POLLOUT) != 0) flush();
  return (came & ~POLLOUT) != 0;
}

}  // namespace phalanx
