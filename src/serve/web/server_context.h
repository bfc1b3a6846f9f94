// SPDX-License-Identifier: Apache-2.0
// What all connections of a web server share. Begin here to read this folder.
//
// Thread: one thread runs one io_context. All objects of this folder live on it; only ServerExecutor is
// for other threads.
//
// Objects: WebServer (web_server.cpp) owns the thread, the Listener and the ServerContext. The Listener
// makes an HttpSession for each connection. An HttpSession that becomes a WebSocket hands its stream to a
// PageSession. Pages lists the PageSessions and calls the application once a frame. The handlers of a
// session's asynchronous operations keep it alive. Both sessions are in session/.
//
// Way of a request: HttpSession reads the head, and http_request.cpp checks it in the order that
// web_server.h states. Then it is answered with a file of the Site, becomes a PageSession, or goes with its
// body to WebApplication::requested(). The application may respond from any thread: the ServerExecutor
// brings the response back to the server's thread. limits.h has the limits, response.h what is sent.
//
// Beast is included through boost.h alone. Few files instantiate its operations, because these are
// slow to compile.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"
#include "serve/web/limits.h"
#include "serve/web/pages.h"
#include "serve/web/request_checks.h"
#include "serve/web/site.h"

namespace phalanx::web {

class HttpSession;

/// Executor that runs work on the server's thread. Any thread; may outlive the server.
class ServerExecutor {
 public:
  explicit ServerExecutor(net::io_context& io) : io_(&io) {}

  /// Queues work for the server's thread. Drops it once closed.
  void post(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    if (io_ != nullptr) net::post(*io_, std::move(work));
  }
  void close() noexcept {
    const std::lock_guard lock(mutex_);
    io_ = nullptr;
  }

 private:
  std::mutex mutex_;
  net::io_context* io_;
};

/// State that all connections share. Server's thread only, except for the executor.
struct ServerContext {
  /// @param port  on which the server listens
  /// @throws WebServerError if the site, the certificate or the key cannot be used
  ServerContext(WebServerSettings given, WebApplication& its_application, net::io_context& io,
                std::uint16_t port);
  ServerContext(const ServerContext&) = delete;
  ServerContext& operator=(const ServerContext&) = delete;
  ~ServerContext();

  /// Releases all that needs the io_context, before that is destroyed. Counters stay: sessions refer to them.
  void release() noexcept;

  const WebServerSettings settings;
  WebApplication& application;
  const Site site;
  std::optional<net::ssl::context> tls;  ///< none: plain HTTP
  const HostCheck host_check;
  const TokenCheck token_check;
  const std::shared_ptr<ServerExecutor> executor;
  std::optional<Pages> pages;  ///< none after release()
  ConnectionLimiter limiter;
  std::size_t connections = 0;   ///< that have sent an accepted request
  std::size_t large_bodies = 0;  ///< that are being read
  /// Sessions whose request the application has not answered yet.
  std::map<const HttpSession*, std::shared_ptr<HttpSession>> waiting;
};

/// @throws WebServerError if settings contradict each other or are out of range; the message says what to do
void check(const WebServerSettings& settings);

}  // namespace phalanx::web
