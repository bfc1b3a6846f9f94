// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/serve/web_server.h"

namespace phalanx::web {

/// @throws WebServerError  settings that no server should have, and what to do
void check(const WebServerSettings& settings);

}  // namespace phalanx::web
