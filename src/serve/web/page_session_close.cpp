// SPDX-License-Identifier: Apache-2.0
// The end of a WebSocket. By itself: each operation of the stream takes the compiler some 20 s and 0.3 GB.
#include "serve/web/page_session.h"

#include "serve/web/pages.h"

namespace phalanx::web {

void PageSession::close() {
  socket_.async_close(goodbye_, [self = shared_from_this()](error_code) {
    self->cut();
    self->pages_.ended(self->id_);
  });
}

}  // namespace phalanx::web
