// SPDX-License-Identifier: Apache-2.0
// A stabiliser of your own: a plain function from the law's force to the force that is sent. Its state is in
// the contact's memory, which is zero when a contact begins. Here the force rises by at most a part of itself
// each step, and falls at once.
#include <algorithm>
#include <cstdio>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

namespace {

struct Rise {
  double ratio = 1.1;   // largest ratio of a force to the one before it
  double least = 0.02;  // a rise of so much is always allowed [N]
};

// Runs in step(): no allocation, lock, exception or I/O. Caps and torque limits follow.
double rise(void* user, const StabiliserInput& input, StabiliserMemory& memory) noexcept {
  const Rise& bound = *static_cast<const Rise*>(user);
  double& last = memory.own[0];
  last = std::min(input.force, std::max(bound.ratio * last, last + bound.least));
  return last;
}

}  // namespace

int main() {
  TriangleMesh table;  // its top is 5 mm below the palm
  append(table, make_box({0.2, 0.02, 0.3}, 100), {.p = {0.0, -0.03, -0.1}});
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(table));

  Rise bound;
  HapticParameters parameters;
  parameters.stabiliser.method = Stabiliser::kOwn;
  parameters.stabiliser.own = {.function = rise, .user = &bound};
  HapticState state(model, parameters);

  bool delayed = false;
  double last = 0.0;
  for (Sample sample; sample.time_s < 0.5; sample.time_s += parameters.period()) {
    sample.angle[joint_index(1, 0)] = std::min(0.3, 2.0 * sample.time_s);
    step(model, parameters, sample, state);
    double law = 0.0;
    double sent = 0.0;
    for (const SegmentSnapshot& segment : state.snapshot().segment) {
      law += segment.force_raw;
      sent += segment.force;
    }
    delayed = delayed || sent < law;
    last = sent;
  }
  std::printf("%.2f N are sent; while it rose, the force was %s the law's\n", last,
              delayed ? "below" : "equal to");
  return delayed && last > 0.0 ? 0 : 1;
}
