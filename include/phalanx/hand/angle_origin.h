// SPDX-License-Identifier: Apache-2.0
// Origin of a joint's angle: a sensor, a completion, a constant, or a script.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Origin of a joint's angle. Only a measured angle may be scored.
enum class AngleOrigin : std::uint8_t {
  kUnknown,    ///< not stated, as before the first sample
  kMeasured,   ///< from a sensor of this joint, real or simulated
  kCompleted,  ///< computed from other sensors: a relation of joints, a copied digit, a curl of the digit
  kFixed,      ///< constant
  kScripted,   ///< from a scripted motion
};

/// Origins of all joints' angles, in the order of joint_name(). The default is unknown.
using AngleOrigins = std::array<AngleOrigin, kJoints>;

/// Returns the name in files: "unknown", "measured", "completed", "fixed" or "scripted".
[[nodiscard]] constexpr std::string_view angle_origin_name(AngleOrigin origin) noexcept {
  switch (origin) {
    case AngleOrigin::kUnknown:
      return "unknown";
    case AngleOrigin::kMeasured:
      return "measured";
    case AngleOrigin::kCompleted:
      return "completed";
    case AngleOrigin::kFixed:
      return "fixed";
    case AngleOrigin::kScripted:
      return "scripted";
  }
  return "unknown";
}

}  // namespace phalanx
