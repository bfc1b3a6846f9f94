// SPDX-License-Identifier: Apache-2.0
// Import of an untrusted mesh beside a loop that moves a hand.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/mesh/import.h"
#include "phalanx/mesh/isolation/isolated.h"

namespace phalanx::mesh {

/// Imports a mesh from memory in an isolated process as a whole: the limits hold for the repair and the
/// check, too. The result is that of import_and_check_from_memory(), bit by bit.
/// @throws std::invalid_argument as import_and_check_from_memory(). If the process crashed, reached a limit
/// or sent no valid mesh, the message starts with `origin`
/// Set-up only: forks, allocates, throws, waits.
[[nodiscard]] ImportedMesh import_isolated(std::string_view content, const std::string& format,
                                           const ImportOptions& options, const std::string& origin,
                                           const IsolationLimits& limits);

}  // namespace phalanx::mesh
