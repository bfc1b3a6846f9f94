// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "scene/keys/key_rows.h"

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

std::string_view first_part(std::string_view path) { return path.substr(0, path.find_first_of(".[")); }

bool is_index(std::string_view part) {
  return !part.empty() &&
         std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

bool SceneKey::belongs_to(std::string_view kind) const {
  return kinds.empty() || std::any_of(kinds.begin(), kinds.end(),
                                      [&](const KindWithKey& having) { return having.kind == kind; });
}

const std::optional<KeyValue>& SceneKey::default_for(std::string_view kind) const {
  for (const KindWithKey& having : kinds)
    if (having.kind == kind && having.own_default) return having.own_default;
  return default_value;
}

bool SceneKey::is_path(const std::string& text) const {
  if (text.empty()) return false;
  return type == KeyType::kFile ||
         (type == KeyType::kName &&
          (text.find('/') != std::string::npos || std::filesystem::path(text).extension() == ".toml"));
}

const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> kTable = [] {
    std::vector<SceneKey> keys;
    add_general_keys(keys);
    add_object_keys(keys);
    add_force_keys(keys);
    add_motion_keys(keys);
    add_device_keys(keys);
    return keys;
  }();
  return kTable;
}

const SceneKey* find_scene_key(std::string_view path) {
  for (const SceneKey& key : scene_keys())
    if (key.path == path) return &key;
  return nullptr;
}

std::string pattern_of(std::string_view path) {
  std::string pattern;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    if (is_index(part) && !pattern.empty()) {
      pattern += "[]";
    } else {
      pattern += pattern.empty() ? "" : ".";
      pattern += part;
    }
    begin = end + 1;
  }
  return pattern;
}

ChangeKind change_kind(const std::string& path) {
  const std::string pattern = pattern_of(path);
  if (const SceneKey* key = find_scene_key(pattern)) return key->change;
  ChangeKind needs = ChangeKind::kAtZeroTorque;
  for (const SceneKey& key : scene_keys())
    if (first_part(key.path) == first_part(pattern)) needs = std::max(needs, key.change);
  return needs;
}

std::string_view change_text(ChangeKind change) {
  switch (change) {
    case ChangeKind::kInContact:
      return "at once";
    case ChangeKind::kAtZeroTorque:
      return "at zero torque";
    case ChangeKind::kOtherObject:
      return "another object";
    case ChangeKind::kNewStation:
      return "new station";
  }
  return "";
}

std::string range_text(const SceneKey& key) {
  switch (key.type) {
    case KeyType::kNumber:
    case KeyType::kInteger:
    case KeyType::kVector:
      return key.range.text();
    case KeyType::kNumberOrOff:
      return key.range.text() + ", or \"off\"";
    case KeyType::kChoice:
      return fmt::format("{}", fmt::join(key.choices, ", "));
    case KeyType::kFlag:
      return "true, false";
    case KeyType::kText:
    case KeyType::kFile:
    case KeyType::kName:
      return "";
  }
  return "";
}

std::string value_text(const SceneKey& key, const KeyValue& value) {
  switch (key.type) {
    case KeyType::kNumberOrOff:
      if (value.off) return "\"off\"";
      [[fallthrough]];
    case KeyType::kNumber:
      return fmt::format("{}", value.number);
    case KeyType::kInteger:
      return fmt::format("{}", value.integer);
    case KeyType::kFlag:
      return value.flag ? "true" : "false";
    case KeyType::kVector:
      return fmt::format("[{}, {}, {}]", value.vector.x(), value.vector.y(), value.vector.z());
    case KeyType::kText:
    case KeyType::kChoice:
    case KeyType::kFile:
    case KeyType::kName:
      return fmt::format("\"{}\"", value.text);
  }
  return "";
}

SceneKeyText text_of(const SceneKey& key) {
  std::string kinds;
  std::string defaults;
  for (const KindWithKey& having : key.kinds) {
    kinds += (kinds.empty() ? "" : " ") + having.kind;
    if (!having.own_default) continue;
    defaults += fmt::format("{}{} {}", defaults.empty() ? "; default of " : ", ", having.kind,
                            value_text(key, *having.own_default));
  }
  return {.type = type_text(key.type),
          .range = range_text(key),
          .default_value = key.default_value ? value_text(key, *key.default_value) : "",
          .change = std::string(change_text(key.change)),
          .meaning = (kinds.empty() ? "" : fmt::format("({}) ", kinds)) + key.meaning + defaults};
}

std::string scene_keys_markdown() {
  std::string text =
      "| key | type | unit | range | default | change | meaning |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const SceneKey& key : scene_keys()) {
    const SceneKeyText row = text_of(key);
    const std::string fallback = row.default_value.empty() ? "" : fmt::format("`{}`", row.default_value);
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} |\n", key.path, row.type, key.unit, row.range,
                        fallback, row.change, row.meaning);
  }
  return text;
}

}  // namespace phalanx
