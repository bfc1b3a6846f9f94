// SPDX-License-Identifier: Apache-2.0
#include "serve/web/session/http_session.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <utility>

#include "serve/web/session/page_session.h"

namespace phalanx::web {
namespace {

constexpr std::size_t kDrainLimit = 1024 * 1024;  // [bytes]
constexpr auto kDrainTimeout = std::chrono::seconds(2);

std::string address_text(const tcp::endpoint& endpoint) {
  const net::ip::address address = endpoint.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6()).to_string();
  }
  return address.to_string();
}

/// Response that the application owes for a request. Only the first call of give() counts. If the application
/// destroys all copies of its callback without a call, the destructor gives the response 500. Any thread.
class PendingResponse {
 public:
  PendingResponse(std::shared_ptr<ServerExecutor> executor, std::function<void(WebResponse)> deliver)
      : executor_(std::move(executor)), deliver_(std::move(deliver)) {}
  PendingResponse(const PendingResponse&) = delete;
  PendingResponse& operator=(const PendingResponse&) = delete;
  ~PendingResponse() {
    WebResponse none;
    none.status = 500;
    none.body = std::make_shared<const std::string>("The station has no answer to this.\n");
    give(std::move(none));
  }

  void give(WebResponse response) {
    if (given_.exchange(true)) return;
    executor_->post(
        [deliver = deliver_, response = std::move(response)]() mutable { deliver(std::move(response)); });
  }

 private:
  std::shared_ptr<ServerExecutor> executor_;
  std::function<void(WebResponse)> deliver_;
  std::atomic<bool> given_{false};
};

}  // namespace

HttpSession::HttpSession(ServerContext& context, tcp::socket&& socket)
    : context_(context),
      stream_(std::move(socket), context.tls ? &*context.tls : nullptr),
      pending_until_(Clock::now() + seconds(context.settings.pending_timeout)),
      buffer_(context.settings.header_limit + kReadSize) {
  response_context_.tls = context.tls.has_value();
}

void HttpSession::start() {
  error_code error;
  const tcp::endpoint remote = stream_.transport().socket().remote_endpoint(error);
  if (error) return;  // closed already
  request_.client.address = address_text(remote);
  local_address_ = address_text(stream_.transport().socket().local_endpoint(error));
  pending_slot_.emplace(context_.limiter.admit(request_.client.address, [this] { evict(); }));
  if (!stream_.secure()) return read_head();
  stream_.transport().expires_at(head_deadline());
  stream_.async_handshake([self = shared_from_this()](error_code failure) {
    if (!failure) self->read_head();
  });
}

void HttpSession::evict() {
  pending_slot_.reset();
  stream_.transport().close();
}

Clock::time_point HttpSession::head_deadline() const {
  const Clock::time_point by = Clock::now() + seconds(context_.settings.request_timeout);
  return slot_ ? by : std::min(by, pending_until_);
}

void HttpSession::read_head() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(context_.settings.header_limit));
  // on_body() keeps the limit itself: the parser applies its own in a way that depends on the head.
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
  response_context_.host.clear();
  response_context_.keep_alive = false;
  stream_.transport().expires_at(head_deadline());
  http::async_read_header(stream_, buffer_, *parser_,
                          beast::bind_front_handler(&HttpSession::on_head, shared_from_this()));
}

void HttpSession::on_head(error_code error, std::size_t /*bytes*/) {
  if (error) return on_head_error(error);
  const auto& head = parser_->get();
  response_context_.version = head.version();
  response_context_.keep_alive = head.keep_alive();
  response_context_.head_only = head.method() == http::verb::head;
  request_.method = std::string(head.method_string());
  request_.page_secret = std::string(head["X-Phalanx-Page"]);
  request_.session = std::string(head["X-Phalanx-Session"]);
  request_.range = field(http::field::range);
  request_.body.clear();
  if (!check_head()) return;
  if (upgrade_) return upgrade_to_page();
  if (const SiteFile* file = context_.site.find(request_.path)) return serve_file(*file);
  if (request_.path == "/") return refuse(text_reply(503, context_.settings.site_missing));
  read_request_body();
}

