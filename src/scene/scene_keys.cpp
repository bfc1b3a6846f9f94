// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_keys.h"

#include <fmt/format.h>

#include "scene/key_table.h"

namespace phalanx {
namespace {

std::string type_text(KeyType type) {
  switch (type) {
    case KeyType::kNumber:
      return "number";
    case KeyType::kNumberOrOff:
      return "number or \"off\"";
    case KeyType::kInteger:
      return "integer";
    case KeyType::kFlag:
      return "flag";
    case KeyType::kText:
      return "text";
    case KeyType::kChoice:
      return "choice";
    case KeyType::kVector:
      return "vector";
    case KeyType::kFile:
      return "file";
    case KeyType::kName:
      return "name";
  }
  return "";
}

}  // namespace

std::vector<SceneKey> scene_keys() {
  std::vector<SceneKey> rows;
  for (const KeySpec& key : key_table()) {
    std::string meaning = key.kinds.empty() ? key.meaning : fmt::format("({}) {}", key.kinds, key.meaning);
    for (std::size_t i = 0; i < key.kind_defaults.size(); ++i) {
      const auto& [kind, value] = key.kind_defaults[i];
      meaning += fmt::format("{}{} {}", i == 0 ? "; default of " : ", ", kind, value);
    }
    rows.push_back({key.path, type_text(key.type), key.unit, range_text(key), key.default_toml, meaning});
  }
  return rows;
}

std::string scene_keys_markdown() {
  std::string text =
      "| key | type | unit | range | default | meaning |\n| --- | --- | --- | --- | --- | --- |\n";
  for (const SceneKey& key : scene_keys()) {
    const std::string fallback = key.default_value.empty() ? "" : fmt::format("`{}`", key.default_value);
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.path, key.type, key.unit, key.range,
                        fallback, key.meaning);
  }
  return text;
}

}  // namespace phalanx
