// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace phalanx::mesh {

/// Assimp moves a .3ds face's index beyond its vertices onto the last vertex, and leaves such a .glb triangle
/// out, both without a word. So these are looked for here first. What is otherwise odd about the bytes is
/// left to Assimp. May throw anything derived from std::exception on damaged bytes: call through
/// run_isolated().
/// @throws std::invalid_argument, starting with `origin`, for a face that names a vertex which does not exist
void check_3ds_indices(std::string_view bytes, const std::string& origin);
void check_glb_indices(std::string_view bytes, const std::string& origin);

}  // namespace phalanx::mesh
