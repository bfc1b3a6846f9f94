// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/line.h"
#include "serve/web/message_rate.h"
#include "serve/web/page_queue.h"
#include "serve/web/place.h"
#include "serve/web/reply.h"

namespace phalanx::web {

class Pages;

/// A page's WebSocket: one message is being written at most, the others wait in its queue. Lives as long as
/// something of it is under way.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  /// @param settings, pages  outlive it
  PageSession(PageId id, Visitor visitor, Line&& line, Place place, const WebServerSettings& settings,
              Pages& pages);
  ~PageSession();
  PageSession(const PageSession&) = delete;
  PageSession& operator=(const PageSession&) = delete;

  [[nodiscard]] PageId id() const noexcept { return id_; }
  [[nodiscard]] const Visitor& visitor() const noexcept { return visitor_; }

  /// Shakes hands; joins the pages if that goes well.
  void accept(const http::request<http::buffer_body>& request, const Exchange& exchange);

  /// @returns false if the queue is full
  [[nodiscard]] bool send(Bytes message);
  /// @returns whether it has replaced one
  bool send_newest(Bytes message);
  /// Says goodbye behind what waits, which has a moment to get through; nothing is taken from it any more.
  /// @param at_once  drop what waits
  void leave(websocket::close_code code, const std::string& reason, bool at_once);
  /// Cuts the line if a write or the goodbye takes too long; shows out who said too much.
  void check(Clock::time_point now);

 private:
  void on_accepted(error_code error);
  void read();
  void on_read(error_code error, std::size_t bytes);
  void hear_last_words(std::string_view message);
  void show_out_for_too_much();
  void count_control_frame(websocket::frame_type kind);
  void pump();
  void close();
  void on_written(error_code error, std::size_t bytes);
  void cut();

  PageId id_;
  Visitor visitor_;
  websocket::stream<Line, false> socket_;
  Place place_;
  const WebServerSettings& settings_;
  Pages& pages_;
  beast::flat_buffer message_;
  MessageRate rate_;
  PageQueue queue_;
  Bytes in_flight_;  ///< null: none is being written
  Clock::time_point written_since_;
  /// Set: it has said too much, and what it said in one go is still heard until then.
  std::optional<Clock::time_point> heard_until_;
  std::size_t last_words_ = 0;  ///< heard since [bytes]
  bool leaving_ = false;
  bool closing_ = false;
  Clock::time_point out_by_;
  websocket::close_reason goodbye_;
};

}  // namespace phalanx::web
