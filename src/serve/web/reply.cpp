// SPDX-License-Identifier: Apache-2.0
#include "serve/web/reply.h"

#include <fmt/format.h>

namespace phalanx::web {

Reply sentence(int status, const std::string& text) {
  Reply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(text + "\n");
  return reply;
}

namespace {

/// Some browsers do not count ws: as 'self', so it is named. Small pictures come as data:, and what is
/// exported as blob:.
std::string content_policy(const Exchange& exchange) {
  const std::string socket =
      exchange.host.empty() ? "" : fmt::format(" {}://{}", exchange.tls ? "wss" : "ws", exchange.host);
  return fmt::format(
      "default-src 'self'; connect-src 'self'{}; img-src 'self' data: blob:; object-src 'none'; "
      "base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
      socket);
}

}  // namespace

void protect(http::fields& fields, const Exchange& exchange) {
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set("Content-Security-Policy", content_policy(exchange));
}

Response response_of(const Reply& reply, const Exchange& exchange) {
  Response response;
  response.version(exchange.version);
  response.result(static_cast<unsigned>(reply.status));
  protect(response, exchange);
  response.set(http::field::cache_control, reply.cache);
  for (const auto& [name, value] : reply.fields) response.set(name, value);
  response.keep_alive(exchange.keep_alive);
  const bool bodiless = reply.status == 204 || reply.status == 304;
  if (bodiless) return response;
  response.set(http::field::content_type, reply.type);
  response.content_length(SharedBody::size(reply.body));
  if (!exchange.head_only) response.body() = reply.body;
  return response;
}

}  // namespace phalanx::web
