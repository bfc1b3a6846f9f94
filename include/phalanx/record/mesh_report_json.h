// SPDX-License-Identifier: Apache-2.0
// What an import found, for programs: `phalanx mesh check --json` and the answer to an upload.
#pragma once

#include <string>

#include "phalanx/mesh/mesh_report.h"

namespace phalanx {

/// Usable in a scene or not, in a sentence. Set-up only.
[[nodiscard]] std::string mesh_verdict(const MeshReport& report);

/// The report as a JSON object (docs/meshes.md). @param file  how it is named in it. Set-up only.
[[nodiscard]] std::string mesh_report_json(const std::string& file, const MeshReport& report);

}  // namespace phalanx
