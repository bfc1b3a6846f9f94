// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace phalanx::mesh {

struct ReducedObj {
  std::string text;
  std::size_t unreferenced = 0;  ///< positions that no face with three corners names
};

/// The positions and polygons of an OBJ alone, checked, as an OBJ again: nothing for Assimp to stumble over.
/// By itself it leaves out, without a word, faces whose index is 0 or unreadable and vertices that no face
/// uses (NaN or not), and refuses faces with a comment behind them or with a texture or normal index that
/// does not exist, which do not matter here.
/// @throws std::invalid_argument with origin and line: a position that is not three finite numbers, a face
/// that names a vertex which
///         does not exist (up to its line), no face with three corners.
[[nodiscard]] ReducedObj reduce_obj(std::string_view text, std::string_view origin);

/// How many positions an OBJ has.
[[nodiscard]] std::size_t count_obj_positions(std::string_view text);

}  // namespace phalanx::mesh
