// SPDX-License-Identifier: Apache-2.0
#include "phalanx/serve/web_server.h"

#include <fmt/format.h>
#include <netinet/tcp.h>

#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "serve/web/server_context.h"
#include "serve/web/session/http_session.h"

namespace phalanx {
namespace web {
namespace {

constexpr auto kRetry = std::chrono::milliseconds(100);  // after an accept that failed
constexpr int kPortsTried = 21;

// The kernel holds at most this much unsent data of a connection, so that a slow page
// receives recent messages.
constexpr int kUnsent = 16 * 1024;  // [bytes]

void set_options(tcp::socket& socket) {
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  socket.set_option(net::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>(kUnsent), ignored);
}

/// Opens, binds and listens. @returns the error; the acceptor is closed then
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
        fmt::format("port {} is not open to ordinary users; choose one above 1023", settings.port));
  }
  return WebServerError(fmt::format("{} port {}: {}; is it an address of this machine?", settings.address,
                                    settings.port, error.message()));
}

/// @returns an acceptor that is bound and listens
/// @throws WebServerError if the address or the port cannot be used
tcp::acceptor open_acceptor(net::io_context& io, const WebServerSettings& settings) {
  const net::ip::address address =
      net::ip::make_address(settings.address == "localhost" ? "127.0.0.1" : settings.address);
  tcp::acceptor acceptor(io);
  const int tries = settings.next_free_port && settings.port != 0 ? kPortsTried : 1;
  error_code error;
  for (int port = settings.port; port < settings.port + tries && port <= 65535; ++port) {
    error = bind_to(acceptor, {address, static_cast<std::uint16_t>(port)});
    if (error != net::error::address_in_use) break;
  }
  if (error) throw no_port(settings, error);
  return acceptor;
}

}  // namespace

/// Accepts connections and starts an HttpSession for each. Server's thread only.
class Listener {
 public:
  Listener(ServerContext& context, tcp::acceptor&& acceptor)
      : context_(context), acceptor_(std::move(acceptor)), retry_timer_(acceptor_.get_executor()) {}

  void start() {
    acceptor_.async_accept(
        [this](error_code error, tcp::socket socket) { on_connection(error, std::move(socket)); });
  }
  void stop() noexcept {
    error_code ignored;
    acceptor_.close(ignored);
    retry_timer_.cancel();
  }

 private:
  void on_connection(error_code error, tcp::socket socket) {
    if (error == net::error::operation_aborted || !acceptor_.is_open()) return;
    if (error) return retry_later();
    // Starts the next accept first, so that an exception of this connection cannot end the accepts.
    start();
    set_options(socket);
    std::make_shared<HttpSession>(context_, std::move(socket))->start();
  }
  /// Waits before the next accept: an error that lasts, such as no free descriptor, must not use
  /// up a processor.
  void retry_later() {
    retry_timer_.expires_after(kRetry);
    retry_timer_.async_wait([this](error_code stopped) {
      if (!stopped) start();
    });
  }

  ServerContext& context_;
  tcp::acceptor acceptor_;
  net::steady_timer retry_timer_;
};

}  // namespace web

namespace {

using namespace web;  // NOLINT(google-build-using-namespace)

constexpr auto kStopTimeout = std::chrono::seconds(1);        // for the closing handshakes of all pages
constexpr auto kStopInterval = std::chrono::milliseconds(5);  // of the checks whether they are done

}  // namespace

struct WebServer::Impl {
  Impl(WebServerSettings settings, WebApplication& application) : io(std::make_unique<net::io_context>(1)) {
    tcp::acceptor acceptor = open_acceptor(*io, settings);
    port = acceptor.local_endpoint().port();
    context = std::make_unique<ServerContext>(std::move(settings), application, *io, port);
    listener.emplace(*context, std::move(acceptor));
    close_timer.emplace(*io);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { release(); }

  void run() noexcept {
    while (!io->stopped()) {
      try {
        io->run();
      } catch (const std::exception&) {
        // An exception, such as no memory, ends the connection whose handler threw it. The others go on.
      }
    }
  }

  void begin_close() {
    listener->stop();
    context->pages->disconnect_all(websocket::close_code::going_away, "the station has ended");
    stop_when_closed(Clock::now() + kStopTimeout);
  }

  /// Stops the io_context once all pages are closed, or at the deadline.
  void stop_when_closed(Clock::time_point deadline) {
    close_timer->expires_after(kStopInterval);
    close_timer->async_wait([this, deadline](error_code) {
      if (context->pages->empty() || Clock::now() > deadline) {
        io->stop();
      } else {
        stop_when_closed(deadline);
      }
    });
  }

  /// Destroys in this order: what uses the io_context, the io_context with its pending handlers, and (with
  /// this object) the context that those handlers refer to.
  void release() noexcept {
    close_timer.reset();
    listener.reset();
    context->release();
    io.reset();
  }

  std::unique_ptr<net::io_context> io;
  std::uint16_t port = 0;
  std::unique_ptr<ServerContext> context;
  std::optional<Listener> listener;
  std::optional<net::steady_timer> close_timer;
  std::mutex mutex;  ///< of start() and stop()
  std::thread thread;
  bool stopped = false;
};

WebServer::WebServer(WebServerSettings settings, WebApplication& application) {
  check(settings);
  impl_ = std::make_unique<Impl>(std::move(settings), application);
}

WebServer::~WebServer() { stop(); }

void WebServer::start() {
  const std::lock_guard lock(impl_->mutex);
  if (impl_->stopped || impl_->thread.joinable()) return;
  net::post(*impl_->io, [impl = impl_.get()] { impl->listener->start(); });
  impl_->thread = start_nice_thread("phalanx-web", [impl = impl_.get()] { impl->run(); });
}

void WebServer::stop() noexcept {
  const std::lock_guard lock(impl_->mutex);
  if (std::exchange(impl_->stopped, true)) return;
  impl_->context->executor->close();
  if (impl_->thread.joinable()) {
    net::post(*impl_->io, [impl = impl_.get()] { impl->begin_close(); });
    impl_->thread.join();
  }
  impl_->release();
}

std::uint16_t WebServer::port() const noexcept { return impl_->port; }

bool WebServer::tls() const noexcept { return impl_->context->tls.has_value(); }

std::string WebServer::url() const {
  std::string address = impl_->context->settings.address;
  if (address == "0.0.0.0") address = "127.0.0.1";
  if (address == "::") address = "::1";
  const bool v6 = address.find(':') != std::string::npos;
  return fmt::format("{}://{}:{}/", tls() ? "https" : "http", v6 ? "[" + address + "]" : address, port());
}

void WebServer::post(std::function<void()> work) { impl_->context->executor->post(std::move(work)); }

void WebServer::send(PageId page, Bytes message) {
  if (impl_->context->pages) impl_->context->pages->send(page, std::move(message));
}

bool WebServer::send_newest(PageId page, Bytes message, std::size_t kind) {
  return impl_->context->pages && impl_->context->pages->send_newest(page, std::move(message), kind);
}

void WebServer::disconnect(PageId page, const std::string& reason) {
  if (impl_->context->pages) {
    impl_->context->pages->disconnect(page, websocket::close_code::policy_error, reason, false);
  }
}

}  // namespace phalanx
