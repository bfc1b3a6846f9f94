// SPDX-License-Identifier: Apache-2.0
#include "serve/web/house.h"

#include <utility>

#include "phalanx/serve/reach.h"
#include "serve/web/http_session.h"
#include "serve/web/names.h"
#include "serve/web/page_session.h"
#include "serve/web/tls.h"

namespace phalanx::web {

House::House(WebServerSettings given, WebApplication& its_application, net::io_context& thread,
             std::uint16_t port)
    : settings(std::move(given)),
      application(its_application),
      site(settings.site),
      tls(tls_context(settings)),
      host_door(names_of_server(settings.address)),
      token_door(settings.operator_token, settings.viewer_token, port, tls.has_value()),
      gate(std::make_shared<Gate>(thread)),
      pages(std::in_place, thread, settings.frame_rate_hz, application),
      doorstep(settings.unproven_connections, is_loopback(settings.address) ? settings.unproven_connections
                                                                            : settings.unproven_per_address) {
}

House::~House() = default;

void House::vacate() noexcept {
  pages.reset();
  waiting.clear();
}

}  // namespace phalanx::web
