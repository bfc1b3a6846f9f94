// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/station/station_host.h"
#include "run_options.h"

namespace phalanx {

/// Makes the station's settings from the command line of `phalanx run`.
/// @throws SceneError or std::invalid_argument if options contradict each other
[[nodiscard]] StationHostSettings host_settings(const RunOptions& options);

}  // namespace phalanx
