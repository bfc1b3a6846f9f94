// SPDX-License-Identifier: Apache-2.0
#include "run/marker_port.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

constexpr int kLookMs = 100;  ///< between two looks whether the port ends

}  // namespace

MarkerPort::MarkerPort(const std::string& address, std::uint16_t port,
                       std::function<void(const std::string&, const std::string&)> on_marker)
    : on_marker_(std::move(on_marker)) {
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &own.sin_addr) != 1)
    throw std::invalid_argument(fmt::format(
        "--marker-listen {}: is no IPv4 address; name one of this machine, such as 127.0.0.1", address));
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) {
    const std::string why = std::strerror(errno);
    if (socket_ >= 0) ::close(socket_);
    throw std::runtime_error(
        fmt::format("--marker-port {}: cannot be opened on {} ({}); name another port", port, address, why));
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

MarkerPort::~MarkerPort() {
  thread_ = {};
  ::close(socket_);
}

void MarkerPort::serve(const std::stop_token& stop) {
  std::array<char, kLongest> text;
  while (!stop.stop_requested()) {
    pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
    if (::poll(&wait, 1, kLookMs) <= 0) continue;
    sockaddr_in from{};
    socklen_t length = sizeof from;
    const ssize_t count =
        ::recvfrom(socket_, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
    if (count <= 0) continue;
    std::array<char, INET_ADDRSTRLEN> name{};
    ::inet_ntop(AF_INET, &from.sin_addr, name.data(), name.size());
    try {
      on_marker_(fmt::format("{}:{}", name.data(), ntohs(from.sin_port)),
                 std::string(text.data(), static_cast<std::size_t>(count)));
    } catch (const std::exception&) {  // no memory for it
    }
  }
}

}  // namespace phalanx
