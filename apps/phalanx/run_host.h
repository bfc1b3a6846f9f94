// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/station/station_host.h"
#include "run_options.h"

namespace phalanx {

/// What `phalanx run` was told, for its station.
/// @throws SceneError or std::invalid_argument: options that do not go together
[[nodiscard]] StationHostSettings host_settings(const RunOptions& options);

}  // namespace phalanx
