// SPDX-License-Identifier: Apache-2.0
#include "phalanx/serve/cockpit.h"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "phalanx/serve/reach.h"
#include "serve/cockpit_parts.h"
#include "serve/plain_text.h"
#include "serve/state_message.h"

namespace phalanx {
namespace {

constexpr std::string_view kGeometry = "/geometry/";
constexpr auto kWaitForUpload = std::chrono::seconds(1);

double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CockpitSettings with_clock(CockpitSettings settings) {
  if (!settings.clock) settings.clock = steady_now;
  return settings;
}

}  // namespace

Cockpit::Parts::Parts(StationHost& station, CockpitSettings given)
    : host(station), settings(with_clock(std::move(given))), log(settings.log) {
  write_choices(choices);
  choices.set_protocol(kProtocol);
  choices.set_version(settings.version);
}

Cockpit::Parts::~Parts() {
  if (drag) log.add(notice_of(wire::Notice::CHANGE, drag->who, drag->newest.code, drag->newest.text));
  if (upload_work) upload_work->abandon(kWaitForUpload);
}

Cockpit::Cockpit(StationHost& host, CockpitSettings settings)
    : parts_(std::make_shared<Parts>(host, std::move(settings))) {}

Cockpit::~Cockpit() = default;

void Cockpit::attach(WebServer& server, const std::vector<std::string>& viewer_urls) {
  parts_->server = &server;
  parts_->viewer_urls = viewer_urls;
}

void Cockpit::tell(const std::string& code, const std::string& text, bool fault) {
  parts_->server->post([parts = parts_.get(), code, text, fault] {
    parts->tell(fault ? wire::Notice::FAULT : wire::Notice::WARNING, "", code, text);
  });
}

void Cockpit::typed(const std::string& code, const std::string& text) {
  parts_->server->post(
      [parts = parts_.get(), code, text] { parts->tell(wire::Notice::CHANGE, "the terminal", code, text); });
}

void Cockpit::fault_reported(const std::string& file, double fault_time) {
  parts_->server->post([parts = parts_.get(), file, fault_time] { parts->fault_reported(file, fault_time); });
}

void Cockpit::joined(PageId page, const Visitor& visitor) {
  try {
    parts_->seats.join(page, visitor, random_token(), parts_->now());
    parts_->waiting[page] = parts_->now();
  } catch (const std::exception&) {  // without a secret of its own it could be taken for another
    parts_->server->show_out(page, "the station cannot tell this page from others; try again");
  }
}

void Cockpit::left(PageId page) {
  if (const Seat* seat = parts_->seats.find(page)) parts_->sliders_told.erase(seat->number);
  if (parts_->drag && parts_->drag->page == page) parts_->tell_drag();
  parts_->greeted.erase(page);
  parts_->waiting.erase(page);
  parts_->seats.leave(page, parts_->now());
  parts_->want_state();
}

void Cockpit::received(PageId page, std::string_view bytes) {
  if (parts_->seats.find(page) == nullptr) return;
  wire::ToHost message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return parts_->server->show_out(page, "this is no message of the cockpit's");
  if (!parts_->greeted.contains(page) && !message.has_hello() && !message.has_stop())
    return parts_->server->show_out(page, "a page says hello first");
  try {
    parts_->obey(page, message);
  } catch (const std::exception& refused) {  // what is refused ends nothing
    parts_->reply(page, message.request(), parts_->for_pages(refused.what()));
  }
}

void Cockpit::received_too_much(PageId page, std::string_view last) {
  const Seat* seat = parts_->seats.find(page);
  wire::ToHost message;
  if (seat == nullptr || !message.ParseFromArray(last.data(), static_cast<int>(last.size()))) return;
  if (message.has_stop()) parts_->stop(*seat);
}

void Cockpit::frame() {
  parts_->show_out_the_silent();
  parts_->tell_if_log_breaks();
  parts_->tell_drag_if_due();
  parts_->give_control_to_only_page();
  if (parts_->greeted.empty()) return;
  parts_->send_state_if_due();
  parts_->send_tick();
}

void Cockpit::requested(const WebRequest& request, std::function<void(WebAnswer)> answer) {
  if (request.method == "POST" && request.path == "/stop") {
    const std::string& address = request.visitor.address;
    if (const Seat* seat = parts_->seats.with_secret(request.page_secret)) {
      parts_->stop(*seat);
    } else {
      parts_->stop(address, fmt::format("a page ({})", address));
    }
    return answer(plain_answer(200, "stopped\n"));
  }
  if (request.method == "POST" && request.path == "/mesh") return parts_->upload(request, std::move(answer));
  if (request.method != "POST" && request.path.starts_with(kGeometry))
    return parts_->geometry(request.path.substr(kGeometry.size()), std::move(answer));
  const bool known =
      request.path == "/stop" || request.path == "/mesh" || request.path.starts_with(kGeometry);
  answer(known ? plain_answer(405, "not with this method\n")
               : plain_answer(404, "there is nothing here; the cockpit is at /\n"));
}

std::size_t Cockpit::body_limit(const WebRequest& head) {
  const bool upload = head.method == "POST" && head.path == "/mesh" && parts_->operator_of(head) != nullptr;
  return upload ? kUploadLimit : 0;
}

}  // namespace phalanx
