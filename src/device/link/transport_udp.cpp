// SPDX-License-Identifier: Apache-2.0
// The link over UDP (IPv4), one frame a datagram. Boost.Asio opens and configures the socket.
#include <fmt/format.h>
#include <poll.h>

#include <utility>  // Boost 1.74's Asio needs it in C++20 and does not say so

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <charconv>
#include <optional>
#include <stdexcept>

#include "device/link/wait_for.h"
#include "phalanx/device/link/transport.h"

namespace phalanx {
namespace {

namespace asio = boost::asio;
using asio::ip::udp;
using boost::system::error_code;

/// Datagrams of one receive() before it returns 0, so that a continuous stream cannot hold it.
constexpr int kPiecesPerCall = 64;

Peer pack(const udp::endpoint& endpoint) noexcept {
  return (Peer{endpoint.address().to_v4().to_uint()} << 16) | endpoint.port();
}

udp::endpoint unpack(Peer peer) noexcept {
  return {asio::ip::address_v4(static_cast<asio::ip::address_v4::uint_type>(peer >> 16)),
          static_cast<std::uint16_t>(peer & 0xffffu)};
}

/// UDP socket. It is never lost: every error of the network is temporary. A controller that is not up (yet,
/// or again) answers with "connection refused".
class UdpTransport final : public Transport {
 public:
  UdpTransport() : socket_(io_) {}

  [[nodiscard]] udp::socket& socket() noexcept { return socket_; }
  [[nodiscard]] asio::io_context& io() noexcept { return io_; }
  void connected_to(std::string address) {
    connected_ = true;
    address_ = std::move(address);
  }
  void listening_on(std::string address) { address_ = std::move(address); }

  [[nodiscard]] std::size_t receive(std::span<std::uint8_t> out, Peer& from) noexcept override {
    std::uint8_t beyond = 0;  // filled only by a datagram larger than `out`
    for (int piece = 0; piece < kPiecesPerCall; ++piece) {
      const std::array<asio::mutable_buffer, 2> room = {asio::buffer(out.data(), out.size()),
                                                        asio::buffer(&beyond, 1)};
      udp::endpoint sender;
      error_code error;
      const std::size_t size = socket_.receive_from(room, sender, 0, error);
      if (error == asio::error::would_block || error == asio::error::try_again) return 0;
      if (error) continue;  // of an earlier send, reported once
      if (size > 0 && size <= out.size()) {
        from = connected_ ? Peer{0} : pack(sender);
        return size;
      }
      ++dropped_;
    }
    return 0;
  }

  bool send(std::span<const std::uint8_t> frame, Peer to) noexcept override {
    const auto bytes = asio::buffer(frame.data(), frame.size());
    // The system may report the refusal of an earlier datagram instead of sending this one: try twice.
    for (int attempt = 0; attempt < 2; ++attempt) {
      error_code error;
      if (connected_) {
        socket_.send(bytes, 0, error);
      } else {
        socket_.send_to(bytes, unpack(to), 0, error);
      }
      if (!error) return true;
      if (error != asio::error::connection_refused) return false;
    }
    return false;
  }

  bool wait(double seconds) noexcept override {
    return wait_for(socket_.native_handle(), POLLIN, seconds) != 0;
  }
  [[nodiscard]] bool lost() const noexcept override { return false; }
  [[nodiscard]] std::uint64_t dropped() const noexcept override { return dropped_; }
  [[nodiscard]] std::string address() const override { return address_; }

 private:
  asio::io_context io_;
  udp::socket socket_;
  bool connected_ = false;
  std::uint64_t dropped_ = 0;
  std::string address_;
};

struct HostAndPort {
  std::string host;
  std::uint16_t port = 0;
};

HostAndPort split(const std::string& text, unsigned lowest_port) {
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    unsigned port = 0;
    const char* begin = text.data() + colon + 1;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(begin, end, port);
    if (begin != end && error == std::errc() && stopped == end && port >= lowest_port && port <= 65535)
      return {text.substr(0, colon), static_cast<std::uint16_t>(port)};
  }
  throw std::invalid_argument(
      fmt::format("udp:{}: expected HOST:PORT with a port of {} to 65535, for example udp:192.168.7.2:47800",
                  text, lowest_port));
}

udp::endpoint resolve(UdpTransport& transport, const std::string& text, const HostAndPort& of) {
  udp::resolver resolver(transport.io());
  error_code error;
  const auto found = resolver.resolve(udp::v4(), of.host, std::to_string(of.port), error);
  if (error || found.empty()) {
    throw DeviceError(
        fmt::format("udp:{}: no host '{}' ({}); give its IPv4 address or a name that this computer knows",
                    text, of.host, error ? error.message() : "no IPv4 address"));
  }
  return found.begin()->endpoint();
}

void open_socket(UdpTransport& transport, const std::string& text) {
  error_code error;
  transport.socket().open(udp::v4(), error);
  if (!error) transport.socket().non_blocking(true, error);
  if (error) throw DeviceError(fmt::format("udp:{}: no socket: {}", text, error.message()));
}

}  // namespace

std::unique_ptr<Transport> connect_udp(const std::string& host_and_port) {
  const HostAndPort asked = split(host_and_port, 1);
  auto transport = std::make_unique<UdpTransport>();
  const udp::endpoint endpoint = resolve(*transport, host_and_port, asked);
  open_socket(*transport, host_and_port);
  error_code error;
  transport->socket().connect(endpoint, error);
  if (error) {
    throw DeviceError(fmt::format("udp:{}: {}; check that this computer is on the device's network",
                                  host_and_port, error.message()));
  }
  transport->connected_to("udp:" + host_and_port);
  return transport;
}

std::unique_ptr<Transport> listen_udp(const std::string& address_and_port) {
  const HostAndPort asked = split(address_and_port, 0);
  auto transport = std::make_unique<UdpTransport>();
  const udp::endpoint endpoint = resolve(*transport, address_and_port, asked);
  open_socket(*transport, address_and_port);
  error_code error;
  transport->socket().bind(endpoint, error);
  if (error) {
    const char* remedy = error == asio::error::address_in_use ? "end the other program or choose another port"
                         : error == asio::error::access_denied
                             ? "choose a port above 1023"
                             : "choose an address of this computer, or 0.0.0.0 for all of them";
    throw DeviceError(
        fmt::format("udp:{}: cannot listen: {}; {}", address_and_port, error.message(), remedy));
  }
  const udp::endpoint bound = transport->socket().local_endpoint();
  transport->listening_on(fmt::format("udp:{}:{}", bound.address().to_string(), bound.port()));
  return transport;
}

}  // namespace phalanx
