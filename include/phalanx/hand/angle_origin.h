// SPDX-License-Identifier: Apache-2.0
// Origin of a joint's angle: a sensor, a completion, or the open hand.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Origin of a joint's angle. Only a measured angle describes the wearer: no other may be scored.
enum class AngleOrigin : std::uint8_t {
  kMeasured,   ///< from a sensor of this joint, or from a scripted motion
  kCompleted,  ///< computed from other sensors: a coupling, a copied digit, a curl of the digit
  kFixed,      ///< constant, the open hand's angle
};

/// Origins of all joints' angles, in the order of joint_name(). The default is measured.
using AngleOrigins = std::array<AngleOrigin, kJoints>;

/// Returns the name in files: "measured", "completed" or "fixed".
[[nodiscard]] constexpr std::string_view angle_origin_name(AngleOrigin origin) noexcept {
  switch (origin) {
    case AngleOrigin::kMeasured:
      return "measured";
    case AngleOrigin::kCompleted:
      return "completed";
    case AngleOrigin::kFixed:
      return "fixed";
  }
  return "unknown";
}

}  // namespace phalanx
