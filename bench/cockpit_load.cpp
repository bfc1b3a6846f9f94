// SPDX-License-Identifier: Apache-2.0
#include "cockpit_load.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "phalanx/serve/cockpit.h"

namespace phalanx::bench {
namespace {

constexpr int kPatience = 10'000;  // [ms]
constexpr unsigned kPing = 0x89;
constexpr unsigned kPong = 0x8A;
constexpr unsigned kBinary = 0x82;

/// A socket, closed when it goes.
class Socket {
 public:
  explicit Socket(int descriptor) noexcept : descriptor_(descriptor) {}
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Socket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] int value() const noexcept { return descriptor_; }
  int give_away() noexcept { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
};

Socket connected(std::uint16_t port) {
  Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool good =
      socket.value() >= 0 &&
      ::connect(socket.value(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  return good ? std::move(socket) : Socket(-1);
}

bool await(int descriptor, short what) {
  pollfd one{descriptor, what, 0};
  return ::poll(&one, 1, kPatience) == 1;
}

bool say(int descriptor, std::string_view text) {
  while (!text.empty()) {
    if (!await(descriptor, POLLOUT)) return false;
    const ssize_t sent = ::send(descriptor, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EAGAIN) continue;
    if (sent <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

constexpr std::string_view kHead =
    "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\nConnection: Upgrade\r\n"
    "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

/// A frame's head as a client says it, with a mask of zeros: what follows is sent as it is.
std::string masked_head(unsigned first, std::uint64_t length) {
  std::string head(1, static_cast<char>(first));
  if (length < 126) {
    head += static_cast<char>(0x80U | length);
  } else {
    head += static_cast<char>(0x80U | 127U);
    for (int shift = 56; shift >= 0; shift -= 8) head += static_cast<char>((length >> shift) & 0xFFU);
  }
  return head.append(4, '\0');
}

/// ToHost{hello {protocol: kProtocol}} of proto/phalanx/cockpit.proto: before it, a page gets nothing.
static_assert(Cockpit::kProtocol < 0x80U, "a number of one byte");
constexpr std::array<char, 4> kHelloBytes = {'\x12', '\x02', '\x08', static_cast<char>(Cockpit::kProtocol)};
constexpr std::string_view kHello(kHelloBytes.data(), kHelloBytes.size());

/// ToHost{seen {ticks: N}}: without it, ticks stop soon. Other messages are counted, too, which makes no
/// difference: a page cannot have seen more than was sent.
std::string seen_frame(std::uint64_t ticks) {
  std::string number;
  for (; ticks >= 0x80U; ticks >>= 7U) number += static_cast<char>((ticks & 0x7FU) | 0x80U);
  number += static_cast<char>(ticks);
  std::string seen(1, '\x08');
  seen += number;
  std::string message(1, '\x72');
  message += static_cast<char>(seen.size());
  message += seen;
  return masked_head(kBinary, message.size()) + message;
}

/// @param rest  what came behind the welcome
Socket welcomed(std::uint16_t port, std::string& rest) {
  Socket socket = connected(port);
  if (socket.value() < 0 || !say(socket.value(), kHead))
    throw std::runtime_error("no connection to the cockpit");
  std::string answer;
  std::array<char, 4096> piece{};
  while (answer.find("\r\n\r\n") == std::string::npos) {
    const ssize_t got =
        await(socket.value(), POLLIN) ? ::recv(socket.value(), piece.data(), piece.size(), 0) : 0;
    if (got <= 0) throw std::runtime_error("the cockpit does not welcome a viewer");
    answer.append(piece.data(), static_cast<std::size_t>(got));
  }
  if (!answer.starts_with("HTTP/1.1 101"))
    throw std::runtime_error("the cockpit refuses a viewer: " + answer);
  rest = answer.substr(answer.find("\r\n\r\n") + 4);
  if (!say(socket.value(), masked_head(kBinary, kHello.size()).append(kHello)))
    throw std::runtime_error("the cockpit does not hear a viewer");
  return socket;
}

/// Counts frames in a stream of bytes without keeping their payload.
class FrameCounter {
 public:
  /// @returns payload of a ping that wants an answer, if one ended in these bytes
  bool take(std::string_view bytes, std::string& ping) {
    bool pinged = false;
    while (!bytes.empty()) {
      if (left_ == 0 && !take_head(bytes)) break;
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
      if (kind_ == kPing) ping_.append(bytes.substr(0, n));
      bytes.remove_prefix(n);
      left_ -= n;
      if (left_ > 0) break;
      pinged = end_frame(ping) || pinged;
    }
    return pinged;
  }
  [[nodiscard]] std::uint64_t messages() const noexcept { return messages_; }

 private:
  static std::size_t head_length(unsigned second) noexcept {
    const unsigned length = second & 0x7FU;
    return length < 126 ? 2 : length == 126 ? 4 : 10;
  }
  /// @returns false: not all of it is there
  bool take_head(std::string_view& bytes) {
    while (!bytes.empty() && (head_.size() < 2 || head_.size() < head_length(byte(1)))) {
      head_ += bytes.front();
      bytes.remove_prefix(1);
    }
    if (head_.size() < 2 || head_.size() < head_length(byte(1))) return false;
    kind_ = byte(0);
    left_ = head_.size() == 2 ? byte(1) & 0x7FU : 0;
    for (std::size_t i = 2; i < head_.size(); ++i) left_ = left_ * 256 + byte(i);
    head_.clear();
    return true;
  }
  bool end_frame(std::string& ping) {
    if (kind_ == kBinary) ++messages_;
    if (kind_ != kPing) return false;
    ping = std::exchange(ping_, {});
    return true;
  }
  [[nodiscard]] unsigned byte(std::size_t i) const { return static_cast<unsigned char>(head_[i]); }

  std::string head_;
  unsigned kind_ = 0;
  std::uint64_t left_ = 0;
  std::string ping_;
  std::uint64_t messages_ = 0;
};

struct Viewer {
  Socket socket;
  FrameCounter frames;
};

}  // namespace

struct CockpitViewers::Parts {
  /// Takes in what one has got. @returns false: it is gone
  bool read(Viewer& viewer, std::span<char> piece) {
    const ssize_t got = ::recv(viewer.socket.value(), piece.data(), piece.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return true;
    if (got <= 0) return false;
    bytes += static_cast<std::uint64_t>(got);
    return take(viewer, {piece.data(), static_cast<std::size_t>(got)});
  }

  bool take(Viewer& viewer, std::string_view text) {
    const std::uint64_t before = viewer.frames.messages();
    std::string ping;
    const bool pinged = viewer.frames.take(text, ping);
    messages += viewer.frames.messages() - before;
    if (viewer.frames.messages() > before &&
        !say(viewer.socket.value(), seen_frame(viewer.frames.messages())))
      return false;
    if (!pinged) return true;
    return say(viewer.socket.value(), masked_head(kPong, ping.size()) + ping);
  }

  void run() {
    std::vector<char> piece(256 * 1024);
    std::vector<pollfd> waiting(viewers.size() + 1);
    for (std::size_t i = 0; i < viewers.size(); ++i) waiting[i] = {viewers[i].socket.value(), POLLIN, 0};
    pollfd& end = waiting.back();
    end = {wake.value(), POLLIN, 0};
    while (::poll(waiting.data(), waiting.size(), -1) >= 0 || errno == EINTR) {
      if (end.revents != 0) return;
      for (std::size_t i = 0; i < viewers.size(); ++i) {
        if (waiting[i].fd < 0 || waiting[i].revents == 0 || read(viewers[i], piece)) continue;
        waiting[i].fd = -1;
        --connected;
      }
    }
  }

  std::vector<Viewer> viewers;
  Socket wake{::eventfd(0, EFD_CLOEXEC)};
  std::atomic<std::size_t> connected{0};
  std::atomic<std::uint64_t> messages{0};
  std::atomic<std::uint64_t> bytes{0};
  std::thread thread;
};

CockpitViewers::CockpitViewers(std::uint16_t port, std::size_t viewers) : parts_(std::make_unique<Parts>()) {
  for (std::size_t i = 0; i < viewers; ++i) {
    std::string rest;
    parts_->viewers.push_back({welcomed(port, rest), {}});
    parts_->take(parts_->viewers.back(), rest);
  }
  parts_->connected = viewers;
  parts_->thread = std::thread([parts = parts_.get()] { parts->run(); });
}

CockpitViewers::~CockpitViewers() {
  ::eventfd_write(parts_->wake.value(), 1);
  parts_->thread.join();
}

CockpitViewers::Counts CockpitViewers::counts() const noexcept {
  return {parts_->connected, parts_->messages, parts_->bytes};
}

StuckViewer::StuckViewer(std::uint16_t port) : descriptor_(-1) {
  std::string rest;
  descriptor_ = welcomed(port, rest).give_away();
}

StuckViewer::~StuckViewer() { ::close(descriptor_); }

std::uint64_t send_huge_message(std::uint16_t port, std::uint64_t bytes) {
  std::string rest;
  const Socket socket = welcomed(port, rest);
  if (!say(socket.value(), masked_head(kBinary, bytes))) return 0;
  const std::string piece(64 * 1024, '\0');
  std::uint64_t sent = 0;
  while (sent < bytes) {
    const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(bytes - sent, piece.size()));
    if (!say(socket.value(), std::string_view(piece).substr(0, n))) break;
    sent += n;
  }
  return sent;
}

std::size_t connect_often(std::uint16_t port, std::size_t connections) {
  std::vector<Socket> open;
  for (std::size_t i = 0; i < connections; ++i) {
    Socket socket = connected(port);
    if (socket.value() >= 0) open.push_back(std::move(socket));
  }
  return open.size();
}

}  // namespace phalanx::bench
