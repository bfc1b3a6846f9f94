// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

class PageSession;

/// All pages that are connected, and the frames that are due while there are any. On the server's thread
/// only.
class Pages {
 public:
  /// @param thread, application  outlive it
  Pages(net::io_context& thread, double frame_rate_hz, WebApplication& application);

  /// Never the same twice in a process.
  [[nodiscard]] static PageId next_id() noexcept;
  void admit(const std::shared_ptr<PageSession>& page);
  void received(PageId page, std::string_view message);
  void received_too_much(PageId page, std::string_view last);
  /// Its line is no more.
  void ended(PageId page);

  void send(PageId page, Bytes message);
  bool send_newest(PageId page, Bytes message);
  /// It is no page any more; its line ends when it has taken that in, or soon.
  void show_out(PageId page, websocket::close_code code, const std::string& reason, bool at_once);
  void show_out_all(websocket::close_code code, const std::string& reason);

  [[nodiscard]] bool empty() const noexcept { return pages_.empty() && leaving_.empty(); }
  /// Drops all; nobody is told.
  void clear() noexcept;

 private:
  using Sessions = std::map<PageId, std::shared_ptr<PageSession>>;

  void tell_left(PageId page);
  void await_frame();
  void on_frame(error_code error);

  net::io_context& thread_;
  WebApplication& application_;
  Sessions pages_;
  Sessions leaving_;
  net::steady_timer timer_;
  Clock::duration period_;
  bool frames_ = false;  ///< are being waited for
};

}  // namespace phalanx::web
