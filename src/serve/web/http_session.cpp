// SPDX-License-Identifier: Apache-2.0
#include "serve/web/http_session.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "serve/web/page_session.h"
#include "serve/web/patience.h"
#include "serve/web/pending_answer.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kLongestDrain = 1024 * 1024;  // [bytes]
constexpr auto kLingering = std::chrono::seconds(2);

std::string address_text(const tcp::endpoint& endpoint) {
  const net::ip::address address = endpoint.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

}  // namespace

HttpSession::HttpSession(House& house, tcp::socket&& socket)
    : house_(house),
      line_(std::move(socket), house.tls ? &*house.tls : nullptr),
      proof_by_(Clock::now() + seconds(house.settings.proof_timeout)),
      buffer_(house.settings.header_limit + kPiece) {
  exchange_.tls = house.tls.has_value();
}

void HttpSession::start() {
  error_code error;
  const tcp::endpoint there = line_.transport().socket().remote_endpoint(error);
  if (error) return;  // gone already
  request_.visitor.address = address_text(there);
  reached_ = address_text(line_.transport().socket().local_endpoint(error));
  stay_.emplace(house_.doorstep.come(request_.visitor.address, [this] { send_away(); }));
  if (!line_.secure()) return read_head();
  line_.transport().expires_at(request_by());
  line_.async_handshake([self = shared_from_this()](error_code failure) {
    if (!failure) self->read_head();
  });
}

void HttpSession::send_away() {
  stay_.reset();
  line_.transport().close();
}

Clock::time_point HttpSession::request_by() const {
  const Clock::time_point by = Clock::now() + seconds(house_.settings.request_timeout);
  return place_ ? by : std::min(by, proof_by_);
}

void HttpSession::read_head() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(house_.settings.header_limit));
  // Ours to count: what the parser does with a limit depends on what the head says.
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
  exchange_.host.clear();
  exchange_.keep_alive = false;
  line_.transport().expires_at(request_by());
  http::async_read_header(line_, buffer_, *parser_,
                          beast::bind_front_handler(&HttpSession::on_head, shared_from_this()));
}

void HttpSession::on_head(error_code error, std::size_t /*bytes*/) {
  if (error) return refuse_head(error);
  const auto& head = parser_->get();
  exchange_.version = head.version();
  exchange_.keep_alive = head.keep_alive();
  exchange_.head_only = head.method() == http::verb::head;
  request_.method = std::string(head.method_string());
  request_.page_secret = std::string(head["X-Phalanx-Page"]);
  request_.body.clear();
  if (!pass_framing() || !pass_host() || !pass_form() || !pass_token() || !pass_origin() || !pass_upgrade())
    return;
  if (upgrade_) return become_page();
  if (const SiteFile* file = house_.site.find(request_.path)) return serve_file(*file);
  if (request_.path == "/") return refuse(sentence(503, house_.settings.site_missing));
  ask_application();
}

void HttpSession::refuse_head(error_code error) {
  exchange_.version = 11;
  exchange_.head_only = false;
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    const auto begin = net::buffers_begin(buffer_.data());
    const auto end = net::buffers_end(buffer_.data());
    if (std::find(begin, end, '\n') == end) return answer(sentence(414, "This address is too long."));
    return answer(sentence(431, "This request has too much in its header fields."));
  }
  const bool spoken = error != http::error::end_of_stream && error != http::error::partial_message;
  if (spoken && error.category() == http::make_error_code(http::error::bad_method).category()) {
    return answer(sentence(400, "This is not a request of HTTP."));
  }
  linger();
}

void HttpSession::serve_file(const SiteFile& file) {
  if (request_.method == "POST") {
    Reply reply = sentence(405, "This can only be read.");
    reply.fields.emplace_back(http::field::allow, "GET, HEAD");
    return refuse(reply);
  }
  if (!parser_->is_done()) return refuse(sentence(413, "Nothing can be sent to this address."));
  Reply reply;
  reply.type = file.type;
  reply.cache = file.immutable ? "public, max-age=31536000, immutable" : "no-cache";
  reply.fields.emplace_back(http::field::etag, file.tag);
  if (file.gzipped) reply.fields.emplace_back(http::field::vary, "Accept-Encoding");
  if (field(http::field::if_none_match) == file.tag) {
    reply.status = 304;
    return answer(reply);
  }
  const bool packed = file.gzipped && accepts_gzip(field(http::field::accept_encoding));
  if (packed) reply.fields.emplace_back(http::field::content_encoding, "gzip");
  reply.body = packed ? file.gzipped : file.bytes;
  answer(reply);
}

void HttpSession::become_page() {
  auto page = std::make_shared<PageSession>(Pages::next_id(), request_.visitor, std::move(line_),
                                            std::move(*place_), house_.settings, *house_.pages);
  page->accept(parser_->get(), exchange_);
}

void HttpSession::hand_over() {
  large_body_.reset();
  house_.waiting[this] = shared_from_this();
  // The answer may outlive the server, so it must not keep this alive.
  auto deliver = [weak = weak_from_this()](WebAnswer given) {
    if (const auto self = weak.lock()) self->deliver(std::move(given));
  };
  auto pending = std::make_shared<PendingAnswer>(house_.gate, std::move(deliver));
  house_.application.requested(request_, [pending](WebAnswer given) { pending->give(std::move(given)); });
  std::string().swap(request_.body);
}

void HttpSession::deliver(WebAnswer given) {
  const auto self = shared_from_this();
  house_.waiting.erase(this);
  Reply reply;
  reply.status = given.status >= 200 && given.status <= 599 ? given.status : 500;
  reply.type = std::move(given.type);
  reply.body = std::move(given.body);
  if (given.immutable) reply.cache = "private, max-age=31536000, immutable";
  answer(reply);
}

void HttpSession::refuse(const Reply& reply) {
  if (!parser_->is_done()) exchange_.keep_alive = false;
  answer(reply);
}

void HttpSession::answer(const Reply& reply) {
  response_.emplace(response_of(reply, exchange_));
  // A reader that takes next to nothing is not waited for.
  line_.transport().expires_after(
      seconds(patience(house_.settings.idle_timeout, SharedBody::size(response_->body()))));
  http::async_write(line_, *response_,
                    beast::bind_front_handler(&HttpSession::on_answered, shared_from_this()));
}

void HttpSession::on_answered(error_code error, std::size_t /*bytes*/) {
  response_.reset();
  if (error) return;
  if (exchange_.keep_alive) return read_head();
  linger();
}

// Closing with something unread would take the answer back before it is read.
void HttpSession::linger() {
  error_code ignored;
  line_.transport().socket().shutdown(tcp::socket::shutdown_send, ignored);
  if (ignored) return;
  line_.transport().expires_after(kLingering);
  drain(kLongestDrain);
}

void HttpSession::drain(std::size_t left) {
  line_.transport().async_read_some(net::buffer(piece_),
                                    [self = shared_from_this(), left](error_code error, std::size_t n) {
                                      if (!error && n < left) self->drain(left - n);
                                    });
}

}  // namespace phalanx::web
