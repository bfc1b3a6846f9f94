// SPDX-License-Identifier: Apache-2.0
// Which requests get in.
#include <fmt/format.h>

#include <utility>
#include <variant>

#include "serve/web/http_session.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kLongestTarget = 2048;  // [bytes]
constexpr std::size_t kShare = 16;            // one in so many of all places

}  // namespace

std::string HttpSession::field(http::field name) const { return std::string(parser_->get()[name]); }

bool HttpSession::pass_host() {
  if (parser_->get().count(http::field::host) > 1) {
    refuse(sentence(400, "This request names two hosts."));
    return false;
  }
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
  // What a page says before it has been let in would be lost.
  if (parser_->is_done() && buffer_.size() == 0) return true;
  exchange_.keep_alive = false;
  answer(sentence(400, "A WebSocket begins with nothing but its head."));
  return false;
}

}  // namespace phalanx::web
