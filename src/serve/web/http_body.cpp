// SPDX-License-Identifier: Apache-2.0
// The part of a request behind its head.
#include <fmt/format.h>

#include <utility>

#include "serve/web/http_session.h"
#include "serve/web/patience.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kSmallBody = 64 * 1024;  // [bytes]
constexpr std::size_t kLargeBodies = 2;        // larger ones at once

Reply too_large(std::size_t limit) {
  if (limit == 0) return sentence(413, "Nothing can be sent to this address.");
  return sentence(413, fmt::format("This is too large: at most {} bytes can be sent here.", limit));
}

}  // namespace

void HttpSession::ask_application() {
  if (parser_->is_done()) return hand_over();
  expect_body(house_.application.body_limit(request_));
}

void HttpSession::expect_body(std::size_t limit) {
  body_limit_ = limit;
  const auto length = parser_->content_length();
  if (limit == 0 || (length && *length > limit)) return refuse(too_large(limit));
  if (length.value_or(limit) > kSmallBody) {
    if (house_.large_bodies >= kLargeBodies) {
      return refuse(sentence(503, "Others are sending something just now. Try again in a moment."));
    }
    large_body_.emplace(house_.large_bodies);
  }
  request_.body.reserve(static_cast<std::size_t>(length.value_or(0)));
  body_since_ = Clock::now();
  const std::string expected = field(http::field::expect);
  if (expected.empty()) return read_body();
  if (!beast::iequals(expected, "100-continue")) {
    return refuse(sentence(417, "This server can expect nothing but 100-continue."));
  }
  static constexpr std::string_view kGoOn = "HTTP/1.1 100 Continue\r\n\r\n";
  net::async_write(line_, net::buffer(kGoOn), [self = shared_from_this()](error_code error, std::size_t) {
    if (!error) self->read_body();
  });
}

void HttpSession::read_body() {
  auto& body = parser_->get().body();
  body.data = piece_.data();
  body.size = piece_.size();
  line_.transport().expires_at(body_since_ +
                               seconds(patience(house_.settings.idle_timeout, request_.body.size())));
  http::async_read_some(line_, buffer_, *parser_,
                        beast::bind_front_handler(&HttpSession::on_body, shared_from_this()));
}

void HttpSession::on_body(error_code error, std::size_t /*bytes*/) {
  if (error && error != http::error::need_buffer) {
    large_body_.reset();
    if (error.category() != http::make_error_code(http::error::bad_chunk).category()) return;
    if (error == http::error::partial_message) return;
    return refuse(sentence(400, "The body of this request is broken."));
  }
  const std::size_t read = piece_.size() - parser_->get().body().size;
  if (request_.body.size() + read > body_limit_) {
    large_body_.reset();
    std::string().swap(request_.body);
    return refuse(too_large(body_limit_));
  }
  request_.body.append(piece_.data(), read);
  if (!parser_->is_done()) return read_body();
  hand_over();
}

}  // namespace phalanx::web
