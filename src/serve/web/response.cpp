// SPDX-License-Identifier: Apache-2.0
#include "serve/web/response.h"

#include <fmt/format.h>

namespace phalanx::web {

Reply text_reply(int status, const std::string& text) {
  Reply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(text + "\n");
  return reply;
}

namespace {

/// @returns the Content-Security-Policy. It names the WebSocket's address, because some browsers do not
/// include ws: in 'self'. The page embeds small pictures as data: and exports files as blob:.
std::string content_policy(const ResponseContext& context) {
  const std::string socket =
      context.host.empty() ? "" : fmt::format(" {}://{}", context.tls ? "wss" : "ws", context.host);
  return fmt::format(
      "default-src 'self'; connect-src 'self'{}; img-src 'self' data: blob:; object-src 'none'; "
      "base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
      socket);
}

}  // namespace

void set_security_fields(http::fields& fields, const ResponseContext& context) {
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set("Content-Security-Policy", content_policy(context));
}

Response make_response(const Reply& reply, const ResponseContext& context) {
  Response response;
  response.version(context.version);
  response.result(static_cast<unsigned>(reply.status));
  set_security_fields(response, context);
  response.set(http::field::cache_control, reply.cache);
  for (const auto& [name, value] : reply.fields) response.set(name, value);
  response.keep_alive(context.keep_alive);
  const bool bodiless = reply.status == 204 || reply.status == 304;
  if (bodiless) return response;
  response.set(http::field::content_type, reply.type);
  response.content_length(SharedBody::size(reply.body));
  if (!context.head_only) response.body() = reply.body;
  return response;
}

}  // namespace phalanx::web
