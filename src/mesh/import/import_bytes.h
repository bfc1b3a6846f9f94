// SPDX-License-Identifier: Apache-2.0
// An imported mesh as bytes, in which one process of the program sends it to another.
#pragma once

#include <string>
#include <string_view>

#include "phalanx/mesh/import.h"

namespace phalanx::mesh {

/// @returns the mesh and its report; numbers keep their bits.
[[nodiscard]] std::string to_bytes(const ImportedMesh& imported);

/// Reads what to_bytes() has written. The bytes may come from a defective process.
/// @throws std::invalid_argument starting with `origin` if they are cut off or too long, a count or a kind
/// of finding is out of range, or the mesh does not pass check_mesh()
[[nodiscard]] ImportedMesh from_bytes(std::string_view bytes, const std::string& origin);

}  // namespace phalanx::mesh
