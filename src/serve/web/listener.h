// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/web/boost.h"
#include "serve/web/house.h"

namespace phalanx::web {

/// Bound and listening. @throws WebServerError  the address or the port cannot be had
[[nodiscard]] tcp::acceptor listen(net::io_context& thread, const WebServerSettings& settings);

/// Takes in connections: onto the doorstep, until they have asked for something.
class Listener {
 public:
  Listener(House& house, tcp::acceptor&& acceptor);

  void start();
  void stop() noexcept;

 private:
  void on_connection(error_code error, tcp::socket socket);

  House& house_;
  tcp::acceptor acceptor_;
  net::steady_timer breath_;
};

}  // namespace phalanx::web
