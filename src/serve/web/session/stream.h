// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "serve/web/boost.h"

namespace phalanx::web {

/// TCP stream with or without TLS as one type, so that the sessions are no templates. Meets
/// Beast's AsyncStream requirements.
class Stream {
 public:
  /// Like beast::tcp_stream, with a limit on the rate of reading.
  using Plain = beast::basic_stream<tcp, net::any_io_executor, beast::simple_rate_policy>;
  using Secure = beast::ssl_stream<Plain>;
  using next_layer_type = Plain;
  using executor_type = Plain::executor_type;

  /// @param tls  null: no TLS; outlives the stream
  Stream(tcp::socket&& socket, net::ssl::context* tls) : stream_(make(std::move(socket), tls)) {}

  [[nodiscard]] bool secure() const noexcept { return std::holds_alternative<Secure>(stream_); }
  [[nodiscard]] executor_type get_executor() noexcept { return transport().get_executor(); }
  /// @returns the TCP stream below TLS, on which timeouts are set and which is shut down
  [[nodiscard]] Plain& transport() noexcept {
    if (Secure* with = std::get_if<Secure>(&stream_)) return with->next_layer();
    return *std::get_if<Plain>(&stream_);
  }
  /// Required by beast::get_lowest_layer.
  [[nodiscard]] Plain& next_layer() noexcept { return transport(); }

  /// @pre secure()
  template <class Handler>
  void async_handshake(Handler&& handler) {
    std::get<Secure>(stream_).async_handshake(net::ssl::stream_base::server, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (Secure* with = std::get_if<Secure>(&stream_)) {
      with->async_read_some(buffers, std::forward<Handler>(handler));
    } else {
      transport().async_read_some(buffers, std::forward<Handler>(handler));
    }
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (Secure* with = std::get_if<Secure>(&stream_)) {
      with->async_write_some(buffers, std::forward<Handler>(handler));
    } else {
      transport().async_write_some(buffers, std::forward<Handler>(handler));
    }
  }
  /// Ends the stream of a WebSocket. Beast finds this function by argument-dependent lookup.
  template <class Handler>
  friend void async_teardown(beast::role_type role, Stream& stream, Handler&& handler) {
    using beast::websocket::async_teardown;
    if (Secure* with = std::get_if<Secure>(&stream.stream_)) {
      async_teardown(role, *with, std::forward<Handler>(handler));
    } else {
      async_teardown(role, stream.transport(), std::forward<Handler>(handler));
    }
  }

 private:
  using Either = std::variant<Plain, Secure>;
  static Either make(tcp::socket&& socket, net::ssl::context* tls) {
    if (tls == nullptr) return Either(std::in_place_type<Plain>, std::move(socket));
    return Either(std::in_place_type<Secure>, std::move(socket), *tls);
  }

  Either stream_;
};

}  // namespace phalanx::web
