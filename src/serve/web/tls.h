// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

/// TLS 1.2 and up with the settings' certificate; none if they name none.
/// @throws WebServerError  a file that is none, or a key of another certificate's
[[nodiscard]] std::optional<net::ssl::context> tls_context(const WebServerSettings& settings);

}  // namespace phalanx::web
