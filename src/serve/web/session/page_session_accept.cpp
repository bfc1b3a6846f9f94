// SPDX-License-Identifier: Apache-2.0
// The WebSocket handshake, compiled by itself: see page_session.h.
#include "serve/web/session/page_session.h"

namespace phalanx::web {

void PageSession::accept(const http::request<http::buffer_body>& request, const ResponseContext& context) {
  socket_.set_option(websocket::stream_base::decorator(
      [context](websocket::response_type& response) { set_security_fields(response, context); }));
  socket_.async_accept(request, beast::bind_front_handler(&PageSession::on_accepted, shared_from_this()));
}

}  // namespace phalanx::web
