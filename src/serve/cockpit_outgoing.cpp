// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "serve/cockpit_parts.h"
#include "serve/plain_text.h"
#include "serve/state_message.h"
#include "serve/tick_message.h"

namespace phalanx {
namespace {

constexpr double kStateEvery = 0.5;         ///< at least [s]
constexpr double kStateWithin = 0.05;       ///< at most [s]
constexpr double kHelloWithin = 10.0;       ///< [s]
constexpr double kDragToldEvery = 10.0;     ///< [s]
constexpr std::size_t kErrorLength = 4000;  ///< [bytes]

double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

Bytes encoded(const wire::ToPage& message) {
  return std::make_shared<const std::string>(message.SerializeAsString());
}

}  // namespace

wire::Notice notice_of(wire::Notice::Level level, const std::string& who, const std::string& code,
                       const std::string& text) {
  wire::Notice notice;
  notice.set_level(level);
  notice.set_unix_time(unix_now());
  notice.set_who(as_utf8(who));
  notice.set_code(code);
  notice.set_text(as_utf8(text));
  return notice;
}

void Cockpit::Parts::to_all(const Bytes& bytes) {
  for (const auto& [page, pace] : greeted) server->send(page, bytes);
}

void Cockpit::Parts::tell(wire::Notice::Level level, const std::string& who, const std::string& code,
                          const std::string& text) {
  tell_drag();
  log.add(notice_of(level, who, code, text));
  wire::ToPage message;
  *message.mutable_notice() = log.newest().back();
  to_all(encoded(message));
}

void Cockpit::Parts::tell_drag() {
  const std::optional<Drag> ended = std::exchange(drag, std::nullopt);
  if (ended) tell(wire::Notice::CHANGE, ended->who, ended->newest.code, ended->newest.text);
}

/// A page that never says that the drag has ended hides nothing.
void Cockpit::Parts::tell_drag_if_due() {
  if (drag && now() - drag->since >= kDragToldEvery) tell_drag();
}

void Cockpit::Parts::give_control_to_only_page() {
  const Seat* seat = seats.give_to_only_page(now());
  if (seat == nullptr) return;
  tell(wire::Notice::CHANGE, seat->label(), "operator_taken", "operates: no other page does");
  want_state();
}

/// Told again only when it could be written in between.
void Cockpit::Parts::tell_if_log_breaks() {
  const bool broken = log.broken();
  if (std::exchange(log_broken, broken) || !broken) return;
  tell(wire::Notice::WARNING, "", "log_broken",
       "the log of changes cannot be written: is the disk full? The station goes on; when it can be written "
       "again, it says what is missing");
}

void Cockpit::Parts::tell_one(PageId page, const std::string& code, const std::string& text) {
  wire::ToPage message;
  *message.mutable_notice() = notice_of(wire::Notice::WARNING, "", code, text);
  server->send(page, encoded(message));
}

void Cockpit::Parts::reply(PageId page, std::uint32_t request, const std::string& refused) {
  if (request == 0) return;
  wire::ToPage message;
  message.mutable_reply()->set_request(request);
  message.mutable_reply()->set_ok(refused.empty());
  message.mutable_reply()->set_error(shortened(as_utf8(refused), kErrorLength));
  server->send(page, encoded(message));
}

std::string Cockpit::Parts::for_pages(const std::string& text) const {
  return without_option(without_folder(text, shipped));
}

void Cockpit::Parts::welcome(PageId page) {
  const Seat& seat = *seats.find(page);
  wire::ToPage message;
  wire::Welcome& welcome = *message.mutable_welcome();
  welcome = choices;
  welcome.set_page(seat.number);
  welcome.set_secret(seat.secret);
  welcome.set_may_operate(seat.visitor.may_operate);
  welcome.set_clock(host.now());
  welcome.set_unix_time(unix_now());
  if (seat.visitor.may_operate)
    for (const std::string& url : viewer_urls) welcome.add_viewer_url(url);
  for (const wire::Notice& notice : log.newest()) *welcome.add_past() = notice;
  server->send(page, encoded(message));
  greeted[page] = {};
  server->send(page, state_now());
}

/// The number alone says why: a page of another protocol may not understand the rest of a Welcome.
void Cockpit::Parts::turn_away(PageId page, std::uint32_t protocol) {
  wire::ToPage message;
  message.mutable_welcome()->set_protocol(kProtocol);
  message.mutable_welcome()->set_version(settings.version);
  server->send(page, encoded(message));
  server->show_out(page, fmt::format("this page speaks protocol {}, the station {}: reload the page",
                                     protocol, kProtocol));
}

Bytes Cockpit::Parts::state_now() {
  wire::ToPage message;
  wire::State& state = *message.mutable_state();
  write_state(host, state);
  state.set_trouble(for_pages(state.trouble()));
  if (state.has_fault() && state.fault().time() == reported)
    state.mutable_fault()->set_report(as_utf8(report));
  write_seats(seats, now(), state);
  return encoded(message);
}

void Cockpit::Parts::send_state_if_due() {
  // Read before what is sent: what changes meanwhile is sent once more.
  const std::uint64_t revision = host.state()->revision;
  const SafetyState safety = host.view().state;
  const bool changed = state_wanted || revision != told_revision || safety != told_safety;
  const double since = now() - state_sent;
  if (since < kStateWithin || (!changed && since < kStateEvery)) return;
  state_wanted = false;
  state_sent = now();
  told_revision = revision;
  told_safety = safety;
  to_all(state_now());
}

void Cockpit::Parts::send_tick() {
  const StationView view = host.view();
  // A station that has not heard of the hand yet has none to show.
  if (view.snapshot.tick == 0) return;
  Bytes bytes;
  for (auto& [page, pace] : greeted) {
    if (pace.newest == view.time || !pace.keeps_up()) continue;
    if (!bytes) {
      wire::ToPage message;
      write_tick(view, *message.mutable_tick());
      bytes = encoded(message);
    }
    pace.newest = view.time;
    // One that is replaced never gets there, so that the page cannot count it.
    if (!server->send_newest(page, bytes)) ++pace.sent;
  }
}

void Cockpit::Parts::show_out_the_silent() {
  for (auto it = waiting.begin(); it != waiting.end();) {
    const PageId page = it->first;
    const bool late = now() - it->second > kHelloWithin;
    it = late ? waiting.erase(it) : std::next(it);
    if (late) server->show_out(page, "no hello came");
  }
}

}  // namespace phalanx
