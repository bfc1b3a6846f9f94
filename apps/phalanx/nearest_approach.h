// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Poses of the measured hand at some 200 ticks of a run. If the run has no contact, they tell how near the
/// hand came.
class NearestApproach {
 public:
  explicit NearestApproach(std::uint64_t ticks) : every_(ticks / 200 + 1) {}

  void add(const Snapshot& snapshot);

  /// Searches the poses for the segment that came nearest to the object, which takes up to a second.
  /// @returns ": the nearest was the SEGMENT, 14 mm away; ..." with remedies; empty without an object or if
  /// a segment crossed it
  [[nodiscard]] std::string text(const HapticModel& model, const SceneDescription& scene) const;

 private:
  std::uint64_t every_;
  std::vector<std::array<Pose, kSegments>> poses_;
};

}  // namespace phalanx
