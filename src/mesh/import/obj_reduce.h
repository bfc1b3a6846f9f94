// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace phalanx::mesh {

/// OBJ reduced to positions and polygons.
struct ReducedObj {
  std::string text;
  std::size_t unreferenced = 0;  ///< number of positions that no face with three corners names
};

/// Reduces an OBJ to its checked positions and polygons, as an OBJ again, so that Assimp accepts it. Assimp
/// silently drops faces whose index is 0 or unreadable, and unused vertices (NaN or not). It refuses a face
/// followed by a comment, and a face with an invalid texture or normal index. Neither matters here.
/// @throws std::invalid_argument with origin and line, if a position is not three finite numbers or no face
/// has three corners. Also if a face names a vertex that is not defined up to its line.
[[nodiscard]] ReducedObj reduce_obj(std::string_view text, std::string_view origin);

/// Returns the number of positions of an OBJ.
[[nodiscard]] std::size_t count_obj_positions(std::string_view text);

}  // namespace phalanx::mesh
