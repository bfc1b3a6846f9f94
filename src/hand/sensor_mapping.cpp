// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/sensor_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace phalanx {

double mapped_angle(const JointMapping& mapping, double raw) noexcept {
  const double angle = mapping.gain * mapping.sign * raw + mapping.offset;
  if (!mapping.clamped || std::isnan(angle)) return angle;
  return std::clamp(angle, mapping.clamp_min, mapping.clamp_max);
}

SensorMapping identity_mapping() {
  SensorMapping mapping;
  mapping.name = "joint names";
  for (int joint = 0; joint < kJoints; ++joint) {
    JointMapping entry;
    entry.joint = joint;
    entry.source = joint_name(joint);
    mapping.joints.push_back(entry);
  }
  return mapping;
}

void check_mapping(const SensorMapping& mapping) {
  std::array<bool, kJoints> seen{};
  for (const JointMapping& entry : mapping.joints) {
    const auto fail = [&](const std::string& problem) {
      throw std::invalid_argument("mapping \"" + mapping.name + "\": " + problem);
    };
    if (entry.joint < 0 || entry.joint >= kJoints) {
      fail("joint number " + std::to_string(entry.joint) + " does not exist; the joints are 0 to " +
           std::to_string(kJoints - 1));
    }
    const std::string name(joint_name(entry.joint));
    if (seen[static_cast<std::size_t>(entry.joint)]) fail(name + " is mapped twice; keep one");
    seen[static_cast<std::size_t>(entry.joint)] = true;
    if (entry.source.empty()) fail(name + " has an empty source; name a column or sensor");
    if (entry.sign != 1.0 && entry.sign != -1.0) fail(name + ": sign must be 1 or -1");
    if (!(std::isfinite(entry.gain) && entry.gain > 0.0))
      fail(name + ": gain must be finite and above 0; use sign to turn it round");
    if (!std::isfinite(entry.offset)) fail(name + ": offset must be finite");
    if (entry.clamped && !(std::isfinite(entry.clamp_min) && std::isfinite(entry.clamp_max) &&
                           entry.clamp_min < entry.clamp_max)) {
      fail(name + ": the clamp must be finite and its first number the smaller one");
    }
  }
}

}  // namespace phalanx
