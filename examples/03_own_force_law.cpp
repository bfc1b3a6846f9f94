// SPDX-License-Identifier: Apache-2.0
// A force law of your own: a plain function of depth and speed, with your data behind a pointer. Caps,
// stabiliser and torque limits act on it as on the built-in laws. Here a wall clicks: its force rises to a
// peak, falls, and rises again, as a push button does.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

namespace {

struct Button {
  double stiffness = 300.0;  // [N/m]
  double click = 0.4;        // height of the click [N]
  double travel = 4e-3;      // depth of the click [m]
};

// Runs in step(): no allocation, lock, exception or I/O. It must be 0 at depth 0, or the force jumps there.
double click_force(void* user, double depth, double /*speed*/) noexcept {
  const Button& button = *static_cast<const Button*>(user);
  const double force = button.stiffness * depth;
  if (depth >= button.travel) return force;
  return force + button.click * std::sin(2.0 * std::numbers::pi * depth / button.travel);
}

}  // namespace

int main() {
  TriangleMesh table;  // its top is 5 mm below the palm
  append(table, make_box({0.2, 0.02, 0.3}, 100), {.p = {0.0, -0.03, -0.1}});
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(table));

  Button button;
  HapticParameters parameters;
  parameters.force.law = ForceLaw::kOwn;
  parameters.force.own = {.function = click_force, .user = &button};
  HapticState state(model, parameters);

  double before = 0.0;
  int falls = 0;  // steps in which the force falls, although the finger presses deeper
  for (Sample sample; sample.time_s < 0.5; sample.time_s += parameters.period()) {
    sample.angle[joint_index(1, 0)] = 0.4 * sample.time_s;
    step(model, parameters, sample, state);
    double force = 0.0;
    for (const SegmentSnapshot& segment : state.snapshot().segment) force += segment.force_raw;
    if (force < before) ++falls;
    before = force;
  }
  std::printf("the force fell in %d steps, and ended at %.2f N\n", falls, before);
  return falls > 0 && before > 0.0 ? 0 : 1;
}
