// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "record/plain_text.h"
#include "serve/cockpit_impl.h"

namespace phalanx {
namespace {

// A key that is held down repeats its stop thirty times a second: each one is applied, one a
// second is logged.
constexpr double kStopInterval = 1.0;      ///< [s]
constexpr double kSlidersInterval = 10.0;  ///< [s]

/// @returns true for a message that the patient's screen may send
bool of_patient_screen(wire::ToHost::WhatCase what) noexcept {
  return what == wire::ToHost::kHello || what == wire::ToHost::kStop || what == wire::ToHost::kFeel ||
         what == wire::ToHost::kSeen;
}

}  // namespace

void Cockpit::Impl::handle(PageId page, const wire::ToHost& message) {
  if (participants.find(page)->patient_screen && !of_patient_screen(message.what_case()))
    throw std::invalid_argument(
        "this is the patient's screen: it can only stop, and report how the patient feels");
  switch (message.what_case()) {
    case wire::ToHost::kHello:
      return hello(page, message.hello());
    case wire::ToHost::kStop:
      stop(*participants.find(page));
      return reply(page, message.request(), "");
    case wire::ToHost::kFeel:
      feel(page, message.feel());
      return reply(page, message.request(), "");
    case wire::ToHost::kSeen:
      return acknowledge(page, message.seen().ticks());
    case wire::ToHost::kTake:
      take_control(page);
      return reply(page, message.request(), "");
    case wire::ToHost::kRelease:
      release_control(page);
      return reply(page, message.request(), "");
    case wire::ToHost::kName:
      participants.name(page, message.name().name());
      request_state();
      return reply(page, message.request(), "");
    default:
      break;
  }
  refuse_unless_operator(page);
  refuse_during_exercise(message);
  pass_to_session(page, message);
}

void Cockpit::Impl::hello(PageId page, const wire::Hello& hello) {
  if (greeted.contains(page)) return;
  if (hello.protocol() != kProtocol) return refuse_protocol(page, hello.protocol());
  awaiting_hello.erase(page);
  const Participants::Reconnection reconnection =
      participants.reconnect(page, hello.secret(), now(), hello.patient_screen());
  if (reconnection.replaced != 0) disconnect_replaced(reconnection.replaced);
  if (!hello.name().empty()) participants.name(page, hello.name());
  if (reconnection.became_operator)
    notify(wire::Notice::CHANGE, participants.find(page)->label(), "operator_taken",
           "operates: there was no operator");
  send_welcome(page);
  if (!hello.patient_screen() && holds_without_host(session.info()->device))
    notify_page(page, "no_watchdog", kHoldsWithoutHost);
  request_state();
}

// The code of the notice tells the page not to reconnect by itself: two pages would replace each
// other for ever.
void Cockpit::Impl::disconnect_replaced(PageId page) {
  constexpr const char* kWhy = "this page was opened again elsewhere";
  greeted.erase(page);
  notify_page(page, "replaced", kWhy);
  server->disconnect(page, kWhy);
}

void Cockpit::Impl::acknowledge(PageId page, std::uint64_t ticks) {
  const auto window = greeted.find(page);
  if (window == greeted.end()) return;
  window->second.acknowledged = std::clamp(ticks, window->second.acknowledged, window->second.sent);
}

void Cockpit::Impl::stop(const Participant& participant) {
  stop(fmt::format("page {}", participant.number), participant.label());
}

void Cockpit::Impl::stop(const std::string& source, const std::string& who) {
  const bool held = session.held_stopped();  // if not, this stop has an effect and is logged in any case
  session.stop();
  request_state();
  std::erase_if(stops_notified, [&](const auto& entry) { return now() - entry.second >= kStopInterval; });
  if (held && stops_notified.contains(source)) return;
  stops_notified[source] = now();
  notify(wire::Notice::CHANGE, who, "stopped", "stopped the torque");
}

void Cockpit::Impl::take_control(PageId page) {
  if (participants.operates(page)) return;
  const std::string before = participants.take_control(page, now());
  notify(wire::Notice::CHANGE, participants.find(page)->label(), "operator_taken",
         before.empty() ? "took control" : fmt::format("took control from {}", before));
  request_state();
}

void Cockpit::Impl::release_control(PageId page) {
  if (!participants.release_control(page)) return;
  notify(wire::Notice::CHANGE, participants.find(page)->label(), "operator_left", "gave control back");
  request_state();
}

void Cockpit::Impl::refuse_unless_operator(PageId page) const {
  if (participants.operates(page)) return;
  const Participant* other = participants.current_operator(now());
  throw std::invalid_argument(other == nullptr
                                  ? "there is no operator; take control first"
                                  : fmt::format("{} operates; take control first", other->label()));
}

// Requests that are done at once are logged at once, in order with the stops. The others are logged when the
// station has applied them.
void Cockpit::Impl::pass_to_session(PageId page, const wire::ToHost& message) {
  const std::uint32_t number = message.request();
  const std::string who = participants.find(page)->label();
  const auto request = std::make_shared<PageRequest>();
  // The session may answer after the cockpit has been destroyed.
  const auto done = [weak = weak_from_this(), page, number, who, request](const ChangeOutcome& outcome) {
    const auto impl = weak.lock();
    if (!impl || impl->server == nullptr) return;
    impl->server->post([weak, page, number, who, request, outcome] {
      if (const auto still = weak.lock()) still->on_outcome(page, number, who, *request, outcome);
    });
  };
  *request = apply_request(message, session, choices, settings.uploads, done);
  if (request->done_at_once) on_outcome(page, number, who, *request, {});
}

void Cockpit::Impl::on_outcome(PageId page, std::uint32_t number, const std::string& who,
                               const PageRequest& request, const ChangeOutcome& outcome) {
  const std::string refused = for_pages(outcome.refused);
  reply(page, number, refused);
  if (outcome.overtaken) return;  // only the newer value is a change
  if (!refused.empty()) {
    notify(wire::Notice::WARNING, who, "refused", refused);
  } else if (!notice_is_due(page, request)) {
    return;
  } else if (request.dragging) {
    hold_back(page, who, request);
  } else {
    if (continues_drag(page, request)) drag.reset();
    notify(wire::Notice::CHANGE, who, request.code, request.text);
  }
  request_state();
}

bool Cockpit::Impl::continues_drag(PageId page, const PageRequest& request) const {
  return drag && drag->page == page && drag->newest.keys == request.keys;
}

void Cockpit::Impl::hold_back(PageId page, const std::string& who, const PageRequest& request) {
  if (!continues_drag(page, request)) {
    notify_drag();
    drag = Drag{.page = page, .who = who, .newest = {}, .since = now()};
  }
  drag->newest = request;
}

// Sliders are sent thirty times a second.
bool Cockpit::Impl::notice_is_due(PageId page, const PageRequest& request) {
  if (request.code != "sliders") return true;
  const Participant* participant = participants.find(page);
  if (participant == nullptr) return false;
  const auto last = sliders_notified.find(participant->number);
  if (last != sliders_notified.end() && now() - last->second < kSlidersInterval) return false;
  sliders_notified[participant->number] = now();
  return true;
}

void Cockpit::Impl::fault_reported(const std::string& file, double fault_time) {
  report = file;
  reported = fault_time;
  station_files->set_report(file);
  request_state();
}

}  // namespace phalanx
