// SPDX-License-Identifier: Apache-2.0
// Import of an untrusted mesh, and its simplification for a picture, beside a loop that moves a hand.
#pragma once

#include <cstddef>
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

/// Simplifies an imported mesh for a picture as picture_of(), in an isolated process: for an odd mesh the time
/// can grow with the square of its triangles.
/// @throws std::invalid_argument starting with `origin` if the process crashed or reached a limit
/// Set-up only: forks, allocates, throws, waits.
[[nodiscard]] TriangleMesh picture_isolated(const TriangleMesh& mesh, std::size_t triangles,
                                            const std::string& origin, const IsolationLimits& limits);

}  // namespace phalanx::mesh
