// SPDX-License-Identifier: Apache-2.0
// step_hash [SCENE [KEY=VALUE]]: the steps of examples/c/step_loop.c by the C++ library alone, without the C
// interface. Prints the same line up to the hash of torques and forces, and the largest torque.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace {

class Fnv {
 public:
  void add(double number) {
    auto bits = std::bit_cast<std::uint64_t>(number);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8U) value_ = (value_ ^ (bits & 0xffU)) * 0x100000001b3U;
  }
  [[nodiscard]] unsigned long long value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

int run(const std::string& name, const phalanx::Overrides& overrides) {
  const phalanx::SceneDescription scene = phalanx::load_scene(name, overrides);
  const phalanx::HapticModel model = phalanx::build_model(scene);
  const phalanx::Motion motion = phalanx::build_motion(scene);
  const double rate = scene.parameters.rate_hz;
  const auto steps = std::lround(phalanx::simulation_seconds(scene, motion) * rate);
  phalanx::HapticState state(model, scene.parameters);
  Fnv forces;
  double largest = 0.0;
  for (long i = 0; i < steps; ++i) {
    const double time = static_cast<double>(i) / rate;
    step(model, scene.parameters,
         {.time_s = time, .angle = motion.at(time), .angle_origin = motion.angle_origin}, state);
    const phalanx::Snapshot& now = state.snapshot();
    for (const double torque : now.torque) {
      forces.add(torque);
      largest = std::max(largest, std::abs(torque));
    }
    for (const phalanx::SegmentSnapshot& segment : now.segment) {
      forces.add(segment.force);
      for (int k = 0; k < 3; ++k) forces.add(segment.point[k]);
      for (int k = 0; k < 3; ++k) forces.add(segment.normal[k]);
    }
  }
  std::printf("%ld steps, forces %016llx\nlargest torque %.4f Nm\n", steps, forces.value(), largest);
  return largest > 0.01 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  phalanx::Overrides overrides;
  if (argc > 2) overrides.push_back(phalanx::parse_override(argv[2]));
  return run(argc > 1 ? argv[1] : "press_teapot", overrides);
} catch (const std::exception& error) {
  std::fprintf(stderr, "step_hash: %s\n", error.what());
  return 1;
}
