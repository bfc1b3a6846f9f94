// SPDX-License-Identifier: Apache-2.0
#include "faults/udp_middle.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

#include "phalanx/device/link/phalanx_link.h"

namespace phalanx::testing {
namespace {

sockaddr_in local_address(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// The socket API takes all kinds of addresses behind one type.
sockaddr* generic(sockaddr_in& address) { return reinterpret_cast<sockaddr*>(&address); }
const sockaddr* generic(const sockaddr_in& address) { return reinterpret_cast<const sockaddr*>(&address); }

int new_socket() {
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in any = local_address(0);
  if (descriptor < 0 || ::bind(descriptor, generic(any), sizeof any) != 0)
    throw std::runtime_error("no UDP socket on 127.0.0.1");
  return descriptor;
}

void send_to(int descriptor, const sockaddr_in& address, std::span<const std::uint8_t> bytes) {
  const ssize_t sent = ::sendto(descriptor, bytes.data(), bytes.size(), 0, generic(address), sizeof address);
  static_cast<void>(sent);  // whoever is gone gets nothing
}

}  // namespace

UdpMiddle::UdpMiddle(std::uint16_t controller_port)
    : host_side_(new_socket()), controller_side_(new_socket()), controller_(local_address(controller_port)) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(host_side_, generic(own), &size);
  port_ = ntohs(own.sin_port);
  thread_ = std::thread([this] { work(); });
}

UdpMiddle::~UdpMiddle() {
  ending_ = true;
  thread_.join();
  ::close(host_side_);
  ::close(controller_side_);
}

std::int32_t UdpMiddle::thread_id() const {
  thread_id_.wait(0);
  return thread_id_;
}

void UdpMiddle::work() {
  thread_id_ = ::gettid();
  thread_id_.notify_all();
  while (!ending_) {
    std::array<pollfd, 2> sockets{pollfd{.fd = host_side_, .events = POLLIN, .revents = 0},
                                  pollfd{.fd = controller_side_, .events = POLLIN, .revents = 0}};
    if (::poll(sockets.data(), sockets.size(), 20) <= 0) continue;
    if (sockets[0].revents != 0) pass_on(host_side_, true);
    if (sockets[1].revents != 0) pass_on(controller_side_, false);
  }
}

void UdpMiddle::pass_on(int from, bool from_host) {
  std::array<std::uint8_t, 2048> buffer{};
  sockaddr_in peer{};
  socklen_t size = sizeof peer;
  const ssize_t count = ::recvfrom(from, buffer.data(), buffer.size(), MSG_DONTWAIT, generic(peer), &size);
  if (count <= 0) return;
  const std::span<const std::uint8_t> bytes(buffer.data(), static_cast<std::size_t>(count));
  const std::uint8_t type = bytes.size() > 3 ? bytes[3] : std::uint8_t{0};
  {
    const std::lock_guard lock(mutex_);
    if (from_host) host_ = peer;
    if (from_host && type == PHX_COMMAND) command_.assign(bytes.begin(), bytes.end());
    if (!from_host && type == PHX_SAMPLE) sample_.assign(bytes.begin(), bytes.end());
  }
  if (from_host) {
    to_controller(bytes);
  } else {
    to_host(bytes);
  }
}

void UdpMiddle::to_controller(std::span<const std::uint8_t> bytes) const {
  send_to(controller_side_, controller_, bytes);
}

void UdpMiddle::to_host(std::span<const std::uint8_t> bytes) const {
  sockaddr_in host{};
  {
    const std::lock_guard lock(mutex_);
    host = host_;
  }
  if (host.sin_port != 0) send_to(host_side_, host, bytes);
}

Bytes UdpMiddle::last_command() const {
  const std::lock_guard lock(mutex_);
  return command_;
}

Bytes UdpMiddle::last_sample() const {
  const std::lock_guard lock(mutex_);
  return sample_;
}

void send_from_a_stranger(std::uint16_t port, const std::vector<Bytes>& datagrams) {
  const int descriptor = new_socket();
  for (const Bytes& bytes : datagrams) send_to(descriptor, local_address(port), bytes);
  ::close(descriptor);
}

}  // namespace phalanx::testing
