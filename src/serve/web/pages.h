// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

class PageSession;

/// The sessions of all connected pages, and the timer of the frames. The timer runs while there is a page.
/// Server's thread only.
class Pages {
 public:
  /// @param io, application  outlive it
  Pages(net::io_context& io, double frame_rate_hz, WebApplication& application);

  /// @returns a new number, unique in this process
  [[nodiscard]] static PageId next_id() noexcept;
  /// Adds a page and tells the application that it joined.
  void add(const std::shared_ptr<PageSession>& page);
  void received(PageId page, std::string_view message);
  void received_over_limit(PageId page, std::string_view message);
  /// Removes a page whose connection is closed.
  void remove(PageId page);

  void send(PageId page, Bytes message);
  bool send_newest(PageId page, Bytes message, std::size_t kind);
  /// Removes a page from those that are connected, and closes its connection.
  /// @param drop_queue  as PageSession::begin_close()
  void disconnect(PageId page, websocket::close_code code, const std::string& reason, bool drop_queue);
  void disconnect_all(websocket::close_code code, const std::string& reason);

  /// @returns true if no connection is left, not even one that is closing
  [[nodiscard]] bool empty() const noexcept { return pages_.empty() && closing_.empty(); }

 private:
  using Sessions = std::map<PageId, std::shared_ptr<PageSession>>;

  void notify_left(PageId page);
  void await_frame();
  void on_frame(error_code error);

  net::io_context& io_;
  WebApplication& application_;
  Sessions pages_;
  Sessions closing_;
  net::steady_timer timer_;
  Clock::duration period_;
  bool timer_runs_ = false;
};

}  // namespace phalanx::web