void HttpSession::on_head_error(error_code error) {
  response_context_.version = 11;
  response_context_.head_only = false;
  if (error == http::error::header_limit || error == http::error::buffer_overflow) {
    const auto begin = net::buffers_begin(buffer_.data());
    const auto end = net::buffers_end(buffer_.data());
    if (std::find(begin, end, '\n') == end) return respond(text_reply(414, "This address is too long."));
    return respond(text_reply(431, "This request has too much in its header fields."));
  }
  const bool received = error != http::error::end_of_stream && error != http::error::partial_message;
  if (received && error.category() == http::make_error_code(http::error::bad_method).category()) {
    return respond(text_reply(400, "This is not a request of HTTP."));
  }
  shut_down();
}

void HttpSession::serve_file(const SiteFile& file) {
  if (request_.method == "POST") {
    Reply reply = text_reply(405, "This can only be read.");
    reply.fields.emplace_back(http::field::allow, "GET, HEAD");
    return refuse(reply);
  }
  if (!parser_->is_done()) return refuse(text_reply(413, "Nothing can be sent to this address."));
  Reply reply;
  reply.type = file.type;
  reply.cache = file.immutable ? "public, max-age=31536000, immutable" : "no-cache";
  reply.fields.emplace_back(http::field::etag, file.tag);
  if (file.gzipped) reply.fields.emplace_back(http::field::vary, "Accept-Encoding");
  if (field(http::field::if_none_match) == file.tag) {
    reply.status = 304;
    return respond(reply);
  }
  const bool packed = file.gzipped && accepts_gzip(field(http::field::accept_encoding));
  if (packed) reply.fields.emplace_back(http::field::content_encoding, "gzip");
  reply.body = packed ? file.gzipped : file.bytes;
  respond(reply);
}

void HttpSession::upgrade_to_page() {
  auto page = std::make_shared<PageSession>(Pages::next_id(), request_.client, std::move(stream_),
                                            std::move(*slot_), context_.settings, *context_.pages);
  page->accept(parser_->get(), response_context_);
}

void HttpSession::call_application() {
  large_body_.reset();
  context_.waiting[this] = shared_from_this();
  // The application may keep its callback longer than the server lives, so the callback holds no owner.
  auto deliver = [weak = weak_from_this()](WebResponse given) {
    if (const auto self = weak.lock()) self->on_application_response(std::move(given));
  };
  auto pending = std::make_shared<PendingResponse>(context_.executor, std::move(deliver));
  context_.application.requested(request_, [pending](WebResponse given) { pending->give(std::move(given)); });
  std::string().swap(request_.body);
}

void HttpSession::on_application_response(WebResponse given) {
  const auto self = shared_from_this();
  context_.waiting.erase(this);
  Reply reply;
  reply.status = given.status >= 200 && given.status <= 599 ? given.status : 500;
  reply.type = std::move(given.type);
  reply.body = std::move(given.body);
  if (!given.content_range.empty())
    reply.fields.emplace_back(http::field::content_range, std::move(given.content_range));
  if (given.immutable) reply.cache = "private, max-age=31536000, immutable";
  respond(reply);
}

void HttpSession::refuse(const Reply& reply) {
  if (!parser_->is_done()) response_context_.keep_alive = false;
  respond(reply);
}

void HttpSession::respond(const Reply& reply) {
  response_.emplace(make_response(reply, response_context_));
  // A client that reads too slowly is cut off.
  stream_.transport().expires_after(
      seconds(transfer_timeout(context_.settings.idle_timeout, SharedBody::size(response_->body()))));
  http::async_write(stream_, *response_,
                    beast::bind_front_handler(&HttpSession::on_responded, shared_from_this()));
}

void HttpSession::on_responded(error_code error, std::size_t /*bytes*/) {
  response_.reset();
  if (error) return;
  if (response_context_.keep_alive) return read_head();
  shut_down();
}

void HttpSession::shut_down() {
  error_code ignored;
  stream_.transport().socket().shutdown(tcp::socket::shutdown_send, ignored);
  if (ignored) return;
  stream_.transport().expires_after(kDrainTimeout);
  drain(kDrainLimit);
}

void HttpSession::drain(std::size_t bytes_left) {
  stream_.transport().async_read_some(
      net::buffer(read_buffer_), [self = shared_from_this(), bytes_left](error_code error, std::size_t n) {
        if (!error && n < bytes_left) self->drain(bytes_left - n);
      });
}

}  // namespace phalanx::web
