// SPDX-License-Identifier: Apache-2.0
// The checks of a request's head, in their order, and the reading of its body.
#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "serve/web/session/http_session.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kLongestTarget = 2048;   // [bytes]
constexpr std::size_t kReservedShare = 16;     // a reserved share is one slot in 16
constexpr unsigned kHttp11 = 11;               // as Beast counts versions
constexpr std::size_t kSmallBody = 64 * 1024;  // a longer one is large [bytes]
constexpr std::size_t kLargeBodies = 2;        // read at once
constexpr std::array kSingleFields{http::field::host,
                                   http::field::origin,
                                   http::field::content_length,
                                   http::field::transfer_encoding,
                                   http::field::sec_websocket_key,
                                   http::field::sec_websocket_version};

/// @returns the refusal of a body that is longer than `limit` [bytes]
Reply too_large(std::size_t limit) {
  if (limit == 0) return text_reply(413, "Nothing can be sent to this address.");
  return text_reply(413, fmt::format("This is too large: at most {} bytes can be sent here.", limit));
}

}  // namespace

std::string HttpSession::field(http::field name) const { return std::string(parser_->get()[name]); }

// ---- the head ----

bool HttpSession::check_head() {
  return check_framing() && check_host() && check_form() && check_token() && check_origin() &&
         check_upgrade();
}

// Prevents request smuggling. A proxy that reads the end of a request differently would take a part of its
// body for the next request. So the connection is closed after a request whose framing is ambiguous.
bool HttpSession::check_framing() {
  const auto& head = parser_->get();
  for (const http::field name : kSingleFields) {
    if (head.count(name) <= 1) continue;
    response_context_.keep_alive = false;
    respond(text_reply(400, fmt::format("This request has the field {} more than once; send it once.",
                                        std::string(http::to_string(name)))));
    return false;
  }
  if (head.count(http::field::transfer_encoding) == 0) return true;
  const bool chunked = beast::iequals(head[http::field::transfer_encoding], "chunked");
  if (chunked && head.version() >= kHttp11) return true;
  response_context_.keep_alive = false;
  respond(text_reply(
      400,
      "This server does not know this Transfer-Encoding. Send the body with a Content-Length or, in "
      "HTTP/1.1, \"chunked\" and nothing else."));
  return false;
}

bool HttpSession::check_host() {
  const std::string host = field(http::field::host);
  if (const auto refusal = context_.host_check.refusal(host, local_address_)) {
    refuse(*refusal);
    return false;
  }
  response_context_.host = host;
  return true;
}

bool HttpSession::check_form() {
  const auto& head = parser_->get();
  const http::verb method = head.method();
  if (method != http::verb::get && method != http::verb::head && method != http::verb::post) {
    Reply reply = text_reply(405, "This server knows GET, HEAD and POST only.");
    reply.fields.emplace_back(http::field::allow, "GET, HEAD, POST");
    refuse(reply);
    return false;
  }
  const std::string_view target = head.target();
  if (target.size() > kLongestTarget) {
    refuse(text_reply(414, "This address is too long."));
    return false;
  }
  std::optional<RequestTarget> read = read_target(target);
  if (!read) {
    refuse(text_reply(400, "This address has characters or parts that no address of this server has."));
    return false;
  }
  target_ = std::move(*read);
  request_.path = target_.path;
  request_.query = target_.query;
  upgrade_ = websocket::is_upgrade(head);
  return true;
}

bool HttpSession::check_token() {
  TokenCheck::Result result = context_.token_check.check(target_.query, field(http::field::cookie));
  if (const Reply* refusal = std::get_if<Reply>(&result)) {
    refuse(*refusal);
    return false;
  }
  if (const auto* accepted = std::get_if<TokenCheck::Accepted>(&result)) {
    request_.client.may_operate = accepted->may_operate;
    return check_slot();
  }
  const auto& accepted = std::get<TokenCheck::AcceptedByAddress>(result);
  request_.client.may_operate = accepted.may_operate;
  if (!check_slot()) return false;
  // The application must not see the token.
  request_.query = without(target_.query, "token");
  if (upgrade_ || request_.method == "POST") return true;
  const std::string_view target = parser_->get().target();
  const std::string path(target.substr(0, target.find('?')));
  Reply reply = text_reply(303, "Continue at " + path);
  reply.fields.emplace_back(http::field::set_cookie, accepted.cookie);
  reply.fields.emplace_back(http::field::location,
                            request_.query.empty() ? path : path + "?" + request_.query);
  refuse(reply);
  return false;
}

