// SPDX-License-Identifier: Apache-2.0
// Every key that a scene file may hold: the one table that reading, checking, `scene keys` and docs/scenes.md
// come from.
#pragma once

#include <string>
#include <vector>

namespace phalanx {

struct SceneKey {
  std::string path;           ///< "force.law"; "objects[].kind" for the elements of an array
  std::string type;           ///< number, integer, flag, text, choice, vector, file, name, number or "off"
  std::string unit;           ///< "mm", "N/mm", ...; empty if it has none
  std::string range;          ///< "> 0, <= 15", or the choices
  std::string default_value;  ///< as it would stand in a file; empty: no default
  std::string meaning;        ///< one line
};

/// In the order of the documentation.
[[nodiscard]] std::vector<SceneKey> scene_keys();

/// The same as the Markdown table of docs/scenes.md.
[[nodiscard]] std::string scene_keys_markdown();

}  // namespace phalanx
