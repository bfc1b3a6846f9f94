// SPDX-License-Identifier: Apache-2.0
// The read of a WebSocket, compiled by itself: see page_session.h.
#include "serve/web/session/page_session.h"

namespace phalanx::web {

void PageSession::read() {
  socket_.async_read(message_, beast::bind_front_handler(&PageSession::on_read, shared_from_this()));
}

}  // namespace phalanx::web
