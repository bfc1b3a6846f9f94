// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "serve/cockpit_parts.h"
#include "serve/plain_text.h"
#include "serve/uploads.h"

namespace phalanx {
namespace {

/// Never throws: a browser waits for it.
WebAnswer take_mesh(const UploadedMesh& mesh, const std::filesystem::path& folder,
                    const ValuesInForce& in_force) noexcept {
  try {
    return {.status = 200,
            .type = "application/json",
            .body = std::make_shared<const std::string>(take_upload(mesh, folder, in_force)),
            .immutable = false};
  } catch (const std::exception&) {  // no memory: the server has an answer of its own to that
    return {.status = 500, .type = "text/plain", .body = nullptr, .immutable = false};
  }
}

}  // namespace

WebAnswer plain_answer(int status, std::string text) {
  return {.status = status,
          .type = "text/plain; charset=utf-8",
          .body = std::make_shared<const std::string>(std::move(text)),
          .immutable = false};
}

void Cockpit::Parts::geometry(const std::string& revision, std::function<void(WebAnswer)> answer) {
  auto shown = host.state()->geometry;
  if (!shown || revision != std::to_string(shown->revision))
    return answer(
        plain_answer(404, "this shape is no longer shown; the page learns of the new one by itself\n"));
  shapes->ask(std::move(shown), std::move(answer));
}

const Seat* Cockpit::Parts::operator_of(const WebRequest& request) const {
  const Seat* seat = seats.with_secret(request.page_secret);
  return seat != nullptr && seats.operates(*seat) && request.visitor.may_operate ? seat : nullptr;
}

void Cockpit::Parts::upload(const WebRequest& request, std::function<void(WebAnswer)> answer) {
  const Seat* seat = operator_of(request);
  if (seat == nullptr)
    return answer(plain_answer(403, "only the page that operates may send meshes; take control first\n"));
  if (upload_work && !upload_work->done())
    return answer(plain_answer(429, "another mesh is being read; try again when it is done\n"));
  UploadedMesh mesh;
  try {
    mesh = upload_of(request.query, request.body);
  } catch (const std::invalid_argument& refused) {
    return answer(plain_answer(400, as_utf8(refused.what()) + "\n"));
  }
  // Told now: whether it is any good, its sender learns. The name only; the query may hold a token.
  tell(wire::Notice::CHANGE, seat->label(), "upload",
       fmt::format("sends a mesh: {}, {} bytes", shortened(one_line(mesh.name), 100), mesh.bytes.size()));
  const auto work = std::make_shared<UploadWork>(host);
  begin(
      work,
      [mesh = std::move(mesh), folder = settings.uploads](const ValuesInForce& in_force) {
        return take_mesh(mesh, folder, in_force);
      },
      std::move(answer));
  upload_work = work;
}

}  // namespace phalanx
