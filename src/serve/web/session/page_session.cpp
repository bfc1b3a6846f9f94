// SPDX-License-Identifier: Apache-2.0
#include "serve/web/session/page_session.h"

#include <algorithm>
#include <utility>

#include "serve/web/pages.h"

namespace phalanx::web {
namespace {

constexpr auto kCloseTimeout = std::chrono::seconds(2);  // for the page's close frame
constexpr std::size_t kLongestReason = 123;              // of a close frame [bytes]

// When a page exceeds its rate limit, messages of the same burst lie in buffers. They are still received, for
// longer than a machine is likely to stall and up to this length.
constexpr auto kOverLimitTime = std::chrono::seconds(2);
constexpr std::size_t kOverLimitBytes = 64 * 1024;  // [bytes]
constexpr std::size_t kFrameHead = 6;               // at least [bytes]

// Limits the bytes of a page, too: the frames of a message that never ends do not count as messages.
constexpr std::size_t kReadRate = 1'000'000;  // [bytes/s]

websocket::stream_base::timeout timeouts(const WebServerSettings& settings) {
  return {seconds(settings.request_timeout), seconds(settings.idle_timeout), true};
}

}  // namespace

PageSession::PageSession(PageId id, ClientInfo client, Stream&& stream, CountedSlot slot,
                         const WebServerSettings& settings, Pages& pages)
    : id_(id),
      client_(std::move(client)),
      socket_(std::move(stream)),
      slot_(std::move(slot)),
      settings_(settings),
      pages_(pages),
      rate_(settings.messages_per_second),
      queue_(settings.queue_limit, settings.queue_bytes) {
  // From here on the timeouts of the WebSocket stream apply.
  socket_.next_layer().transport().expires_never();
  socket_.next_layer().transport().rate_policy().read_limit(kReadRate);
  socket_.set_option(timeouts(settings));
  socket_.read_message_max(settings.message_limit);
  socket_.auto_fragment(false);
  socket_.binary(true);
  socket_.control_callback(
      [this](websocket::frame_type kind, std::string_view) { count_control_frame(kind); });
}

PageSession::~PageSession() = default;

void PageSession::on_accepted(error_code error) {
  if (error) return;
  pages_.add(shared_from_this());
  read();
}

void PageSession::on_read(error_code error, std::size_t bytes) {
  if (error) {
    // While close() runs, its handler aborts the connection.
    if (!close_sent_) abort();
    pages_.remove(id_);
    return;
  }
  if (closing_) return;
  if (!socket_.got_binary()) {
    pages_.disconnect(id_, websocket::close_code::unknown_data, "messages must be binary", true);
  } else {
    const std::string_view message(static_cast<const char*>(message_.data().data()), bytes);
    if (over_limit_until_ || !rate_.allow(Clock::now())) {
      receive_over_limit(message);
    } else {
      pages_.received(id_, message);
    }
  }
  message_.consume(message_.size());
  if (!closing_) read();
}

void PageSession::receive_over_limit(std::string_view message) {
  if (!over_limit_until_) over_limit_until_ = Clock::now() + kOverLimitTime;
  over_limit_bytes_ += message.size() + kFrameHead;
  pages_.received_over_limit(id_, message);
  if (over_limit_bytes_ > kOverLimitBytes) close_over_limit();
}

void PageSession::close_over_limit() {
  pages_.disconnect(id_, websocket::close_code::policy_error, "too many messages in a second", true);
}

void PageSession::count_control_frame(websocket::frame_type kind) {
  if (closing_ || kind == websocket::frame_type::close) return;
  if (over_limit_until_) {
    over_limit_bytes_ += kFrameHead;
    if (over_limit_bytes_ > kOverLimitBytes) over_limit_until_ = Clock::now();
  } else if (!rate_.allow(Clock::now())) {
    over_limit_until_ = Clock::now() + kOverLimitTime;
  }
}

bool PageSession::send(Bytes message) {
  if (!queue_.push(std::move(message))) return false;
  write_next();
  return true;
}

bool PageSession::send_newest(Bytes message, std::size_t kind) {
  const bool replaced = queue_.set_newest(std::move(message), kind);
  write_next();
  return replaced;
}

void PageSession::begin_close(websocket::close_code code, const std::string& reason, bool drop_queue) {
  if (closing_) return;
  closing_ = true;
  close_deadline_ = Clock::now() + kCloseTimeout;
  close_reason_ = websocket::close_reason(code, reason.substr(0, kLongestReason));
  if (drop_queue) queue_.clear();
  write_next();
}

void PageSession::check_timeouts(Clock::time_point now) {
  if (!closing_ && over_limit_until_ && now > *over_limit_until_) {
    // Posted, because Pages iterates over its sessions now.
    net::post(socket_.get_executor(), [self = shared_from_this()] { self->close_over_limit(); });
  }
  if (!closing_ && !socket_.is_open()) {
    // The page has violated the protocol or sent a close frame. It has as long to close
    // as after begin_close().
    closing_ = true;
    close_sent_ = true;
    close_deadline_ = now + kCloseTimeout;
  }
  const bool stuck = in_flight_ && now - written_since_ > seconds(settings_.idle_timeout);
  if (stuck || (closing_ && now > close_deadline_)) abort();
}

void PageSession::write_next() {
  if (in_flight_ || close_sent_) return;
  in_flight_ = queue_.pop();
  if (in_flight_) {
    written_since_ = Clock::now();
    socket_.async_write(net::buffer(*in_flight_),
                        beast::bind_front_handler(&PageSession::on_written, shared_from_this()));
  } else if (closing_) {
    close_sent_ = true;
    close();
  }
}

void PageSession::on_written(error_code error, std::size_t /*bytes*/) {
  in_flight_ = nullptr;
  if (error) {
    abort();
    pages_.remove(id_);
    return;
  }
  write_next();
}

void PageSession::abort() { socket_.next_layer().transport().close(); }

}  // namespace phalanx::web
