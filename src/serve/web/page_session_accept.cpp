// SPDX-License-Identifier: Apache-2.0
// The WebSocket handshake. By itself: each operation of the stream takes the compiler some 20 s and 0.3 GB.
#include "serve/web/page_session.h"

namespace phalanx::web {

void PageSession::accept(const http::request<http::buffer_body>& request, const Exchange& exchange) {
  socket_.set_option(websocket::stream_base::decorator(
      [exchange](websocket::response_type& response) { protect(response, exchange); }));
  socket_.async_accept(request, beast::bind_front_handler(&PageSession::on_accepted, shared_from_this()));
}

}  // namespace phalanx::web
