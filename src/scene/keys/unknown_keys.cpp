// SPDX-License-Identifier: Apache-2.0
#include "scene/keys/unknown_keys.h"

#include <fmt/format.h>

#include <algorithm>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx {
namespace {

bool starts_with_part(std::string_view path, std::string_view prefix) {
  return path.size() > prefix.size() && path.substr(0, prefix.size()) == prefix &&
         (path[prefix.size()] == '.' || path[prefix.size()] == '[');
}

/// @returns true for the scene's override of another file's key: that file's reader checks it.
bool is_over_file(std::string_view path) {
  const std::string_view table = path.substr(0, path.find('.'));
  return (table == "device" || table == "patient") && path != table && path.substr(table.size()) != ".file";
}

void refuse_below(const SceneTree& tree, const toml::node& node, const std::string& path,
                  SceneProblems& problems) {
  const auto& keys = scene_keys();
  if (!path.empty()) {
    if (is_over_file(path)) return;
    const std::string pattern = pattern_of(path);
    if (find_scene_key(pattern) != nullptr) return;
    const bool holds_keys = std::any_of(
        keys.begin(), keys.end(), [&](const SceneKey& key) { return starts_with_part(key.path, pattern); });
    if (pattern == "smoothing.enabled")
      tree.fail(path,
                "this key no longer exists: stabiliser.method replaces it; remove it. For no bound on the "
                "force write stabiliser.method = \"none\"");
    if (!holds_keys) {
      std::vector<std::string> known;
      for (const SceneKey& key : keys) known.push_back(key.path);
      tree.fail(path, fmt::format(
                          "is not a known key; the nearest known one is {} (`phalanx scene keys` lists all)",
                          nearest_name(pattern, known)));
    }
    if (pattern == "objects" && !node.is_array())
      tree.fail(path, "is not an array; start each object with a line [[objects]]");
    if (pattern != "objects" && !node.is_table()) {
      tree.fail(path, fmt::format("is {}, but {} is a table; write its keys below a line [{}]",
                                  type_name(node), path, path));
    }
  }
  const auto child_path = [&](std::string_view part) {
    return path.empty() ? std::string(part) : fmt::format("{}.{}", path, part);
  };
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, child] : *table) {
      const std::string at = child_path(key.str());
      problems.run([&, &below = child] { refuse_below(tree, below, at, problems); });
    }
  } else if (const toml::array* array = node.as_array()) {
    for (std::size_t i = 0; i < array->size(); ++i)
      problems.run([&] { refuse_below(tree, (*array)[i], child_path(std::to_string(i)), problems); });
  }
}

}  // namespace

void refuse_unknown_keys(const SceneTree& tree, SceneProblems& problems) {
  refuse_below(tree, tree.root(), "", problems);
}

}  // namespace phalanx
