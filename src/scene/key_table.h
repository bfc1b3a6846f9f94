// SPDX-License-Identifier: Apache-2.0
// The table behind scene_keys(), with what reading needs beside it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml_reader.h"

namespace phalanx {

enum class KeyType {
  kNumber,
  kNumberOrOff,  ///< a number, or the string "off"
  kInteger,
  kFlag,
  kText,
  kChoice,
  kVector,
  kFile,  ///< a path, relative to the scene file
  kName,  ///< a name in one of the program's folders, or a path
};

/// A checked value; which member counts depends on the key's type.
struct KeyValue {
  double number = 0.0;
  bool off = false;
  std::int64_t integer = 0;
  bool flag = false;
  std::string text;
  Vec3 vector = Vec3::Zero();
};

/// Where a value goes.
struct KeyTarget {
  SceneDescription& scene;
  ObjectDescription& object;  ///< the element of objects[] that is being read
};

struct KeySpec {
  std::string path;
  KeyType type;
  std::string unit;
  NumberRange range;
  std::vector<std::string> choices;
  std::string default_toml;  ///< applied where the key is absent; empty: nothing is
  std::string meaning;
  std::function<void(const KeyTarget&, const KeyValue&)> store;
  std::string kinds;  ///< objects[] only: the kinds that have this key; empty: all
  /// objects[] only: {kind, default} where a kind's default is not default_toml.
  std::vector<std::pair<std::string, std::string>> kind_defaults = {};

  /// What counts where a file does not state the key, for an object of this kind.
  [[nodiscard]] const std::string& default_for(const std::string& kind) const;
};

/// In the order in which values are read: `rate_hz` comes before what depends on it.
[[nodiscard]] const std::vector<KeySpec>& key_table();

/// The key's allowed values in words.
[[nodiscard]] std::string range_text(const KeySpec& key);

}  // namespace phalanx
