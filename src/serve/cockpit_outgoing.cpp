// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/step/haptic_step.h"
#include "record/plain_text.h"
#include "record/recording/view_message.h"
#include "serve/cockpit_impl.h"
#include "serve/exercise_message.h"
#include "serve/state_message.h"

namespace phalanx {
namespace {

constexpr double kLongestStateInterval = 0.5;    ///< between two states [s]
constexpr double kShortestStateInterval = 0.05;  ///< between two states [s]
constexpr double kHelloTimeout = 10.0;           ///< [s]
constexpr double kDragInterval = 10.0;           ///< [s]
constexpr std::size_t kErrorLength = 4000;       ///< [bytes]

double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

Bytes encoded(const wire::ToPage& message) {
  return std::make_shared<const std::string>(message.SerializeAsString());
}

/// @returns a state for the patient's screen
wire::ToPage for_patient(const wire::ToPage& state) {
  wire::ToPage message;
  write_patient_state(state.state(), *message.mutable_state());
  return message;
}

void write_recording(const RecordingStatus& recording, wire::Recording& out) {
  out.set_file(as_utf8(recording.file.string()));
  out.set_bytes(recording.bytes);
  out.set_free_bytes(recording.free_bytes);
  out.set_unsaved(recording.unsaved);
  out.set_lost_steps(recording.lost_steps);
  out.set_trouble(as_utf8(recording.trouble));
}

}  // namespace

wire::Notice make_notice(wire::Notice::Level level, const std::string& who, const std::string& code,
                         const std::string& text) {
  wire::Notice notice;
  notice.set_level(level);
  notice.set_unix_time(unix_now());
  notice.set_who(as_utf8(who));
  notice.set_code(code);
  notice.set_text(as_utf8(text));
  return notice;
}

void Cockpit::Impl::send_notice(const Bytes& bytes) {
  for (const auto& [page, window] : greeted)
    if (!window.of_patient) server->send(page, bytes);
}

void Cockpit::Impl::notify(wire::Notice::Level level, const std::string& who, const std::string& code,
                           const std::string& text) {
  notify_drag();
  log.add(make_notice(level, who, code, text));
  if (settings.on_notice) settings.on_notice(code, who, text);
  wire::ToPage message;
  *message.mutable_notice() = log.newest().back();
  send_notice(encoded(message));
}

void Cockpit::Impl::notify_drag() {
  const std::optional<Drag> ended = std::exchange(drag, std::nullopt);
  if (ended) notify(wire::Notice::CHANGE, ended->who, ended->newest.code, ended->newest.text);
}

// Logs a drag also if the page never reports its end.
void Cockpit::Impl::notify_drag_if_due() {
  if (drag && now() - drag->since >= kDragInterval) notify_drag();
}

void Cockpit::Impl::give_control_to_only_page() {
  const Participant* participant = participants.give_to_only_page(now());
  if (participant == nullptr) return;
  notify(wire::Notice::CHANGE, participant->label(), "operator_taken",
         "operates: it is the only page that may");
  request_state();
}

// Notifies again only after the log could be written in between.
void Cockpit::Impl::notify_if_log_breaks() {
  const bool broken = log.broken();
  if (std::exchange(log_broken, broken) || !broken) return;
  notify(wire::Notice::WARNING, "", "log_broken",
         "the log of changes cannot be written: is the disk full? The station goes on. When the log can be "
         "written again, it names the missing lines");
}

void Cockpit::Impl::notify_page(PageId page, const std::string& code, const std::string& text) {
  wire::ToPage message;
  *message.mutable_notice() = make_notice(wire::Notice::WARNING, "", code, text);
  server->send(page, encoded(message));
}

void Cockpit::Impl::reply(PageId page, std::uint32_t request, const std::string& refused) {
  if (request == 0) return;
  wire::ToPage message;
  message.mutable_reply()->set_request(request);
  message.mutable_reply()->set_ok(refused.empty());
  message.mutable_reply()->set_error(shortened(as_utf8(refused), kErrorLength));
  server->send(page, encoded(message));
}

std::string Cockpit::Impl::for_pages(const std::string& text) const {
  return without_option(without_folder(text, shipped));
}

void Cockpit::Impl::send_welcome(PageId page) {
  const Participant& participant = *participants.find(page);
  wire::ToPage message;
  wire::Welcome& welcome = *message.mutable_welcome();
  if (participant.patient_screen) {
    welcome.set_protocol(kProtocol);
    welcome.set_version(settings.version);
  } else {
    welcome = choices;
    welcome.set_may_operate(participant.client.may_operate);
    if (participant.client.may_operate)
      for (const std::string& url : viewer_urls) welcome.add_viewer_url(url);
    for (const wire::Notice& notice : log.newest()) *welcome.add_past() = notice;
  }
  welcome.set_page(participant.number);
  welcome.set_secret(participant.secret);
  welcome.set_clock(session.now());
  welcome.set_unix_time(unix_now());
  server->send(page, encoded(message));
  greeted[page] = {.of_patient = participant.patient_screen, .may_operate = participant.client.may_operate};
  look_at_exercise();
  const wire::ToPage state = present_state();
  server->send(page, encoded(gets_patient_state(greeted[page]) ? for_patient(state) : state));
  send_present_exercise(page);
}

// Sends only the number and the version: a page of another protocol may not understand the rest of a Welcome.
void Cockpit::Impl::refuse_protocol(PageId page, std::uint32_t protocol) {
  wire::ToPage message;
  message.mutable_welcome()->set_protocol(kProtocol);
  message.mutable_welcome()->set_version(settings.version);
  server->send(page, encoded(message));
  server->disconnect(
      page, fmt::format("this page uses protocol {}, the station {}: reload the page", protocol, kProtocol));
}

wire::ToPage Cockpit::Impl::present_state() {
  wire::ToPage message;
  wire::State& state = *message.mutable_state();
  write_state(session, state);
  state.set_trouble(for_pages(state.trouble()));
  if (state.has_fault() && state.fault().time() == reported)
    state.mutable_fault()->set_report(as_utf8(report));
  if (hides_scene) hide_scene(state);
  write_participants(participants, now(), state);
  if (settings.recording)
    if (const auto recording = settings.recording()) write_recording(*recording, *state.mutable_recording());
  return message;
}

void Cockpit::Impl::send_state_if_due() {
  // Read before the state is encoded: a change in between is sent with the next state.
  const std::uint64_t revision = session.info()->revision;
  const SafetyState safety = session.view().state;
  const bool changed = state_requested || revision != sent_revision || safety != sent_safety;
  const double since = now() - state_sent;
  if (since < kShortestStateInterval || (!changed && since < kLongestStateInterval)) return;
  state_requested = false;
  state_sent = now();
  sent_revision = revision;
  sent_safety = safety;
  const wire::ToPage state = present_state();
  const Bytes of_others = encoded(state);
  Bytes of_patient;
  for (const auto& [page, window] : greeted) {
    const bool patient_state = gets_patient_state(window);
    if (patient_state && !of_patient) of_patient = encoded(for_patient(state));
    server->send(page, patient_state ? of_patient : of_others);
  }
}

void Cockpit::Impl::draw(StationView& view) {
  const std::shared_ptr<const SessionInfo> info = session.info();
  if (info->geometry != drawn_geometry || info->margin != drawn_margin) {
    drawn.reset();
    drawn_geometry = info->geometry;
    drawn_margin = info->margin;
    drawn_at = view.time;
    if (drawn_geometry && drawn_geometry->model) drawn.emplace(*drawn_geometry->model, drawn_margin);
  }
  if (!drawn) return;
  drawn->follow(view.snapshot.gdp_angle, std::max(0.0, view.time - drawn_at));
  drawn_at = view.time;
  drawn->draw(view.snapshot);
}

void Cockpit::Impl::send_tick() {
  if (hides_scene) return;
  StationView view = session.view();
  // Before the first step there is no hand to show.
  if (view.snapshot.tick == 0) return;
  Bytes bytes;
  for (auto& [page, window] : greeted) {
    if (window.newest == view.time || !window.open()) continue;
    if (!bytes) {
      draw(view);
      wire::ToPage message;
      write_tick(view, *message.mutable_tick());
      bytes = encoded(message);
    }
    window.newest = view.time;
    // A tick that was replaced never arrives, so that the page cannot acknowledge it.
    if (!server->send_newest(page, bytes)) ++window.sent;
  }
}

void Cockpit::Impl::disconnect_pages_without_hello() {
  for (auto it = awaiting_hello.begin(); it != awaiting_hello.end();) {
    const PageId page = it->first;
    const bool late = now() - it->second > kHelloTimeout;
    it = late ? awaiting_hello.erase(it) : std::next(it);
    if (late) server->disconnect(page, "no hello came within 10 s");
  }
}

}  // namespace phalanx