// Two shares are reserved for clients that may operate, and of these one share for their WebSockets: however
// many viewers are connected, an operator can fetch the page and then connect it.
std::size_t HttpSession::reserved_slots() const {
  const std::size_t share = context_.settings.connections / kReservedShare;
  if (!request_.client.may_operate) return 2 * share;
  return upgrade_ ? 0 : share;
}

// Exchanges the pending slot for one of the server's connections. A slot that was taken for one request
// serves a later one unless that must leave more slots free.
bool HttpSession::check_slot() {
  const std::size_t reserved = reserved_slots();
  if (slot_ && reserved <= reserved_) return true;
  const std::size_t others = context_.connections - (slot_ ? 1 : 0);
  if (others + reserved < context_.settings.connections) {
    reserved_ = reserved;
    if (!slot_) slot_.emplace(context_.connections);
    pending_slot_.reset();
    return true;
  }
  // A POST without a body, such as a stop, needs no slot: a pending connection is always admitted.
  if (request_.method == "POST" && parser_->is_done()) {
    response_context_.keep_alive = false;
    return true;
  }
  refuse(text_reply(503, "The station has too many connections now. Close a page, and try again."));
  return false;
}

bool HttpSession::check_origin() {
  if (!upgrade_ && request_.method != "POST") return true;
  const auto refusal =
      origin_refusal(field(http::field::origin), response_context_.host, response_context_.tls);
  if (!refusal) return true;
  refuse(*refusal);
  return false;
}

bool HttpSession::check_upgrade() {
  const auto& head = parser_->get();
  if (!upgrade_) {
    if (!head.count(http::field::upgrade)) return true;
    refuse(text_reply(400, "A connection to this server can be upgraded to a WebSocket only."));
    return false;
  }
  if (field(http::field::sec_websocket_version) != "13") {
    Reply reply = text_reply(426, "This server knows version 13 of the WebSocket protocol only.");
    reply.fields.emplace_back(http::field::sec_websocket_version, "13");
    refuse(reply);
    return false;
  }
  if (!is_websocket_key(field(http::field::sec_websocket_key))) {
    refuse(text_reply(400, "The Sec-WebSocket-Key of this request is not 16 bytes in base64."));
    return false;
  }
  // Data before the end of the handshake would be lost.
  if (parser_->is_done() && buffer_.size() == 0) return true;
  response_context_.keep_alive = false;
  respond(
      text_reply(400, "A WebSocket handshake has no body, and no data may follow before it is answered."));
  return false;
}

// ---- the body ----

void HttpSession::read_request_body() {
  if (parser_->is_done()) return call_application();
  begin_body(context_.application.body_limit(request_));
}

void HttpSession::begin_body(std::size_t limit) {
  body_limit_ = limit;
  const auto length = parser_->content_length();
  if (limit == 0 || (length && *length > limit)) return refuse(too_large(limit));
  if (length.value_or(limit) > kSmallBody) {
    if (context_.large_bodies >= kLargeBodies) {
      return refuse(text_reply(503, "The server is receiving other large files. Try again in a moment."));
    }
    large_body_.emplace(context_.large_bodies);
  }
  request_.body.reserve(static_cast<std::size_t>(length.value_or(0)));
  body_since_ = Clock::now();
  const std::string expected = field(http::field::expect);
  if (expected.empty()) return read_body();
  if (!beast::iequals(expected, "100-continue")) {
    return refuse(text_reply(417, "The only expectation that this server meets is 100-continue."));
  }
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  net::async_write(stream_, net::buffer(kContinue),
                   [self = shared_from_this()](error_code error, std::size_t) {
                     if (!error) self->read_body();
                   });
}

void HttpSession::read_body() {
  auto& body = parser_->get().body();
  body.data = read_buffer_.data();
  body.size = read_buffer_.size();
  stream_.transport().expires_at(
      body_since_ + seconds(transfer_timeout(context_.settings.idle_timeout, request_.body.size())));
  http::async_read_some(stream_, buffer_, *parser_,
                        beast::bind_front_handler(&HttpSession::on_body, shared_from_this()));
}

void HttpSession::on_body(error_code error, std::size_t /*bytes*/) {
  if (error && error != http::error::need_buffer) {
    large_body_.reset();
    if (error.category() != http::make_error_code(http::error::bad_chunk).category()) return;
    if (error == http::error::partial_message) return;
    return refuse(text_reply(400, "The body of this request is malformed."));
  }
  const std::size_t read = read_buffer_.size() - parser_->get().body().size;
  if (request_.body.size() + read > body_limit_) {
    large_body_.reset();
    std::string().swap(request_.body);
    return refuse(too_large(body_limit_));
  }
  request_.body.append(read_buffer_.data(), read);
  if (!parser_->is_done()) return read_body();
  call_application();
}

}  // namespace phalanx::web
