// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "serve/cockpit_parts.h"
#include "serve/plain_text.h"

namespace phalanx {
namespace {

/// A key that is held down says it thirty times a second: obeyed each time, told once.
constexpr double kStopToldEvery = 1.0;      ///< [s]
constexpr double kSlidersToldEvery = 10.0;  ///< [s]

}  // namespace

void Cockpit::Parts::obey(PageId page, const wire::ToHost& message) {
  switch (message.what_case()) {
    case wire::ToHost::kHello:
      return hello(page, message.hello());
    case wire::ToHost::kStop:
      stop(*seats.find(page));
      return reply(page, message.request(), "");
    case wire::ToHost::kSeen:
      return seen(page, message.seen().ticks());
    case wire::ToHost::kTake:
      take(page);
      return reply(page, message.request(), "");
    case wire::ToHost::kRelease:
      release(page);
      return reply(page, message.request(), "");
    case wire::ToHost::kName:
      seats.name(page, message.name().name());
      want_state();
      return reply(page, message.request(), "");
    default:
      break;
  }
  refuse_unless_operator(page);
  ask_host(page, message);
}

void Cockpit::Parts::hello(PageId page, const wire::Hello& hello) {
  if (greeted.contains(page)) return;
  if (hello.protocol() != kProtocol) return turn_away(page, hello.protocol());
  waiting.erase(page);
  const Seats::Return back = seats.come_back(page, hello.secret(), now());
  if (back.replaced != 0) give_way(back.replaced);
  if (!hello.name().empty()) seats.name(page, hello.name());
  if (back.sat_down)
    tell(wire::Notice::CHANGE, seats.find(page)->label(), "operator_taken", "operates: nobody else did");
  welcome(page);
  want_state();
}

/// Told by its code not to come back by itself: two that do would take the seat from each other for ever.
void Cockpit::Parts::give_way(PageId page) {
  constexpr const char* kWhy = "this page was opened again elsewhere";
  greeted.erase(page);
  tell_one(page, "replaced", kWhy);
  server->show_out(page, kWhy);
}

void Cockpit::Parts::seen(PageId page, std::uint64_t ticks) {
  const auto pace = greeted.find(page);
  if (pace == greeted.end()) return;
  pace->second.seen = std::clamp(ticks, pace->second.seen, pace->second.sent);
}

void Cockpit::Parts::stop(const Seat& seat) { stop(fmt::format("page {}", seat.number), seat.label()); }

void Cockpit::Parts::stop(const std::string& speaker, const std::string& who) {
  const bool held = host.held_stopped();  // if not, this one did something, whoever has resumed since
  host.stop();
  want_state();
  std::erase_if(stops_told, [&](const auto& told) { return now() - told.second >= kStopToldEvery; });
  if (held && stops_told.contains(speaker)) return;
  stops_told[speaker] = now();
  tell(wire::Notice::CHANGE, who, "stopped", "stopped the torque");
}

void Cockpit::Parts::take(PageId page) {
  if (seats.operates(page)) return;
  const std::string before = seats.take(page, now());
  tell(wire::Notice::CHANGE, seats.find(page)->label(), "operator_taken",
       before.empty() ? "took control" : fmt::format("took control from {}", before));
  want_state();
}

void Cockpit::Parts::release(PageId page) {
  if (!seats.release(page)) return;
  tell(wire::Notice::CHANGE, seats.find(page)->label(), "operator_left", "gave control back");
  want_state();
}

void Cockpit::Parts::refuse_unless_operator(PageId page) const {
  if (seats.operates(page)) return;
  const Seat* other = seats.operating(now());
  throw std::invalid_argument(other == nullptr
                                  ? "nobody operates; take control first"
                                  : fmt::format("{} operates; take control first", other->label()));
}

/// What the host does at once is told at once, in order with the stops; the rest once its owner has done it.
void Cockpit::Parts::ask_host(PageId page, const wire::ToHost& message) {
  const std::uint32_t number = message.request();
  const std::string who = seats.find(page)->label();
  const auto asked = std::make_shared<PageRequest>();
  // The host may answer when the cockpit is no more.
  const auto done = [weak = weak_from_this(), page, number, who, asked](const ChangeOutcome& outcome) {
    const auto parts = weak.lock();
    if (!parts || parts->server == nullptr) return;
    parts->server->post([weak, page, number, who, asked, outcome] {
      if (const auto still = weak.lock()) still->answered(page, number, who, *asked, outcome);
    });
  };
  *asked = hand_over(message, host, choices, settings.uploads, done);
  if (asked->at_once) answered(page, number, who, *asked, {});
}

void Cockpit::Parts::answered(PageId page, std::uint32_t number, const std::string& who,
                              const PageRequest& asked, const ChangeOutcome& outcome) {
  const std::string refused = for_pages(outcome.refused);
  reply(page, number, refused);
  if (outcome.overtaken) return;  // it was no change; the newer one is told
  if (!refused.empty()) {
    tell(wire::Notice::WARNING, who, "refused", refused);
  } else if (!is_told(page, asked)) {
    return;
  } else if (asked.dragging) {
    hold(page, who, asked);
  } else {
    if (continues_drag(page, asked)) drag.reset();
    tell(wire::Notice::CHANGE, who, asked.code, asked.text);
  }
  want_state();
}

bool Cockpit::Parts::continues_drag(PageId page, const PageRequest& asked) const {
  return drag && drag->page == page && drag->newest.keys == asked.keys;
}

void Cockpit::Parts::hold(PageId page, const std::string& who, const PageRequest& asked) {
  if (!continues_drag(page, asked)) {
    tell_drag();
    drag = Drag{.page = page, .who = who, .newest = {}, .since = now()};
  }
  drag->newest = asked;
}

/// Sliders say it thirty times a second.
bool Cockpit::Parts::is_told(PageId page, const PageRequest& asked) {
  if (asked.code != "sliders") return true;
  const Seat* seat = seats.find(page);
  if (seat == nullptr) return false;
  const auto told = sliders_told.find(seat->number);
  if (told != sliders_told.end() && now() - told->second < kSlidersToldEvery) return false;
  sliders_told[seat->number] = now();
  return true;
}

void Cockpit::Parts::fault_reported(const std::string& file, double fault_time) {
  report = file;
  reported = fault_time;
  want_state();
}

}  // namespace phalanx
