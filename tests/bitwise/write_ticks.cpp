// SPDX-License-Identifier: Apache-2.0
// Writes ticks.csv of three scenes into a folder. Compiled at several optimisation levels, whose files must
// be equal to the last bit.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "phalanx/record/ticks_csv.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace {

/// Returns the number of contacts seen, so that an empty scene cannot pass for equality.
int write(const std::string& name, const std::filesystem::path& folder) {
  const phalanx::SceneDescription scene = phalanx::load_scene(name);
  const phalanx::HapticModel model = phalanx::build_model(scene);
  const phalanx::Motion motion = phalanx::build_motion(scene);
  phalanx::HapticState state(model, scene.parameters);
  phalanx::TicksCsv csv(folder / (name + ".csv"));
  int contacts = 0;
  const int ticks = static_cast<int>(motion.duration() * scene.parameters.rate_hz);
  for (int n = 0; n <= ticks; ++n) {
    const double t = n / scene.parameters.rate_hz;
    phalanx::step(model, scene.parameters, {t, motion.at(t)}, state);
    csv.write(state.snapshot());
    for (const phalanx::SegmentSnapshot& segment : state.snapshot().segment)
      contacts += segment.contact ? 1 : 0;
  }
  csv.commit();
  return contacts;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  for (const char* scene : {"grasp_teapot", "press_teapot", "grasp_mug"}) {
    const int contacts = write(scene, folder);
    std::printf("%s: %d contacts\n", scene, contacts);
    if (contacts < 100) return 1;
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
