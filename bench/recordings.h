// SPDX-License-Identifier: Apache-2.0
// The step over recorded human motion, before meshes that people bring.
#pragma once

#include <functional>
#include <string>

#include "options.h"
#include "report.h"

namespace phalanx::bench {

/// Every recording of options.recordings before every mesh of options.meshes, 70 and 110 mm wide, and 70 mm
/// wide with each triangle divided until there are a million. Calls `done` after each. Set-up only.
/// @throws std::runtime_error if a folder has no such file, two repeats give different forces, FCL finds a shown segment
/// nearer than the margin, or nothing is touched; SceneError for a file that cannot be read
void run_recordings(const Options& options, const std::function<void(const RecordingReport&)>& done);

}  // namespace phalanx::bench
