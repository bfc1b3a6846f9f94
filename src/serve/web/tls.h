// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "phalanx/serve/web_server.h"
#include "serve/web/boost.h"

namespace phalanx::web {

/// TLS 1.2 and up with the settings' certificate; none if they name none. Of the suites of TLS 1.2 those
/// without CBC.
/// @throws WebServerError  a file that cannot be read, a key of another certificate, a
/// key file that is not its owner's alone
[[nodiscard]] std::optional<net::ssl::context> tls_context(const WebServerSettings& settings);

}  // namespace phalanx::web
