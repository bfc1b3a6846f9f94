// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace phalanx::mesh {

/// Checks the indices of a file that Assimp would accept silently. Assimp replaces an invalid index of a .3ds
/// face by the last vertex, and drops such a .glb triangle. Other defects are left to Assimp. On damaged
/// bytes this may throw anything derived from std::exception: call it through run_isolated().
/// @throws std::invalid_argument, starting with `origin`, if a face names a missing vertex
void check_3ds_indices(std::string_view bytes, const std::string& origin);
void check_glb_indices(std::string_view bytes, const std::string& origin);

}  // namespace phalanx::mesh
