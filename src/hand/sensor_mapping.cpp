// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/sensor_mapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace phalanx {

double mapped_angle(const JointMapping& mapping, double value) noexcept {
  const double angle = mapping.gain * mapping.sign * value + mapping.offset;
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

std::string completion_problem(const SensorMapping& mapping, const JointMapping& entry) {
  const int from = *entry.completed_from;
  if (from < 0 || from >= kJoints) {
    return "joint number " + std::to_string(from) + " does not exist; the joints are 0 to " +
           std::to_string(kJoints - 1);
  }
  const std::string digit(digit_name(digit_of_joint(entry.joint)));
  const std::string remedy = "name a measured joint of the " + digit;
  if (from == entry.joint) return "is the joint itself; " + remedy;
  if (digit_of_joint(from) != digit_of_joint(entry.joint)) return "belongs to another digit; " + remedy;
  const auto source = std::find_if(mapping.joints.begin(), mapping.joints.end(),
                                   [from](const JointMapping& other) { return other.joint == from; });
  if (source == mapping.joints.end()) return "is not measured; " + remedy + ", or give this one a source";
  if (source->completed_from) return "is itself completed; " + remedy;
  if (source->computed) return "is itself computed; " + remedy;
  return "";
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
    if (entry.completed_from) {
      if (!entry.source.empty()) fail(name + " has a source and is completed; keep one");
      if (entry.computed) fail(name + ": computed belongs to a source; leave it out");
      const std::string problem = completion_problem(mapping, entry);
      if (!problem.empty()) fail(name + ": completed_from " + problem);
    } else if (entry.source.empty()) {
      fail(name + " has an empty source; name a column or sensor");
    }
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
