// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/hand/joints.h"

namespace phalanx {

/// Types of grasp that can be planned. Names and virtual fingers are those of the GRASP taxonomy: Feix T. et al.,
/// "The GRASP Taxonomy of Human Grasp Types", IEEE Trans. Human-Machine Systems 46(1), 2016.
enum class GraspType {
  kCylinder,  ///< palm and fingers around a long object, the thumb opposed (power)
  kSphere,    ///< palm and spread fingers around a round object, the thumb opposed (power)
  kTripod,    ///< the pads of index and middle finger against that of the thumb (precision)
  kPinch,     ///< the pad of the index finger against that of the thumb (precision)
  kLateral,   ///< the thumb's pad against the thumb's side of the flexed index finger
  kHook,      ///< the flexed fingers around a handle that pulls distally, without thumb
  kDisk,      ///< the pads of spread fingers and thumb around the rim of a flat object
};

/// What a grasp of a type must fulfil.
struct GraspRule {
  std::string_view name;
  std::array<bool, kDigits> digit{};  ///< digits that take part
  int least_fingers = 1;              ///< that must touch, the thumb not counted
  bool palm = false;                  ///< the palm must be within PlannedGrasp::kPalmGap of the object
  bool wraps = false;                 ///< the joints beyond a phalanx that touches go on closing
  bool pads = false;                  ///< each digit that takes part must touch with its distal phalanx
  bool closure = true;                ///< the contacts must have force closure
  /// Greatest cosine between the mean direction of the thumb's contacts and that of the fingers' [-].
  double most_cosine = 1.0;
};

[[nodiscard]] const GraspRule& grasp_rule(GraspType type) noexcept;
/// Returns the names of all types, in the order of GraspType.
[[nodiscard]] const std::vector<std::string>& grasp_type_names();
[[nodiscard]] std::optional<GraspType> find_grasp_type(std::string_view name) noexcept;

}  // namespace phalanx
