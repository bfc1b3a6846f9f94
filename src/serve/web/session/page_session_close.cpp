// SPDX-License-Identifier: Apache-2.0
// The closing handshake of a WebSocket, compiled by itself: see page_session.h.
#include "serve/web/session/page_session.h"

#include "serve/web/pages.h"

namespace phalanx::web {

void PageSession::close() {
  socket_.async_close(close_reason_, [self = shared_from_this()](error_code) {
    self->abort();
    self->pages_.remove(self->id_);
  });
}

}  // namespace phalanx::web
