// SPDX-License-Identifier: Apache-2.0
// Many hands in parallel: the model is constant and shared, and each hand has a state of its own. The library
// has no variable that a step changes, so threads need no lock, and each hand gives the same bits as if alone.
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"

using namespace phalanx;

namespace {

constexpr std::size_t kHands = 64;

/// Closes a hand around the ball, hand by hand to another angle, and returns its last torques [Nm].
JointArray grasp(const HapticModel& model, std::size_t number) {
  const HapticParameters parameters;
  HapticState state(model, parameters);
  for (Sample sample; sample.time_s < 1.0; sample.time_s += parameters.period()) {
    for (int digit = 1; digit < kDigits; ++digit) {
      sample.angle[joint_index(digit, 0)] = (0.4 + 0.005 * number) * sample.time_s;
      sample.angle[joint_index(digit, 2)] = 0.3 * sample.time_s;
    }
    step(model, parameters, sample, state);
  }
  return state.snapshot().torque;
}

}  // namespace

int main(int argc, char** argv) {
  TriangleMesh ball;
  append(ball, make_sphere(0.07, 2000), {.p = {0.0, -0.05, -0.13}});
  const HapticModel model(make_hand_model(straight_hand(), Handedness::kRight, {}, 2000), ObjectModel(ball));

  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 4;  // threads
  std::vector<JointArray> torque(kHands);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < count; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < kHands; i += count) torque[i] = grasp(model, i);
      });
  }
  std::size_t same = 0;
  std::size_t pressing = 0;
  for (std::size_t i = 0; i < kHands; ++i) {
    same += torque[i] == grasp(model, i) ? 1 : 0;
    pressing += torque[i] == JointArray{} ? 0 : 1;
  }
  std::printf("%zu hands in %zu threads: %zu press, %zu give the bits of one thread\n", kHands, count,
              pressing, same);
  return same == kHands && pressing > 0 ? 0 : 1;
}
