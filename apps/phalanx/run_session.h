// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/station/session.h"
#include "run_options.h"

namespace phalanx {

/// Makes the station's settings from the command line of `phalanx run`.
/// @throws SceneError or std::invalid_argument if options contradict each other
[[nodiscard]] SessionSettings session_settings(const RunOptions& options);

}  // namespace phalanx
