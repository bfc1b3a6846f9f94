// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "phalanx/device/clock.h"
#include "run/run_options.h"

namespace phalanx {

class Registry;

/// Runs the station of `phalanx run` with its terminal, until Ctrl-C, `quit` or --seconds. In every case the station first
/// ends at zero torque, and the files are then written. This thread waits for neither the terminal nor the disk while
/// the station runs.
/// @param options, clock  outlive the call
/// @param registry  patients of the page; null: none
/// @returns the exit code: kDone, or kFailed if the station ended in a fault, or a file is not complete
/// @throws as Session and RunRecorder; each names the remedy
[[nodiscard]] int run_station(const RunOptions& options, const Clock& clock,
                              std::shared_ptr<Registry> registry);

}  // namespace phalanx
