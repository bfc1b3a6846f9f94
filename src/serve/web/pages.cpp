// SPDX-License-Identifier: Apache-2.0
#include "serve/web/pages.h"

#include <atomic>
#include <utility>

#include "serve/web/page_session.h"

namespace phalanx::web {

Pages::Pages(net::io_context& thread, double frame_rate_hz, WebApplication& application)
    : thread_(thread), application_(application), timer_(thread), period_(seconds(1.0 / frame_rate_hz)) {}

PageId Pages::next_id() noexcept {
  static std::atomic<PageId> last{0};
  return ++last;
}

void Pages::admit(const std::shared_ptr<PageSession>& page) {
  pages_.emplace(page->id(), page);
  application_.joined(page->id(), page->visitor());
  if (std::exchange(frames_, true)) return;
  timer_.expires_after(period_);
  await_frame();
}

void Pages::received(PageId page, std::string_view message) {
  if (pages_.contains(page)) application_.received(page, message);
}

void Pages::received_too_much(PageId page, std::string_view last) {
  if (pages_.contains(page)) application_.received_too_much(page, last);
}

void Pages::ended(PageId page) {
  leaving_.erase(page);
  if (pages_.erase(page) > 0) tell_left(page);
}

void Pages::tell_left(PageId page) {
  // In a turn of its own: the application may be in the middle of talking to all pages.
  net::post(thread_, [this, page] { application_.left(page); });
}

void Pages::send(PageId page, Bytes message) {
  const auto found = pages_.find(page);
  if (found == pages_.end() || !message || found->second->send(std::move(message))) return;
  show_out(page, websocket::close_code::policy_error, "this page does not read fast enough", true);
}

bool Pages::send_newest(PageId page, Bytes message) {
  const auto found = pages_.find(page);
  return found != pages_.end() && message && found->second->send_newest(std::move(message));
}

void Pages::show_out(PageId page, websocket::close_code code, const std::string& reason, bool at_once) {
  auto node = pages_.extract(page);
  if (node.empty()) return;
  const std::shared_ptr<PageSession> session = node.mapped();
  leaving_.insert(std::move(node));
  tell_left(page);
  session->leave(code, reason, at_once);
}

void Pages::show_out_all(websocket::close_code code, const std::string& reason) {
  while (!pages_.empty()) show_out(pages_.begin()->first, code, reason, false);
}

void Pages::clear() noexcept {
  pages_.clear();
  leaving_.clear();
}

void Pages::await_frame() {
  timer_.async_wait([this](error_code error) { on_frame(error); });
}

void Pages::on_frame(error_code error) {
  frames_ = !error && !empty();
  if (!frames_) return;
  // The next one first, so that nothing that happens in this one can be the end of them; those that are
  // missed are not made up for.
  const Clock::time_point now = Clock::now();
  const Clock::time_point due = timer_.expiry() + period_;
  timer_.expires_at(due > now ? due : now + period_);
  await_frame();
  if (!pages_.empty()) application_.frame();
  for (const auto& [id, page] : pages_) page->check(now);
  for (const auto& [id, page] : leaving_) page->check(now);
}

}  // namespace phalanx::web
