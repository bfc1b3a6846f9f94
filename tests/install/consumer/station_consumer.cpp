// SPDX-License-Identifier: Apache-2.0
// Uses phalanx::station as installed: reads an installed scene and runs it. What it needs of phalanx::phalanx
// must come by itself.
#include <cmath>
#include <cstdio>
#include <exception>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"

int main() try {
  const auto scene = phalanx::load_scene("grasp_teapot");
  const auto motion = phalanx::build_motion(scene);
  const auto model = phalanx::build_model(scene);
  phalanx::HapticState state(model, scene.parameters);
  phalanx::Sample sample;
  sample.time_s = 1.0 / scene.parameters.rate_hz;
  sample.angle = model.hand.parameters().open_angle;
  phalanx::step(model, scene.parameters, sample, state);
  std::printf("%d hand and %d object triangles, motion of %.2f s\n", model.hand.triangle_count(),
              model.object.triangle_count(), phalanx::simulation_seconds(scene, motion));
  for (const double torque : state.snapshot().torque) {
    if (!std::isfinite(torque)) return 1;
  }
  return model.hand.triangle_count() > 0 && model.object.triangle_count() > 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
