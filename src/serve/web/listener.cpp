// SPDX-License-Identifier: Apache-2.0
#include "serve/web/listener.h"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <utility>

#include "serve/web/http_session.h"

namespace phalanx::web {
namespace {

constexpr int kPortsTried = 21;

// No more than this waits in the system for a slow page, so that the newest message is new when it gets
// there.
constexpr int kUnsent = 16 * 1024;  // [bytes]

void set_up(tcp::socket& socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(net::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>(kUnsent), ignored);
}

error_code bind_to(tcp::acceptor& acceptor, const tcp::endpoint& endpoint) {
  error_code error;
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && endpoint.address().is_v6() && endpoint.address().is_unspecified()) {
    acceptor.set_option(net::ip::v6_only(false), error);
  }
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) {
    error_code ignored;
    acceptor.close(ignored);
  }
  return error;
}

WebServerError no_port(const WebServerSettings& settings, const error_code& error) {
  if (error == net::error::address_in_use) {
    return WebServerError(fmt::format(
        "port {} of {} is taken by another program; choose another port, or 0 for any that is free",
        settings.port, settings.address));
  }
  if (error == net::error::access_denied) {
    return WebServerError(
        fmt::format("port {} is not for ordinary users; choose one above 1023", settings.port));
  }
  return WebServerError(fmt::format("{} port {}: {}; is it an address of this machine?", settings.address,
                                    settings.port, error.message()));
}

}  // namespace

tcp::acceptor listen(net::io_context& thread, const WebServerSettings& settings) {
  const net::ip::address address =
      net::ip::make_address(settings.address == "localhost" ? "127.0.0.1" : settings.address);
  tcp::acceptor acceptor(thread);
  const int tries = settings.next_free_port && settings.port != 0 ? kPortsTried : 1;
  error_code error;
  for (int port = settings.port; port < settings.port + tries && port <= 65535; ++port) {
    error = bind_to(acceptor, {address, static_cast<std::uint16_t>(port)});
    if (error != net::error::address_in_use) break;
  }
  if (error) throw no_port(settings, error);
  return acceptor;
}

Listener::Listener(House& house, tcp::acceptor&& acceptor)
    : house_(house), acceptor_(std::move(acceptor)), breath_(acceptor_.get_executor()) {}

void Listener::start() {
  acceptor_.async_accept(
      [this](error_code error, tcp::socket socket) { on_connection(error, std::move(socket)); });
}

void Listener::on_connection(error_code error, tcp::socket socket) {
  if (error == net::error::operation_aborted || !acceptor_.is_open()) return;
  if (error) {
    // Out of descriptors, perhaps: asking again at once would only heat the room.
    breath_.expires_after(std::chrono::milliseconds(100));
    breath_.async_wait([this](error_code stopped) {
      if (!stopped) start();
    });
    return;
  }
  // The next one first, so that nothing that happens to this one can be the end of them.
  start();
  set_up(socket);
  std::make_shared<HttpSession>(house_, std::move(socket))->start();
}

void Listener::stop() noexcept {
  error_code ignored;
  acceptor_.close(ignored);
  breath_.cancel();
}

}  // namespace phalanx::web
