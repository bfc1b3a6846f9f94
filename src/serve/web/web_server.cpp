// SPDX-License-Identifier: Apache-2.0
#include "phalanx/serve/web_server.h"

#include <fmt/format.h>

#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "serve/web/house.h"
#include "serve/web/listener.h"
#include "serve/web/settings.h"

namespace phalanx {
namespace {

using namespace web;  // NOLINT(google-build-using-namespace)

constexpr auto kGoodbye = std::chrono::seconds(1);    // all pages have this long to hear it
constexpr auto kLook = std::chrono::milliseconds(5);  // how often it is seen whether they did

}  // namespace

struct WebServer::Parts {
  Parts(WebServerSettings settings, WebApplication& application) : io(std::make_unique<net::io_context>(1)) {
    tcp::acceptor acceptor = listen(*io, settings);
    port = acceptor.local_endpoint().port();
    house = std::make_unique<House>(std::move(settings), application, *io, port);
    listener.emplace(*house, std::move(acceptor));
    goodbye.emplace(*io);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() { tear_down(); }

  void run() noexcept {
    while (!io->stopped()) {
      try {
        io->run();
      } catch (const std::exception&) {
        // A connection that ran out of memory, say, is gone with what it held; the others go on.
      }
    }
  }

  void say_goodbye() {
    listener->stop();
    house->pages->show_out_all(websocket::close_code::going_away, "the station has ended");
    await_goodbye(Clock::now() + kGoodbye);
  }

  void await_goodbye(Clock::time_point until) {
    goodbye->expires_after(kLook);
    goodbye->async_wait([this, until](error_code) {
      if (house->pages->empty() || Clock::now() > until) {
        io->stop();
      } else {
        await_goodbye(until);
      }
    });
  }

  /// First what needs the context, then what is under way in it, then (with the parts) what that refers to.
  void tear_down() noexcept {
    goodbye.reset();
    listener.reset();
    house->vacate();
    io.reset();
  }

  std::unique_ptr<net::io_context> io;
  std::uint16_t port = 0;
  std::unique_ptr<House> house;
  std::optional<Listener> listener;
  std::optional<net::steady_timer> goodbye;
  std::mutex starting;  ///< and stopping
  std::thread thread;
  bool stopped = false;
};

WebServer::WebServer(WebServerSettings settings, WebApplication& application) {
  check(settings);
  parts_ = std::make_unique<Parts>(std::move(settings), application);
}

WebServer::~WebServer() { stop(); }

void WebServer::start() {
  const std::lock_guard lock(parts_->starting);
  if (parts_->stopped || parts_->thread.joinable()) return;
  net::post(*parts_->io, [parts = parts_.get()] { parts->listener->start(); });
  parts_->thread = start_nice_thread("phalanx-web", [parts = parts_.get()] { parts->run(); });
}

void WebServer::stop() noexcept {
  const std::lock_guard lock(parts_->starting);
  if (std::exchange(parts_->stopped, true)) return;
  parts_->house->gate->close();
  if (parts_->thread.joinable()) {
    net::post(*parts_->io, [parts = parts_.get()] { parts->say_goodbye(); });
    parts_->thread.join();
  }
  parts_->tear_down();
}

std::uint16_t WebServer::port() const noexcept { return parts_->port; }

bool WebServer::tls() const noexcept { return parts_->house->tls.has_value(); }

std::string WebServer::url() const {
  std::string address = parts_->house->settings.address;
  if (address == "0.0.0.0") address = "127.0.0.1";
  if (address == "::") address = "::1";
  const bool v6 = address.find(':') != std::string::npos;
  return fmt::format("{}://{}:{}/", tls() ? "https" : "http", v6 ? "[" + address + "]" : address, port());
}

void WebServer::post(std::function<void()> work) { parts_->house->gate->post(std::move(work)); }

void WebServer::send(PageId page, Bytes message) {
  if (parts_->house->pages) parts_->house->pages->send(page, std::move(message));
}

bool WebServer::send_newest(PageId page, Bytes message) {
  return parts_->house->pages && parts_->house->pages->send_newest(page, std::move(message));
}

void WebServer::show_out(PageId page, const std::string& reason) {
  if (parts_->house->pages) {
    parts_->house->pages->show_out(page, websocket::close_code::policy_error, reason, false);
  }
}

}  // namespace phalanx
