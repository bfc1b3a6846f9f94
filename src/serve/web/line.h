// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "serve/web/boost.h"

namespace phalanx::web {

/// What a browser is connected by, with TLS or without, as one type: what is written over it need not be a
/// template. Meets Beast's AsyncStream.
class Line {
 public:
  /// As beast::tcp_stream, but that how fast it is read can be bounded.
  using Plain = beast::basic_stream<tcp, net::any_io_executor, beast::simple_rate_policy>;
  using Secure = beast::ssl_stream<Plain>;
  using next_layer_type = Plain;
  using executor_type = Plain::executor_type;

  /// @param tls  null: without; outlives the line
  Line(tcp::socket&& socket, net::ssl::context* tls) : stream_(make(std::move(socket), tls)) {}

  [[nodiscard]] bool secure() const noexcept { return std::holds_alternative<Secure>(stream_); }
  [[nodiscard]] executor_type get_executor() noexcept { return transport().get_executor(); }
  /// Where time limits are set, and the end that is shut.
  [[nodiscard]] Plain& transport() noexcept {
    if (Secure* with = std::get_if<Secure>(&stream_)) return with->next_layer();
    return *std::get_if<Plain>(&stream_);
  }
  /// For beast::get_lowest_layer.
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
  /// How a WebSocket ends; found by its name.
  template <class Handler>
  friend void async_teardown(beast::role_type role, Line& line, Handler&& handler) {
    using beast::websocket::async_teardown;
    if (Secure* with = std::get_if<Secure>(&line.stream_)) {
      async_teardown(role, *with, std::forward<Handler>(handler));
    } else {
      async_teardown(role, line.transport(), std::forward<Handler>(handler));
    }
  }

 private:
  using Stream = std::variant<Plain, Secure>;
  static Stream make(tcp::socket&& socket, net::ssl::context* tls) {
    if (tls == nullptr) return Stream(std::in_place_type<Plain>, std::move(socket));
    return Stream(std::in_place_type<Secure>, std::move(socket), *tls);
  }

  Stream stream_;
};

}  // namespace phalanx::web
