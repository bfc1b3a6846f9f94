// SPDX-License-Identifier: Apache-2.0
#include "serve/web/page_session.h"

#include <algorithm>
#include <utility>

#include "serve/web/pages.h"

namespace phalanx::web {
namespace {

constexpr auto kOthersGoodbye = std::chrono::seconds(2);  // for the other end to say it, too
constexpr std::size_t kLongestReason = 123;               // of a close frame [bytes]

// What a page has said in one go lies in buffers when its limit is passed; longer than a machine stands
// still.
constexpr auto kLastWords = std::chrono::seconds(2);
constexpr std::size_t kMostLastWords = 64 * 1024;  // [bytes]
constexpr std::size_t kFrameHead = 6;              // at least [bytes]

// Frames that never end a message count as none: a page's bytes are bounded, too, by reading them no faster.
constexpr std::size_t kMostRead = 1'000'000;  // [bytes/s]

websocket::stream_base::timeout timeouts(const WebServerSettings& settings) {
  return {seconds(settings.request_timeout), seconds(settings.idle_timeout), true};
}

}  // namespace

PageSession::PageSession(PageId id, Visitor visitor, Line&& line, Place place,
                         const WebServerSettings& settings, Pages& pages)
    : id_(id),
      visitor_(std::move(visitor)),
      socket_(std::move(line)),
      place_(std::move(place)),
      settings_(settings),
      pages_(pages),
      rate_(settings.messages_per_second),
      queue_(settings.queue_limit, settings.queue_bytes) {
  // The socket's own limits take over.
  socket_.next_layer().transport().expires_never();
  socket_.next_layer().transport().rate_policy().read_limit(kMostRead);
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
  pages_.admit(shared_from_this());
  read();
}

void PageSession::on_read(error_code error, std::size_t bytes) {
  if (error) {
    // What the goodbye still does ends it; otherwise it is gone.
    if (!closing_) cut();
    pages_.ended(id_);
    return;
  }
  if (leaving_) return;
  if (!socket_.got_binary()) {
    pages_.show_out(id_, websocket::close_code::unknown_data, "messages are binary here", true);
  } else {
    const std::string_view message(static_cast<const char*>(message_.data().data()), bytes);
    if (heard_until_ || !rate_.allows_one(Clock::now())) {
      hear_last_words(message);
    } else {
      pages_.received(id_, message);
    }
  }
  message_.consume(message_.size());
  if (!leaving_) read();
}

void PageSession::hear_last_words(std::string_view message) {
  if (!heard_until_) heard_until_ = Clock::now() + kLastWords;
  last_words_ += message.size() + kFrameHead;
  pages_.received_too_much(id_, message);
  if (last_words_ > kMostLastWords) show_out_for_too_much();
}

void PageSession::show_out_for_too_much() {
  pages_.show_out(id_, websocket::close_code::policy_error, "too many messages in a second", true);
}

void PageSession::count_control_frame(websocket::frame_type kind) {
  if (leaving_ || kind == websocket::frame_type::close) return;
  if (heard_until_) {
    last_words_ += kFrameHead;
    if (last_words_ > kMostLastWords) heard_until_ = Clock::now();
  } else if (!rate_.allows_one(Clock::now())) {
    heard_until_ = Clock::now() + kLastWords;
  }
}

bool PageSession::send(Bytes message) {
  if (!queue_.push(std::move(message))) return false;
  pump();
  return true;
}

bool PageSession::send_newest(Bytes message) {
  const bool replaced = queue_.put_newest(std::move(message));
  pump();
  return replaced;
}

void PageSession::leave(websocket::close_code code, const std::string& reason, bool at_once) {
  if (leaving_) return;
  leaving_ = true;
  out_by_ = Clock::now() + kOthersGoodbye;
  goodbye_ = websocket::close_reason(code, reason.substr(0, kLongestReason));
  if (at_once) queue_.clear();
  pump();
}

void PageSession::check(Clock::time_point now) {
  if (!leaving_ && heard_until_ && now > *heard_until_) {
    // Not from within the round that this is a part of.
    net::post(socket_.get_executor(), [self = shared_from_this()] { self->show_out_for_too_much(); });
  }
  if (!leaving_ && !socket_.is_open()) {
    // It broke the protocol, or said goodbye itself: it has as long to end as one that is shown out.
    leaving_ = true;
    closing_ = true;
    out_by_ = now + kOthersGoodbye;
  }
  const bool stuck = in_flight_ && now - written_since_ > seconds(settings_.idle_timeout);
  if (stuck || (leaving_ && now > out_by_)) cut();
}

void PageSession::pump() {
  if (in_flight_ || closing_) return;
  in_flight_ = queue_.take();
  if (in_flight_) {
    written_since_ = Clock::now();
    socket_.async_write(net::buffer(*in_flight_),
                        beast::bind_front_handler(&PageSession::on_written, shared_from_this()));
  } else if (leaving_) {
    closing_ = true;
    close();
  }
}

void PageSession::on_written(error_code error, std::size_t /*bytes*/) {
  in_flight_ = nullptr;
  if (error) {
    cut();
    pages_.ended(id_);
    return;
  }
  pump();
}

void PageSession::cut() { socket_.next_layer().transport().close(); }

}  // namespace phalanx::web
