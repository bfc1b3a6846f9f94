// SPDX-License-Identifier: Apache-2.0
// The smallest step loop: a hand above a table, an index finger that bends into it, and the torque that pushes
// it open. It needs phalanx::phalanx alone, and no file. A program with a device fills `angle` with what the
// device measures, and sends the torque to the device.
#include <cstdio>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

int main() {
  TriangleMesh table;  // its top is 5 mm below the palm
  append(table, make_box({0.2, 0.02, 0.3}, 100), {.p = {0.0, -0.03, -0.1}});

  // Constant geometry, plain parameters, and the state that one step leaves for the next.
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(table));
  const HapticParameters parameters;  // Hooke's law of 500 N/m, at 200 steps a second
  HapticState state(model, parameters);

  const int knuckle = joint_index(1, 0);  // flexion of the index finger's first joint
  for (Sample sample; sample.time_s < 0.5; sample.time_s += parameters.period()) {
    sample.angle[knuckle] = sample.time_s;  // 1 rad/s
    const Status status = step(model, parameters, sample, state);
    if (has(status, Status::kCommandNotFinite)) return 1;
  }

  const Snapshot& last = state.snapshot();
  std::printf("measured %.3f rad, shown %.3f rad, torque %.4f Nm\n", last.hcp_angle[knuckle],
              last.gdp_angle[knuckle], last.torque[knuckle]);
  return last.torque[knuckle] < 0.0 ? 0 : 1;  // it opens the finger
}
