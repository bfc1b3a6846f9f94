// SPDX-License-Identifier: Apache-2.0
#include "serve/web/pages.h"

#include <atomic>
#include <utility>

#include "serve/web/session/page_session.h"

namespace phalanx::web {

Pages::Pages(net::io_context& io, double frame_rate_hz, WebApplication& application)
    : io_(io), application_(application), timer_(io), period_(seconds(1.0 / frame_rate_hz)) {}

PageId Pages::next_id() noexcept {
  static std::atomic<PageId> last{0};
  return ++last;
}

void Pages::add(const std::shared_ptr<PageSession>& page) {
  pages_.emplace(page->id(), page);
  application_.joined(page->id(), page->client());
  if (std::exchange(timer_runs_, true)) return;
  timer_.expires_after(period_);
  await_frame();
}

void Pages::received(PageId page, std::string_view message) {
  if (pages_.contains(page)) application_.received(page, message);
}

void Pages::received_over_limit(PageId page, std::string_view message) {
  if (pages_.contains(page)) application_.received_over_limit(page, message);
}

void Pages::remove(PageId page) {
  closing_.erase(page);
  if (pages_.erase(page) > 0) notify_left(page);
}

void Pages::notify_left(PageId page) {
  // Posted, because the application may iterate over its pages now.
  net::post(io_, [this, page] { application_.left(page); });
}

void Pages::send(PageId page, Bytes message) {
  const auto found = pages_.find(page);
  if (found == pages_.end() || !message || found->second->send(std::move(message))) return;
  disconnect(page, websocket::close_code::policy_error, "this page does not read fast enough", true);
}

bool Pages::send_newest(PageId page, Bytes message, std::size_t kind) {
  const auto found = pages_.find(page);
  return found != pages_.end() && message && found->second->send_newest(std::move(message), kind);
}

void Pages::disconnect(PageId page, websocket::close_code code, const std::string& reason, bool drop_queue) {
  auto node = pages_.extract(page);
  if (node.empty()) return;
  const std::shared_ptr<PageSession> session = node.mapped();
  closing_.insert(std::move(node));
  notify_left(page);
  session->begin_close(code, reason, drop_queue);
}

void Pages::disconnect_all(websocket::close_code code, const std::string& reason) {
  while (!pages_.empty()) disconnect(pages_.begin()->first, code, reason, false);
}

void Pages::await_frame() {
  timer_.async_wait([this](error_code error) { on_frame(error); });
}

void Pages::on_frame(error_code error) {
  timer_runs_ = !error && !empty();
  if (!timer_runs_) return;
  // Starts the wait for the next frame first, so that an exception in this one cannot end the frames. Missed
  // frames are skipped.
  const Clock::time_point now = Clock::now();
  const Clock::time_point due = timer_.expiry() + period_;
  timer_.expires_at(due > now ? due : now + period_);
  await_frame();
  if (!pages_.empty()) application_.frame();
  for (const auto& [id, page] : pages_) page->check_timeouts(now);
  for (const auto& [id, page] : closing_) page->check_timeouts(now);
}

}  // namespace phalanx::web
