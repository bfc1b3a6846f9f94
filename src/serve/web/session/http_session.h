// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "serve/web/limits.h"
#include "serve/web/request_checks.h"
#include "serve/web/response.h"
#include "serve/web/server_context.h"
#include "serve/web/session/stream.h"

namespace phalanx::web {

/// HTTP session of one connection: reads and answers one request after the other, until the connection closes
/// or becomes a WebSocket. http_session.cpp has the connection and the responses, http_request.cpp the checks
/// of a request and its body.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ServerContext& context, tcp::socket&& socket);

  void start();

 private:
  using Parser = http::request_parser<http::buffer_body>;
  static constexpr std::size_t kReadSize = 16 * 1024;  ///< of a body at once [bytes]

  void evict();
  /// @returns the time by which the next request's head must have arrived
  [[nodiscard]] Clock::time_point head_deadline() const;
  void read_head();
  void on_head(error_code error, std::size_t bytes);
  void on_head_error(error_code error);

  // ---- the checks of a request's head, in their order: http_request.cpp
  /// Runs all of them. @returns false if one has failed: then the request has been answered
  bool check_head();
  bool check_framing();
  bool check_host();
  bool check_form();
  bool check_token();
  bool check_slot();
  bool check_origin();
  bool check_upgrade();
  /// @returns how many slots a request of this kind must leave free for others
  [[nodiscard]] std::size_t reserved_slots() const;
  /// @returns a field of the request; empty if it is not there
  [[nodiscard]] std::string field(http::field name) const;

  // ---- a request's body: http_request.cpp
  void read_request_body();
  void begin_body(std::size_t limit);
  void read_body();
  void on_body(error_code error, std::size_t bytes);

  // ---- what becomes of a request
  void upgrade_to_page();
  void serve_file(const SiteFile& file);
  void call_application();
  void on_application_response(WebResponse given);

  // ---- responses
  void respond(const Reply& reply);
  /// Responds. Closes the connection afterwards if the request has a body that is not read.
  void refuse(const Reply& reply);
  void on_responded(error_code error, std::size_t bytes);
  /// Closes the connection without a reset, which could discard the response before the client has read it.
  void shut_down();
  void drain(std::size_t bytes_left);

  ServerContext& context_;
  Stream stream_;
  std::optional<ConnectionLimiter::Slot> pending_slot_;  ///< until a request has been accepted
  Clock::time_point pending_until_;
  std::optional<CountedSlot> slot_;  ///< of ServerContext::connections, from then on
  std::size_t reserved_ = 0;         ///< reserved_slots() of the request for which slot_ was taken
  std::string local_address_;        ///< of this connection
  beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  ResponseContext response_context_;
  RequestTarget target_;
  WebRequest request_;
  bool upgrade_ = false;
  std::size_t body_limit_ = 0;
  std::optional<CountedSlot> large_body_;
  Clock::time_point body_since_;
  std::array<char, kReadSize> read_buffer_{};
  std::optional<Response> response_;
};

}  // namespace phalanx::web
