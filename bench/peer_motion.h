// SPDX-License-Identifier: Apache-2.0
// How a segment moves along a straight line in joint space, for the peers.
#pragma once

#include "phalanx/core/index.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx::bench {

/// The segment's velocity v(x) = angular x x + linear for each unit of the path parameter s, and bounds that
/// hold for all its points along the whole path.
struct SegmentField {
  Vec3 angular = Vec3::Zero();  ///< [rad]
  Vec3 linear = Vec3::Zero();   ///< at the world's origin [m]
  double speed = 0.0;           ///< |dx/ds| <= speed [m]
  double acceleration = 0.0;    ///< |d2x/ds2| <= acceleration [m]

  /// Speed of the point x of the segment against the unit vector n [m].
  [[nodiscard]] double closing(const Vec3& n, const Vec3& x) const {
    return -n.dot(angular.cross(x) + linear);
  }
};

/// The field of a digit's segment k at `pose` when its joints turn at `rate` [rad for each unit of s]:
/// |dx/ds| <= sum_j w_j R_jk and |d2x/ds2| <= sum_j w_j (2 R_jk sum_{i<j} w_i + sum_{i>=j} w_i R_ik), with
/// w_j = |rate_j| and R_jk = HandModel::reach().
[[nodiscard]] SegmentField field_of(const HandModel& hand, int digit, int k, const DigitPose& pose,
                                    const DigitAngles& rate);

/// How far any point of the digit's segment k can have come when its joints turned from `a` to `b` [m].
[[nodiscard]] double travel(const HandModel& hand, int digit, int k, const DigitAngles& a,
                            const DigitAngles& b);

/// The largest h >= 0 such that height - v h - A h^2 / 2 >= floor up to h.
[[nodiscard]] double safe_step(double height, double v, double A, double floor);

}  // namespace phalanx::bench
