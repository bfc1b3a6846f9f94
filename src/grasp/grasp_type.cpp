// SPDX-License-Identifier: Apache-2.0
#include "phalanx/grasp/grasp_type.h"

#include <algorithm>

namespace phalanx {
namespace {

constexpr std::array<bool, kDigits> kAllDigits = {true, true, true, true, true};
constexpr double kRightAngle = 0.0;    // cosines between thumb and fingers
constexpr double kBeyondRight = -0.2;  // 102 degrees
constexpr double kOpposed = -0.6;      // 127 degrees

constexpr std::array<GraspRule, 7> kRules = {{
    {.name = "cylinder",
     .digit = kAllDigits,
     .least_fingers = 3,
     .palm = true,
     .wraps = true,
     .most_cosine = kRightAngle},
    {.name = "sphere",
     .digit = kAllDigits,
     .least_fingers = 3,
     .palm = true,
     .wraps = true,
     .most_cosine = kRightAngle},
    {.name = "tripod",
     .digit = {true, true, true, false, false},
     .least_fingers = 2,
     .pads = true,
     .most_cosine = kOpposed},
    {.name = "pinch",
     .digit = {true, true, false, false, false},
     .least_fingers = 1,
     .pads = true,
     .most_cosine = kOpposed},
    {.name = "lateral",
     .digit = {true, true, false, false, false},
     .least_fingers = 1,
     .most_cosine = kOpposed},
    {.name = "hook",
     .digit = {false, true, true, true, true},
     .least_fingers = 2,
     .wraps = true,
     .closure = false},
    {.name = "disk", .digit = kAllDigits, .least_fingers = 3, .pads = true, .most_cosine = kBeyondRight},
}};

}  // namespace

const GraspRule& grasp_rule(GraspType type) noexcept { return kRules[static_cast<std::size_t>(type)]; }

const std::vector<std::string>& grasp_type_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const GraspRule& rule : kRules) names.emplace_back(rule.name);
    return names;
  }();
  return kNames;
}

std::optional<GraspType> find_grasp_type(std::string_view name) noexcept {
  const auto* it =
      std::find_if(kRules.begin(), kRules.end(), [&](const GraspRule& rule) { return rule.name == name; });
  if (it == kRules.end()) return std::nullopt;
  return static_cast<GraspType>(it - kRules.begin());
}

}  // namespace phalanx
