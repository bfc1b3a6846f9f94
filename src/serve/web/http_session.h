// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "serve/web/house.h"
#include "serve/web/line.h"
#include "serve/web/place.h"
#include "serve/web/reply.h"
#include "serve/web/request_path.h"

namespace phalanx::web {

/// One connection, request after request, until it closes or becomes a page's WebSocket.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(House& house, tcp::socket&& socket);

  void start();

 private:
  using Parser = http::request_parser<http::buffer_body>;
  static constexpr std::size_t kPiece = 16 * 1024;  ///< of a body [bytes]

  void send_away();
  /// Until when the next request must have been said.
  [[nodiscard]] Clock::time_point request_by() const;
  void read_head();
  void on_head(error_code error, std::size_t bytes);
  void refuse_head(error_code error);

  // The doors, in their order. Each returns whether the request may go on; if not, it has been answered.
  bool pass_framing();
  bool pass_host();
  bool pass_form();
  bool pass_token();
  bool pass_place();
  bool pass_origin();
  bool pass_upgrade();

  /// Of all places, those that such a request leaves to others.
  [[nodiscard]] std::size_t places_left_free() const;
  void become_page();
  void serve_file(const SiteFile& file);
  void ask_application();
  void expect_body(std::size_t limit);
  void read_body();
  void on_body(error_code error, std::size_t bytes);
  void hand_over();
  void deliver(WebAnswer answer);

  void answer(const Reply& reply);
  /// Answers, and closes if there is a body that nobody reads.
  void refuse(const Reply& reply);
  void on_answered(error_code error, std::size_t bytes);
  void linger();
  void drain(std::size_t left);

  [[nodiscard]] std::string field(http::field name) const;

  House& house_;
  Line line_;
  std::optional<Doorstep::Stay> stay_;  ///< until it has asked for something rightly
  Clock::time_point proof_by_;
  std::optional<Place> place_;  ///< from then on
  std::size_t left_free_ = 0;   ///< places_left_free() of the request that it was given for
  std::string reached_;         ///< our address of this connection
  beast::flat_buffer buffer_;
  std::optional<Parser> parser_;
  Exchange exchange_;
  RequestTarget target_;
  WebRequest request_;
  bool upgrade_ = false;
  std::size_t body_limit_ = 0;
  std::optional<Place> large_body_;
  Clock::time_point body_since_;
  std::array<char, kPiece> piece_{};
  std::optional<Response> response_;
};

}  // namespace phalanx::web
