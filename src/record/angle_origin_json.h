// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "phalanx/hand/angle_origin.h"

namespace phalanx {

/// Writes the origin of each joint's angle by the joint's name.
[[nodiscard]] inline nlohmann::ordered_json angle_origin_json(const AngleOrigins& origins) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  int joint = 0;
  for (const AngleOrigin origin : origins)
    json[std::string(joint_name(joint++))] = std::string(angle_origin_name(origin));
  return json;
}

}  // namespace phalanx
