// SPDX-License-Identifier: Apache-2.0
// Simple hands at a floor and at a ball, under a stabiliser.
#pragma once

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"

namespace phalanx::test {

/// A slab 20 mm below the straight index finger.
inline Setup floor_model(Stabiliser method) {
  Setup model(simple_hand(), ObjectModel(moved(make_box(Vec3(0.06, 0.02, 0.3), 12), at(0.0, -0.030, 0.0))));
  model.parameters.stabiliser.method = method;
  return model;
}

/// A ball under the proximal phalanx, which the whole finger can close around.
inline Setup ball_model(Stabiliser method) {
  Setup model(simple_hand(), ObjectModel(moved(make_sphere(0.03, 2000), at(0.0, -0.028, -0.028))));
  model.parameters.stabiliser.method = method;
  return model;
}

/// Around the ball and open again, `n` from 0 to 300.
inline JointArray grasp(int n) {
  const double close = n <= 150 ? n / 150.0 : (300 - n) / 150.0;
  return index_angles(1.0 * close, 1.6 * close, 1.6 * close, 0.1 * close);
}

}  // namespace phalanx::test
