// SPDX-License-Identifier: Apache-2.0
// A lone finger in sliding mode, and a press of it.
#pragma once

#include <utility>

#include "phalanx/mesh/primitives.h"
#include "support/lone_finger.h"
#include "support/sanitized.h"

namespace phalanx::test {

/// A lone finger in sliding mode, with 0.5 N/mm.
inline LoneFinger sliding_finger(TriangleMesh object, double mu) {
  LoneFinger finger(ObjectModel(std::move(object)));
  finger.model().parameters.contact.mode = ContactMode::kSliding;
  finger.model().parameters.contact.friction = mu;
  finger.model().parameters.force.stiffness = 500.0;
  return finger;
}

/// A block whose top is z = 0, 30 mm long along the finger.
inline TriangleMesh block(double breadth, double height, int triangles = 12) {
  return moved(make_box({breadth, 0.03, height}, triangles), at(0.0, 0.009, -0.5 * height));
}

/// A ball of 60 mm below the origin.
inline TriangleMesh ball() {
  return moved(make_sphere(0.06, kSlowBuild ? 1000 : 20000), at(0.0, 0.0, -0.03));
}

/// Places the fingertip 2 mm above the origin, and presses by `depth` below the place where it touches.
struct Pressed {
  Pressed(LoneFinger& finger, double depth)
      : first(finger.aim({.from = Vec3(0.0, 0.0, LoneFinger::kTipRadius + 2e-3)})), hand(finger.model()) {
    double angle = first;
    hand.tick(LoneFinger::pose(angle));
    while (LoneFinger::contacts(hand.now()) == 0 && angle < first + 0.2) {
      angle += 0.05e-3 / LoneFinger::lever();
      hand.tick(LoneFinger::pose(angle));
    }
    touched = angle;
    goal = touched + depth / LoneFinger::lever();
    hand.move(LoneFinger::pose(goal), 200);
    rest(100);
  }
  void rest(int ticks) {
    for (int i = 0; i < ticks; ++i) hand.tick(hand.now().hcp_angle);
  }
  [[nodiscard]] const SegmentSnapshot& tip() const { return index_segment(hand.now(), 2); }

  double first;  ///< angle of the first joint at the start [rad]
  Runner hand;
  double touched = 0.0;  ///< the same where it first touched [rad]
  double goal = 0.0;     ///< the same where it is pressed [rad]
};

/// Returns where the contact's material point of the shown finger is on the measured one [m].
inline Vec3 on_measured(const Snapshot& s, int k) {
  const auto segment = static_cast<std::size_t>(segment_index(kIndex, k));
  return s.hcp_pose[segment] * (s.gdp_pose[segment].inverse() * index_segment(s, k).point);
}

/// Returns the sum of the forces of the law on the index finger's segments [N].
inline double raw_force(const Snapshot& s) {
  double sum = 0.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) sum += index_segment(s, k).force_raw;
  return sum;
}

}  // namespace phalanx::test
