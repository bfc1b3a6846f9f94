// SPDX-License-Identifier: Apache-2.0
// Which requests get in.
#include <fmt/format.h>

#include <array>
#include <utility>
#include <variant>

#include "serve/web/http_session.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kLongestTarget = 2048;  // [bytes]
constexpr std::size_t kShare = 16;            // one in so many of all places
constexpr unsigned kHttp11 = 11;              // as Beast counts versions
constexpr std::array kOnlyOnce{http::field::host,
                               http::field::origin,
                               http::field::content_length,
                               http::field::transfer_encoding,
                               http::field::sec_websocket_key,
                               http::field::sec_websocket_version};

}  // namespace

std::string HttpSession::field(http::field name) const { return std::string(parser_->get()[name]); }

// Where a request ends and what it means must be beyond doubt: a server in between that reads it otherwise
// would take a part of its body for the next request. So the connection ends with such a one.
bool HttpSession::pass_framing() {
  const auto& head = parser_->get();
  for (const http::field once : kOnlyOnce) {
    if (head.count(once) <= 1) continue;
    exchange_.keep_alive = false;
    answer(sentence(400, fmt::format("This request has the field {} more than once; send it once.",
                                     std::string(http::to_string(once)))));
    return false;
  }
  if (head.count(http::field::transfer_encoding) == 0) return true;
  const bool chunked = beast::iequals(head[http::field::transfer_encoding], "chunked");
  if (chunked && head.version() >= kHttp11) return true;
  exchange_.keep_alive = false;
  answer(sentence(400,
                  "This Transfer-Encoding is not understood. Send the body with a Content-Length or, in "
                  "HTTP/1.1, \"chunked\" and nothing else."));
  return false;
}

bool HttpSession::pass_host() {
  const std::string host = field(http::field::host);
  if (const auto refusal = house_.host_door.refusal(host, reached_)) {
    refuse(*refusal);
    return false;
  }
  exchange_.host = host;
  return true;
}

bool HttpSession::pass_form() {
  const auto& head = parser_->get();
  const http::verb method = head.method();
  if (method != http::verb::get && method != http::verb::head && method != http::verb::post) {
    Reply reply = sentence(405, "Only GET, HEAD and POST are understood here.");
    reply.fields.emplace_back(http::field::allow, "GET, HEAD, POST");
    refuse(reply);
    return false;
  }
  const std::string_view target = head.target();
  if (target.size() > kLongestTarget) {
    refuse(sentence(414, "This address is too long."));
    return false;
  }
  std::optional<RequestTarget> read = read_target(target);
  if (!read) {
    refuse(sentence(400, "This address has something in it that no address here has."));
    return false;
  }
  target_ = std::move(*read);
  request_.path = target_.path;
  request_.query = target_.query;
  upgrade_ = websocket::is_upgrade(head);
  return true;
}

bool HttpSession::pass_token() {
  TokenDoor::Verdict verdict = house_.token_door.judge(target_.query, field(http::field::cookie));
  if (const Reply* refusal = std::get_if<Reply>(&verdict)) {
    refuse(*refusal);
    return false;
  }
  if (const auto* known = std::get_if<TokenDoor::Entry>(&verdict)) {
    request_.visitor.may_operate = known->may_operate;
    return pass_place();
  }
  const auto& cookie = std::get<TokenDoor::Cookie>(verdict);
  request_.visitor.may_operate = cookie.may_operate;
  if (!pass_place()) return false;
  // Nobody behind the doors needs to see it.
  request_.query = without(target_.query, "token");
  if (upgrade_ || request_.method == "POST") return true;
  const std::string_view target = parser_->get().target();
  const std::string path(target.substr(0, target.find('?')));
  Reply reply = sentence(303, "Go on to " + path);
  reply.fields.emplace_back(http::field::set_cookie, cookie.field);
  reply.fields.emplace_back(http::field::location,
                            request_.query.empty() ? path : path + "?" + request_.query);
  refuse(reply);
  return false;
}

// However many look on, somebody who may operate can fetch the page and then become one.
std::size_t HttpSession::places_left_free() const {
  const std::size_t share = house_.settings.connections / kShare;
  if (!request_.visitor.may_operate) return 2 * share;
  return upgrade_ ? 0 : share;
}

// Who has shown that it may come in leaves the doorstep, if there is room inside. A place that was given for
// one request is good for another that has to leave as many free.
bool HttpSession::pass_place() {
  const std::size_t left_free = places_left_free();
  if (place_ && left_free <= left_free_) return true;
  const std::size_t others = house_.connections - (place_ ? 1 : 0);
  if (others + left_free < house_.settings.connections) {
    left_free_ = left_free;
    if (!place_) place_.emplace(house_.connections);
    stay_.reset();
    return true;
  }
  // A stop is heard from the doorstep, where a new one always finds room.
  if (request_.method == "POST" && parser_->is_done()) {
    exchange_.keep_alive = false;
    return true;
  }
  refuse(sentence(503, "Too many are connected to the station just now. Close a page, and try again."));
  return false;
}

bool HttpSession::pass_origin() {
  if (!upgrade_ && request_.method != "POST") return true;
  const auto refusal = origin_refusal(field(http::field::origin), exchange_.host, exchange_.tls);
  if (!refusal) return true;
  refuse(*refusal);
  return false;
}

bool HttpSession::pass_upgrade() {
  const auto& head = parser_->get();
  if (!upgrade_) {
    if (!head.count(http::field::upgrade)) return true;
    refuse(sentence(400, "A connection here can become a WebSocket, and nothing else."));
    return false;
  }
  if (field(http::field::sec_websocket_version) != "13") {
    Reply reply = sentence(426, "Only version 13 of the WebSocket protocol is understood here.");
    reply.fields.emplace_back(http::field::sec_websocket_version, "13");
    refuse(reply);
    return false;
  }
  if (!is_websocket_key(field(http::field::sec_websocket_key))) {
    refuse(sentence(400, "The Sec-WebSocket-Key of this request is not 16 bytes in base64."));
    return false;
  }
  // What a page says before it has been let in would be lost.
  if (parser_->is_done() && buffer_.size() == 0) return true;
  exchange_.keep_alive = false;
  answer(sentence(400, "A WebSocket begins with nothing but its head."));
  return false;
}

}  // namespace phalanx::web
