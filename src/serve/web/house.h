// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"
#include "serve/web/doors.h"
#include "serve/web/doorstep.h"
#include "serve/web/gate.h"
#include "serve/web/pages.h"
#include "serve/web/site.h"

namespace phalanx::web {

class HttpSession;

/// What all connections share. On the server's thread only, but for the gate.
struct House {
  /// @param port  that it listens on
  /// @throws WebServerError
  House(WebServerSettings given, WebApplication& its_application, net::io_context& thread,
        std::uint16_t port);
  House(const House&) = delete;
  House& operator=(const House&) = delete;
  ~House();

  /// Lets go of all that needs the thread's context; counts that connections refer to stay.
  void vacate() noexcept;

  const WebServerSettings settings;
  WebApplication& application;
  const Site site;
  std::optional<net::ssl::context> tls;  ///< none: plain HTTP
  const HostDoor host_door;
  const TokenDoor token_door;
  const std::shared_ptr<Gate> gate;
  std::optional<Pages> pages;  ///< none: vacated
  Doorstep doorstep;
  std::size_t connections = 0;   ///< that have asked for something rightly
  std::size_t large_bodies = 0;  ///< being read
  /// Requests whose answer the application owes.
  std::map<const HttpSession*, std::shared_ptr<HttpSession>> waiting;
};

}  // namespace phalanx::web
