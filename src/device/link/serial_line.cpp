// SPDX-License-Identifier: Apache-2.0
#include "device/link/serial_line.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "device/link/wait_for.h"

namespace phalanx {

SerialLine::SerialLine() {
  phx_receiver_init(&receiver_);
  // A zero byte first: it ends a frame that the other side has half received from an earlier program.
  out_[0] = 0;
  out_size_ = 1;
}

std::size_t SerialLine::take_buffered(std::span<std::uint8_t> out) noexcept {
  while (!in_.empty()) {
    const std::size_t size = phx_receiver_take(&receiver_, in_.take());
    if (size == 0) continue;
    if (size <= out.size()) {
      std::copy_n(&receiver_.frame[0], size, out.data());
      return size;
    }
    ++too_large_;
  }
  return 0;
}

std::size_t SerialLine::receive(std::span<std::uint8_t> out, Peer& from) noexcept {
  from = 0;
  flush();
  for (int reads = 0;; ++reads) {
    if (const std::size_t size = take_buffered(out); size > 0) return size;
    if (lost_ || reads == kReadsPerCall || !in_.fill(descriptor_, lost_)) return 0;
  }
}

void SerialLine::flush() noexcept {
  if (lost_ || out_size_ == 0) return;
  const ssize_t count = ::write(descriptor_, out_.data(), out_size_);
  if (count < 0) {
    if (!is_transient(errno)) lost_ = true;
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

bool SerialLine::send_bytes(std::span<const std::uint8_t> bytes) noexcept {
  flush();
  if (lost_ || bytes.size() > out_.size() - out_size_) return false;
  std::copy(bytes.begin(), bytes.end(), out_.begin() + static_cast<std::ptrdiff_t>(out_size_));
  out_size_ += bytes.size();
  flush();
  return !lost_;
}

bool SerialLine::wait(double seconds) noexcept {
  if (!in_.empty()) return true;
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
