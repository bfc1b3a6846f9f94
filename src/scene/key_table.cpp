// SPDX-License-Identifier: Apache-2.0
#include "scene/key_table.h"

#include <fmt/format.h>

#include "scene/key_builders.h"

namespace phalanx {

const std::vector<KeySpec>& key_table() {
  static const std::vector<KeySpec> kTable = [] {
    std::vector<KeySpec> keys;
    add_general_keys(keys);
    add_object_keys(keys);
    add_force_keys(keys);
    add_motion_keys(keys);
    add_device_keys(keys);
    return keys;
  }();
  return kTable;
}

const std::string& KeySpec::default_for(const std::string& kind) const {
  for (const auto& [name, value] : kind_defaults)
    if (name == kind) return value;
  return default_toml;
}

std::string range_text(const KeySpec& key) {
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
    default:
      return "";
  }
}

}  // namespace phalanx
