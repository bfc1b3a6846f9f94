// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/limits.h"
#include "serve/web/response.h"
#include "serve/web/session/stream.h"

namespace phalanx::web {

class Pages;

/// WebSocket session of a page. At most one message is being written; the others wait in its queue. The
/// handlers of its asynchronous operations keep it alive. Accept, read and close of the WebSocket have files
/// of their own: each takes the compiler about 20 s and 0.3 GB.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  /// @param settings, pages  outlive it
  PageSession(PageId id, ClientInfo client, Stream&& stream, CountedSlot slot,
              const WebServerSettings& settings, Pages& pages);
  ~PageSession();
  PageSession(const PageSession&) = delete;
  PageSession& operator=(const PageSession&) = delete;

  [[nodiscard]] PageId id() const noexcept { return id_; }
  [[nodiscard]] const ClientInfo& client() const noexcept { return client_; }

  /// Answers the WebSocket handshake. Adds the session to the pages if it succeeds.
  void accept(const http::request<http::buffer_body>& request, const ResponseContext& context);

  /// Queues an ordered message. @returns false if the queue is full
  [[nodiscard]] bool send(Bytes message);
  /// Queues the newest message. @returns true if it replaced one
  bool send_newest(Bytes message, std::size_t kind);
  /// Begins to close: sends the queued messages, then the close frame. Ignores all that is received
  /// from now on.
  /// @param drop_queue  sends the close frame without the queued messages
  void begin_close(websocket::close_code code, const std::string& reason, bool drop_queue);
  /// Aborts the connection if a write or the close takes too long. Disconnects a page whose time over the
  /// rate limit has ended.
  void check_timeouts(Clock::time_point now);

 private:
  void on_accepted(error_code error);
  void read();
  void on_read(error_code error, std::size_t bytes);
  void receive_over_limit(std::string_view message);
  void close_over_limit();
  void count_control_frame(websocket::frame_type kind);
  void write_next();
  void on_written(error_code error, std::size_t bytes);
  void close();
  void abort();

  PageId id_;
  ClientInfo client_;
  websocket::stream<Stream, false> socket_;
  CountedSlot slot_;
  const WebServerSettings& settings_;
  Pages& pages_;
  beast::flat_buffer message_;
  MessageRateLimit rate_;
  OutgoingQueue queue_;
  Bytes in_flight_;  ///< null: no message is being written
  Clock::time_point written_since_;
  /// Set once the page has exceeded its rate limit: until then its messages are received as over the limit.
  std::optional<Clock::time_point> over_limit_until_;
  std::size_t over_limit_bytes_ = 0;  ///< received over the limit [bytes]
  bool closing_ = false;              ///< nothing is received any more
  bool close_sent_ = false;           ///< nothing is written any more
  Clock::time_point close_deadline_;
  websocket::close_reason close_reason_;
};

}  // namespace phalanx::web
