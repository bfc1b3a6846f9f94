// SPDX-License-Identifier: Apache-2.0
// Reading a WebSocket. By itself: each operation of the stream takes the compiler some 20 s and 0.3 GB.
#include "serve/web/page_session.h"

namespace phalanx::web {

void PageSession::read() {
  socket_.async_read(message_, beast::bind_front_handler(&PageSession::on_read, shared_from_this()));
}

}  // namespace phalanx::web
