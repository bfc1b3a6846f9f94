// SPDX-License-Identifier: Apache-2.0
// Every scene that ships: it can be read, starts clear, and each grasp really touches with the digits that it
// names.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/step/haptic_step.h"
#include "scene/expect_error.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

struct Outcome {
  std::set<int> digits;    ///< in contact at the end of the hold
  std::set<int> segments;  ///< likewise
  double deepest = 0.0;    ///< [m]
  double slid = 0.0;       ///< [m]
  double weakest = 1e9;    ///< smallest of the digits' largest forces [N]
  Status status = Status::kOk;
};

/// Plays a scene up to the end of its hold.
Outcome play(const SceneDescription& scene) {
  const HapticModel model = build_model(scene);
  const Motion motion = build_motion(scene);
  HapticState state(model, scene.parameters);
  Outcome outcome;
  const ScriptedMotion& script = scene.motion.script;
  const auto ticks =
      static_cast<int>((script.start_s + script.close_s + 0.9 * script.hold_s) * scene.parameters.rate_hz);
  for (int tick = 0; tick < ticks; ++tick) {
    const double time = tick / scene.parameters.rate_hz;
    outcome.status |= step(model, scene.parameters, {time, motion.at(time)}, state);
  }
  for (int digit = 0; digit < kDigits; ++digit) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const SegmentSnapshot& segment =
          state.snapshot().segment[static_cast<std::size_t>(segment_index(digit, k))];
      if (!segment.contact) continue;
      outcome.digits.insert(digit);
      outcome.segments.insert(segment_index(digit, k));
      outcome.deepest = std::max(outcome.deepest, segment.depth);
      outcome.slid = std::max(outcome.slid, segment.slid);
      force = std::max(force, segment.force);
    }
    if (outcome.digits.count(digit) != 0) outcome.weakest = std::min(outcome.weakest, force);
  }
  return outcome;
}

const std::map<std::string, std::set<int>>& expected_digits() {
  static const std::map<std::string, std::set<int>> kDigitsOf = {{"bench_ball_100k", {0, 1, 2, 3, 4}},
                                                                 {"bench_ball_10k", {0, 1, 2, 3, 4}},
                                                                 {"bench_ball_1k", {0, 1, 2, 3, 4}},
                                                                 {"bench_mug_100k", {0, 1, 2, 3, 4}},
                                                                 {"bench_mug_10k", {0, 1, 2, 3, 4}},
                                                                 {"bench_mug_1k", {0, 1, 2, 3, 4}},
                                                                 {"first_touch", {0, 1, 2, 3, 4}},
                                                                 {"grasp_bottle", {0, 1, 2, 3, 4}},
                                                                 {"grasp_box", {0, 1, 2, 3, 4}},
                                                                 {"grasp_cup", {0, 1, 2, 3, 4}},
                                                                 {"grasp_cylinder", {0, 1, 2, 3, 4}},
                                                                 {"grasp_mug", {0, 1, 2, 3, 4}},
                                                                 {"grasp_teapot", {0, 1, 2, 3, 4}},
                                                                 {"grasp_torus", {1, 2, 3, 4}},
                                                                 {"index_ball", {1}},
                                                                 {"object_in_hand", {0, 1, 2, 3, 4}},
                                                                 {"open_jar", {0, 1, 2, 3, 4}},
                                                                 {"pinch_ball", {0, 1}},
                                                                 {"pinch_key", {0, 1}},
                                                                 {"pinch_peg", {0, 1}},
                                                                 {"pinch_slip", {0, 1}},
                                                                 {"press_teapot", {1}},
                                                                 {"sponge", {0, 1}},
                                                                 {"squeeze_ball", {0, 1, 2, 3, 4}},
                                                                 {"squeeze_putty", {0, 1, 2, 3, 4}},
                                                                 {"stability_grasp", {0, 1, 2, 3, 4}},
                                                                 {"stability_press", {1}},
                                                                 {"timing_grasp", {0, 1, 2, 3, 4}},
                                                                 {"tripod_ball", {0, 1, 2}},
                                                                 {"tripod_pen", {0, 1, 2}},
                                                                 {"turn_tap", {0, 1, 2, 3, 4}},
                                                                 {"wave", {}}};
  return kDigitsOf;
}

TEST(ShippedScenes, CanAllBeReadAndAreAllTestedHere) {
  std::set<std::string> names;
  for (const SceneInfo& info : list_scenes()) {
    EXPECT_TRUE(info.readable) << info.name << ": " << info.description;
    EXPECT_FALSE(info.description.empty()) << info.name;
    EXPECT_EQ(info.description.find('\n'), std::string::npos) << info.name;
    names.insert(info.name);
  }
  std::set<std::string> tested;
  for (const auto& [name, digits] : expected_digits()) tested.insert(name);
  EXPECT_EQ(names, tested);
}

class ShippedScene : public ::testing::TestWithParam<std::string> {};

// The contact stays put within 5 mm (static grasping), the fingers go in a few mm, and every digit is felt.
TEST_P(ShippedScene, TouchesWithTheDigitsOfItsGraspAndGently) {
  const SceneDescription scene = load_scene(GetParam());
  EXPECT_EQ(resolve(scene, {}).planned, Overrides{})
      << "the scene states another grasp than that of its hand and objects";
  const Outcome outcome = play(scene);
  EXPECT_EQ(outcome.digits, expected_digits().at(GetParam()));
  EXPECT_EQ(outcome.status, Status::kOk);
  EXPECT_LT(outcome.deepest, 8e-3);
  EXPECT_LT(outcome.slid, scene.parameters.contact.slid_distance);
  EXPECT_GT(outcome.weakest, 0.3) << "N";
}

// What docs/scenes.md begins with presses a ball as one does: with the fingertip.
TEST(ExampleOfTheDocuments, TouchesWithTheTipOfTheIndexFinger) {
  std::ifstream file(PHALANX_SOURCE_DIR "/docs/scenes.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t begin = text.find("```toml\n");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = text.find("```", begin + 3);
  const SceneDescription scene =
      parse_scene(text.substr(begin + 8, end - begin - 8), "docs/scenes.md", PHALANX_SOURCE_DIR "/docs");
  const Outcome outcome = play(scene);
  EXPECT_EQ(outcome.segments, std::set<int>{segment_index(1, 2)});
  EXPECT_EQ(outcome.status, Status::kOk);
  EXPECT_GT(outcome.weakest, 0.3) << "N";
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  int number = 0;
  for (const auto& [name, digits] : expected_digits())
    if (!test::kSlowBuild || number++ % 4 == 2) result.push_back(name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, ::testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace phalanx
