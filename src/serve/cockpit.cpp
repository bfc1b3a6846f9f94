// SPDX-License-Identifier: Apache-2.0
#include "phalanx/serve/cockpit.h"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <utility>

#include "phalanx/serve/reach.h"
#include "record/plain_text.h"
#include "serve/cockpit_impl.h"
#include "serve/state_message.h"
#include "serve/uploads.h"

namespace phalanx {
namespace {

constexpr std::string_view kGeometry = "/geometry/";
constexpr double kSignInInterval = 1.0;  ///< between two checks whether accounts are still signed in [s]
constexpr auto kAbandonTimeout = std::chrono::seconds(1);

double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

CockpitSettings with_clock(CockpitSettings settings) {
  if (!settings.clock) settings.clock = steady_now;
  return settings;
}

/// @returns a response of plain text
WebResponse text_response(int status, std::string text) {
  return {.status = status,
          .type = "text/plain; charset=utf-8",
          .body = std::make_shared<const std::string>(std::move(text)),
          .immutable = false};
}

/// Takes an upload. Does not throw, because the browser waits for the response.
WebResponse take_mesh(const UploadedMesh& mesh, const std::filesystem::path& folder,
                      const ValuesInForce& in_force, ImportCache& imports) noexcept {
  try {
    return {.status = 200,
            .type = "application/json",
            .body = std::make_shared<const std::string>(take_upload(mesh, folder, in_force, imports)),
            .immutable = false};
  } catch (const std::exception&) {  // no memory
    return {.status = 500, .type = "text/plain", .body = nullptr, .immutable = false};
  }
}

}  // namespace

Cockpit::Impl::Impl(Session& served, CockpitSettings given)
    : session(served), settings(with_clock(std::move(given))), log(settings.log) {
  write_choices(choices);
  choices.set_protocol(kProtocol);
  choices.set_version(settings.version);
}

Cockpit::Impl::~Impl() {
  if (drag) log.add(make_notice(wire::Notice::CHANGE, drag->who, drag->newest.code, drag->newest.text));
  if (upload) upload->abandon(kAbandonTimeout);
  people->finish(kAbandonTimeout);
}

Cockpit::Cockpit(Session& session, CockpitSettings settings)
    : impl_(std::make_shared<Impl>(session, std::move(settings))) {}

Cockpit::~Cockpit() = default;

void Cockpit::attach(WebServer& server, const std::vector<std::string>& viewer_urls) {
  impl_->server = &server;
  impl_->viewer_urls = viewer_urls;
}

void Cockpit::notify(const std::string& code, const std::string& text, bool fault) {
  impl_->server->post([impl = impl_.get(), code, text, fault] {
    impl->notify(fault ? wire::Notice::FAULT : wire::Notice::WARNING, "", code, text);
  });
}

void Cockpit::typed(const std::string& code, const std::string& text) {
  impl_->server->post(
      [impl = impl_.get(), code, text] { impl->notify(wire::Notice::CHANGE, "the terminal", code, text); });
}

void Cockpit::fault_reported(const std::string& file, double fault_time) {
  impl_->server->post([impl = impl_.get(), file, fault_time] { impl->fault_reported(file, fault_time); });
}

void Cockpit::joined(PageId page, const ClientInfo& client) {
  try {
    impl_->participants.join(page, client, random_token(), impl_->now());
    impl_->awaiting_hello[page] = impl_->now();
  } catch (const std::exception&) {  // without a secret the page could not be told apart
    impl_->server->disconnect(page, "the station could not make a secret for this page; try again");
  }
}

void Cockpit::left(PageId page) {
  if (const Participant* participant = impl_->participants.find(page))
    impl_->sliders_notified.erase(participant->number);
  if (impl_->drag && impl_->drag->page == page) impl_->notify_drag();
  impl_->greeted.erase(page);
  impl_->awaiting_hello.erase(page);
  impl_->participants.leave(page, impl_->now());
  impl_->request_state();
}

void Cockpit::received(PageId page, std::string_view bytes) {
  if (impl_->participants.find(page) == nullptr) return;
  wire::ToHost message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    return impl_->server->disconnect(page, "this is not a message of the cockpit's protocol");
  if (!impl_->greeted.contains(page) && !message.has_hello() && !message.has_stop())
    return impl_->server->disconnect(page, "a page must send hello first");
  try {
    impl_->handle(page, message);
  } catch (const std::exception& refused) {
    impl_->reply(page, message.request(), impl_->for_pages(refused.what()));
  }
}

void Cockpit::received_over_limit(PageId page, std::string_view bytes) {
  const Participant* participant = impl_->participants.find(page);
  wire::ToHost message;
  if (participant == nullptr || !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
  const bool pause = message.has_feel() && message.feel().kind() == wire::Feel::PAUSE;
  if (message.has_stop() || pause) impl_->stop(*participant);
}

void Cockpit::frame() {
  impl_->disconnect_pages_without_hello();
  impl_->notify_if_log_breaks();
  impl_->notify_drag_if_due();
  impl_->give_control_to_only_page();
  impl_->notify_sign_ins();
  if (impl_->greeted.empty()) return;
  impl_->send_exercise_if_due();
  impl_->send_state_if_due();
  impl_->send_tick();
}

void Cockpit::requested(const WebRequest& request, std::function<void(WebResponse)> respond) {
  if (request.method == "POST" && request.path == "/stop") {
    const std::string& address = request.client.address;
    if (const Participant* participant = impl_->participants.with_secret(request.page_secret)) {
      impl_->stop(*participant);
    } else {
      impl_->stop(address, fmt::format("a page ({})", address));
    }
    return respond(text_response(200, "stopped\n"));
  }
  if (request.method == "POST" && request.path == "/mesh")
    return impl_->begin_upload(request, std::move(respond));
  if (request.method == "POST" && request.path == "/marker") return impl_->mark(request, respond);
  if (People::is_one(request.path)) {
    impl_->notify_sign_ins();  // no frame comes while no page of the cockpit is open
    return impl_->people->request(request, std::move(respond));
  }
  if (StationFiles::is_one(request.path)) return impl_->station_files->request(request, std::move(respond));
  if (request.method != "POST" && request.path.starts_with(kGeometry))
    return impl_->respond_with_geometry(request.path.substr(kGeometry.size()), std::move(respond));
  const bool known = request.path == "/stop" || request.path == "/mesh" || request.path == "/marker" ||
                     request.path.starts_with(kGeometry);
  respond(known ? text_response(405, "this address does not allow this method\n")
                : text_response(404, "there is nothing at this address; the cockpit is at /\n"));
}

std::size_t Cockpit::body_limit(const WebRequest& head) {
  if (head.method != "POST") return 0;
  if (head.path == "/marker" && head.client.may_operate) return kMarkerLimit;
  if (People::is_one(head.path)) return impl_->people->body_limit(head);
  return head.path == "/mesh" && impl_->operator_of(head) != nullptr ? kUploadLimit : 0;
}

// ---- HTTP requests ----

void Cockpit::Impl::respond_with_geometry(const std::string& revision,
                                          std::function<void(WebResponse)> respond) {
  look_at_exercise();
  if (hides_scene)
    return respond(text_response(404, "the exercise that runs hides its scene; it is shown after the end\n"));
  auto geometry = session.info()->geometry;
  if (!geometry || revision != std::to_string(geometry->revision))
    return respond(text_response(404, "this geometry is no longer shown; pages are told the new revision\n"));
  geometry_cache->request(std::move(geometry), std::move(respond));
}

/// Writes a marker of another program, such as one that gives a stimulus, to the recording and the log, and tells all pages.
void Cockpit::Impl::mark(const WebRequest& request, const std::function<void(WebResponse)>& respond) {
  if (!request.client.may_operate)
    return respond(text_response(403, "only who may operate may set markers; use the operator's token\n"));
  const Participant* participant = participants.with_secret(request.page_secret);
  if (participant != nullptr && participant->patient_screen)
    return respond(text_response(403, "the patient's screen sets no markers\n"));
  const std::string text = one_line(request.body);
  if (text.empty()) return respond(text_response(400, "a marker is a text: send it as the request's body\n"));
  notify(wire::Notice::CHANGE, request.client.address, "marker", text);
  respond(text_response(200, "marked\n"));
}

void Cockpit::Impl::notify_sign_ins() {
  if (now() - sign_ins_checked >= kSignInInterval) {
    sign_ins_checked = now();
    people->check_sessions(participants.any_patient_screen());
  }
  for (const People::SignIn& change : people->take_sign_ins()) {
    if (!change.in) participants.sign_in(change.page_secret, "");
    const Participant* participant = participants.with_secret(change.page_secret);
    const std::string page = participant != nullptr ? participant->label() : "the page of patients";
    if (change.in) participants.sign_in(change.page_secret, change.account, change.role);
    notify(wire::Notice::CHANGE, page, "account",
           fmt::format("account {} {}", change.account, change.in ? "signed in" : "signed out"));
  }
}

const Participant* Cockpit::Impl::operator_of(const WebRequest& request) const {
  const Participant* participant = participants.with_secret(request.page_secret);
  return participant != nullptr && participants.operates(*participant) && request.client.may_operate
             ? participant
             : nullptr;
}

void Cockpit::Impl::begin_upload(const WebRequest& request, std::function<void(WebResponse)> respond) {
  const Participant* participant = operator_of(request);
  if (participant == nullptr)
    return respond(text_response(403, "only the page that operates may send meshes; take control first\n"));
  if (upload && !upload->done())
    return respond(text_response(429, "another mesh is being read; try again when it is done\n"));
  UploadedMesh mesh;
  try {
    mesh = upload_of(request.query, request.body);
  } catch (const std::invalid_argument& refused) {
    return respond(text_response(400, as_utf8(refused.what()) + "\n"));
  }
  // Logged now: the response tells the sender the result. Logs the name only, because the query may
  // hold a token.
  notify(wire::Notice::CHANGE, participant->label(), "upload",
         fmt::format("sends a mesh: {}, {} bytes", shortened(one_line(mesh.name), 100), mesh.bytes.size()));
  const auto job = std::make_shared<UploadJob>(session);
  start_upload(
      job,
      [mesh = std::move(mesh), folder = settings.uploads, imports = session.imports()](
          const ValuesInForce& in_force) { return take_mesh(mesh, folder, in_force, *imports); },
      std::move(respond));
  upload = job;
}

}  // namespace phalanx
