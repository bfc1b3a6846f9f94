// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "phalanx/hand/angle_origin.h"

namespace phalanx {

/// Makes {"<name>": value, ...} in index order.
/// @param name  function from a value's index to its name
template <class Values, class Name>
[[nodiscard]] nlohmann::ordered_json json_by_name(const Values& values, Name name) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  int i = 0;
  for (const auto& value : values) json[std::string(name(i++))] = value;
  return json;
}

/// Writes the origin of each joint's angle by the joint's name.
[[nodiscard]] inline nlohmann::ordered_json angle_origin_json(const AngleOrigins& origins) {
  std::array<std::string_view, kJoints> words;
  std::ranges::transform(origins, words.begin(), angle_origin_name);
  return json_by_name(words, joint_name);
}

}  // namespace phalanx
