// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a motion file holds, reading it ends in a motion that keeps its invariant or in an error
// with a message. The first byte chooses the trial (0: none) and whether the file goes through a mapping.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "phalanx/scene/motion_file.h"
#include "phalanx/scene/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::optional<int> trial;
  if (data[0] % 4 != 0) trial = data[0] % 4;
  std::optional<phalanx::SensorMapping> mapping;
  if (data[0] % 8 >= 4) {
    mapping.emplace();
    mapping->joints.resize(2);
    mapping->joints[0].joint = 6;
    mapping->joints[0].source = "a";
    mapping->joints[1].joint = 7;
    mapping->joints[1].gain = 1.5;
    mapping->joints[1].completed_from = 6;
  }
  try {
    const phalanx::Motion motion = phalanx::parse_motion(text, "fuzz.csv", mapping, trial);
    phalanx::check_motion(motion);  // throws std::invalid_argument, which nothing here catches
    static_cast<void>(motion.at(0.5 * motion.duration()));
  } catch (const phalanx::SceneError& error) {
    if (error.what()[0] == '\0') std::abort();
  }
  return 0;
}
