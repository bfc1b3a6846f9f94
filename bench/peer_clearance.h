// SPDX-License-Identifier: Apache-2.0
// How far a segment is from the object at least: asked anew each time, or remembered and spent.
#pragma once

#include <array>

#include "peer_engine.h"
#include "phalanx/hand/hand_model.h"
#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::bench {

enum class Pruning {
  kNone,      ///< every segment of a digit is asked for its distance at every step of the advancement
  kLikeOurs,  ///< held segments are left out, bounds are remembered, distances are capped
};

class Clearance {
 public:
  Clearance(const HandModel& hand, const TriangleMesh& object, DistanceEngine& engine, Pruning pruning);

  /// The distance of the digit's segment k from the object if it is not above `needed`, else any lower bound
  /// of it that is above `needed` [m].
  /// @param angle  the digit's angles [rad], at which the segment is placed by X_WS
  [[nodiscard]] double of(int digit, int k, const DigitAngles& angle, const Pose& X_WS, double needed);

  /// Drops what has been remembered.
  void forget();

  /// Questions that the engine has been asked.
  [[nodiscard]] long questions() const { return questions_; }

 private:
  /// What is known of a segment: at these angles it was at least (or, if exact, just) this far away.
  struct Known {
    DigitAngles angle{};
    double bound = -1.0;
    bool exact = false;
  };
  struct Sphere {
    Vec3 centre = Vec3::Zero();  ///< in the segment's frame
    double radius = 0.0;
  };
  [[nodiscard]] double root_bound(int segment, const Pose& X_WS) const;

  const HandModel& hand_;
  DistanceEngine& engine_;
  Pruning pruning_;
  std::array<Known, kSegments> known_;
  std::array<Sphere, kSegments> sphere_;
  Vec3 object_min_;
  Vec3 object_max_;
  long questions_ = 0;
};

}  // namespace phalanx::bench
