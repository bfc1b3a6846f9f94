// SPDX-License-Identifier: Apache-2.0
// The findings of a mesh import, for programs: `phalanx mesh check --json` and the answer to an upload.
#pragma once

#include <string>

#include "phalanx/mesh/mesh_report.h"

namespace phalanx {

/// States in a sentence whether the mesh can be used in a scene. Set-up only.
[[nodiscard]] std::string mesh_verdict(const MeshReport& report);

/// Writes the report as a JSON object (docs/meshes.md). Set-up only.
/// @param file  name of the mesh file in the object
[[nodiscard]] std::string mesh_report_json(const std::string& file, const MeshReport& report);

}  // namespace phalanx
