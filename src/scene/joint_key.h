// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/nearest_name.h"
#include "phalanx/hand/joints.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {

/// Reads the name of a joint. @returns its number @throws SceneError with the nearest name for an unknown one
[[nodiscard]] inline int read_joint_name(TomlTable& table, std::string_view key) {
  const std::string name = table.text(key);
  if (const auto joint = find_joint(name)) return *joint;
  std::vector<std::string_view> known;
  for (int j = 0; j < kJoints; ++j) known.push_back(joint_name(j));
  table.fail(key,
             fmt::format("is no joint of the hand; the nearest one is \"{}\"", nearest_name(name, known)));
}

}  // namespace phalanx
