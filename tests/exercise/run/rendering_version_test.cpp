// SPDX-License-Identifier: Apache-2.0
// The forces of a short trial in each scene of the shipped exercises, as kRenderingVersion has them.
#include "phalanx/step/rendering_version.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>

#include "phalanx/core/bit_hash.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/exercise_file.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

/// Version of the numbers below.
constexpr int kCommittedVersion = 1;
/// Sine and cosine may round otherwise in the libm of another CPU. Then the bits of forces differ, and only the sums are
/// compared, with this tolerance.
constexpr double kOtherLibm = 1e-6;
constexpr double kSeconds = 1.5;  // of the scene's motion: approach, contact and a part of the hold

struct Forces {
  const char* scene;
  std::uint64_t libm;  ///< sine_bits() of the machine on which they were made
  std::uint64_t bits;  ///< hash of all torques and forces
  double force;        ///< sum of all forces of all steps [N]
  double torque;       ///< sum of the sizes of all torques of all steps [Nm]
};

constexpr Forces kCommitted[] = {
    {"index_ball", 0x6b71a1eb366e48c3, 0x7b2341ae010fa7b8, 3041.18229, 128.956686},
    {"object_in_hand", 0x6b71a1eb366e48c3, 0xae460db8fe1ea41b, 3075.51003, 316.493391},
    {"pinch_slip", 0x6b71a1eb366e48c3, 0x3f5be12dfd22e4cb, 996.999531, 138.295695},
    {"sponge", 0x6b71a1eb366e48c3, 0x6863a1e1eb56cdec, 1201.05141, 164.807123},
    {"squeeze_ball", 0x6b71a1eb366e48c3, 0x72d3e9e18e9e3d2d, 2556.51863, 265.689748},
};

/// @returns a hash of this machine's sine and cosine
std::uint64_t sine_bits() {
  BitHash hash;
  for (int i = 0; i < 10000; ++i) {
    const double angle = (i - 5000) * 0.000628318530717;
    hash.add(std::sin(angle));
    hash.add(std::cos(angle));
  }
  return hash.value();
}

/// Plays the begin of a scene's motion at 1 kHz.
Forces played(const char* name) {
  SceneDescription scene = load_scene(name);
  scene.parameters.rate_hz = 1000.0;
  const HapticModel model = build_model(scene);
  const Motion motion = build_motion(scene);
  HapticState state(model, scene.parameters);
  Forces out{.scene = name, .libm = sine_bits(), .bits = 0, .force = 0.0, .torque = 0.0};
  BitHash hash;
  for (int tick = 0; tick < static_cast<int>(kSeconds * scene.parameters.rate_hz); ++tick) {
    const double time = tick / scene.parameters.rate_hz;
    static_cast<void>(step(model, scene.parameters, {time, motion.at(time)}, state));
    for (const double torque : state.snapshot().torque) {
      hash.add(torque);
      out.torque += std::abs(torque);
    }
    for (const SegmentSnapshot& segment : state.snapshot().segment) {
      hash.add(segment.force);
      out.force += segment.force;
    }
  }
  out.bits = hash.value();
  return out;
}

std::string row(const Forces& forces) {
  return fmt::format("    {{\"{}\", 0x{:016x}, 0x{:016x}, {:.9g}, {:.9g}}},", forces.scene, forces.libm,
                     forces.bits, forces.force, forces.torque);
}

TEST(RenderingVersion, IsRaisedWhenTheForcesOfAShortTrialChange) {
  ASSERT_EQ(kRenderingVersion, kCommittedVersion) << "enter the forces of this version in kCommitted";
  for (const Forces& committed : kCommitted) {
    const Forces now = played(committed.scene);
    const std::string remedy = fmt::format(
        "the same motion gives other forces in scene {} than in rendering version {}: raise "
        "kRenderingVersion "
        "(phalanx/step/rendering_version.h), and enter here\n{}",
        committed.scene, kCommittedVersion, row(now));
    EXPECT_GT(now.force, 0.0) << committed.scene << ": no contact";
    EXPECT_NEAR(now.force, committed.force, kOtherLibm * committed.force) << remedy;
    EXPECT_NEAR(now.torque, committed.torque, kOtherLibm * committed.torque) << remedy;
    if (now.libm == committed.libm) {
      EXPECT_EQ(now.bits, committed.bits) << remedy;
    }
  }
}

// `wave` is a motion in free air: nothing is rendered.
TEST(RenderingVersion, IsTestedInEverySceneOfAShippedExerciseWithAnObject) {
  std::set<std::string> scenes;
  for (const ExerciseInfo& exercise : list_exercises()) scenes.insert(load_exercise(exercise.name).scene);
  scenes.erase("wave");
  std::set<std::string> tested;
  for (const Forces& committed : kCommitted) tested.insert(committed.scene);
  EXPECT_EQ(tested, scenes);
}

}  // namespace
}  // namespace phalanx
