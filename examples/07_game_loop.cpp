// SPDX-License-Identifier: Apache-2.0
// A game loop: the haptic thread steps 1,000 times a second, and the game draws 60 times a second. Poses and
// forces cross through a Latest, where neither thread waits for the other. A game draws the hand at gdp_pose,
// which never penetrates an object. Deadlines that have passed are left out and never made up: the rate of a
// torque is bounded for each step, so that a burst of steps would exceed it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "phalanx/core/latest.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;
using std::chrono::steady_clock;

int main() {
  TriangleMesh ball;
  append(ball, make_sphere(0.07, 2000), {.p = {0.0, -0.05, -0.13}});
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(ball));
  HapticParameters parameters;
  parameters.rate_hz = 1000.0;

  Latest<JointArray> angles;   // from the game to the haptic thread; a glove would be read there instead
  Latest<Snapshot> snapshots;  // from the haptic thread to the game
  std::jthread haptics([&](const std::stop_token& stop) {
    HapticState state(model, parameters);
    Sample sample;
    const auto begin = steady_clock::now();
    for (auto due = begin; !stop.stop_requested();) {
      std::this_thread::sleep_until(due);
      sample.time_s = std::chrono::duration<double>(steady_clock::now() - begin).count();
      if (angles.update()) sample.angle = angles.value();
      step(model, parameters, sample, state);
      snapshots.write(state.snapshot());  // a real loop sends state.snapshot().torque to the device here
      due += std::chrono::milliseconds(1);
      if (const auto now = steady_clock::now(); due < now) due = now + std::chrono::milliseconds(1);
    }
  });

  bool touched = false;
  for (int frame = 0; frame < 600 && !touched; ++frame) {
    JointArray angle{};
    for (int digit = 1; digit < kDigits; ++digit) angle[joint_index(digit, 0)] = 0.02 * std::min(frame, 60);
    angles.write(angle);
    std::this_thread::sleep_for(std::chrono::milliseconds(16));  // stands for drawing and its wait
    if (!snapshots.update()) continue;
    const Snapshot& now = snapshots.value();
    double force = 0.0;
    for (const SegmentSnapshot& segment : now.segment) force += segment.force;
    touched = force > 0.5;
    const Vec3& tip = now.gdp_pose[segment_index(2, 2)].p;  // joint of the middle finger's last segment
    if (frame % 10 == 0 || touched)
      std::printf("frame %3d  tick %5llu  joint at %6.1f mm, %.2f N\n", frame,
                  static_cast<unsigned long long>(now.tick), 1e3 * tip.y(), force);
  }
  return touched ? 0 : 1;
}
