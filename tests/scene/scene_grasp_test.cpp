// SPDX-License-Identifier: Apache-2.0
// Scenes with a planned grasp: when it is planned, what it is planned for, and what is refused.
#include "phalanx/scene/scene_grasp.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene_file.h"
#include "phalanx/step/haptic_step.h"
#include "scene/expect_error.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using ::testing::IsEmpty;

/// A tripod grasp of a ball, seldom of more than a third of a second to plan.
constexpr const char* kBall = R"(
[grasp]
type = "tripod"
[[objects]]
kind = "sphere"
diameter_mm = 45
)";

SceneFile ball_file() { return SceneFile(kBall, "ball.toml", PHALANX_SOURCE_DIR); }

/// @returns the digits in contact at the end of the hold
std::vector<int> touching_digits(const SceneDescription& scene) {
  const HapticModel model = build_model(scene);
  const Motion motion = build_motion(scene);
  HapticState state(model, scene.parameters);
  const ScriptedMotion& script = scene.motion.script;
  const double end = script.start_s + script.close_s + 0.9 * script.hold_s;
  for (int tick = 0; tick < static_cast<int>(end * scene.parameters.rate_hz); ++tick) {
    const double time = tick / scene.parameters.rate_hz;
    EXPECT_EQ(step(model, scene.parameters, {time, motion.at(time)}, state), Status::kOk);
  }
  std::vector<int> digits;
  for (int digit = 0; digit < kDigits; ++digit)
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      if (state.snapshot().segment[idx(segment_index(digit, k))].contact &&
          (digits.empty() || digits.back() != digit))
        digits.push_back(digit);
  return digits;
}

TEST(SceneGrasp, IsPlannedWhenTheSceneStatesOnlyItsType) {
  const SceneDescription scene = ball_file().scene({});
  EXPECT_EQ(scene.motion.script.name, "posture");
  EXPECT_EQ(scene.motion.script.closure, 1.0);
  const ResolvedScene resolved = resolve(scene, {.motion = true});
  EXPECT_FALSE(resolved.planned.empty());
  EXPECT_EQ(touching_digits(resolved.description), (std::vector<int>{0, 1, 2}));
}

// A scene that states what was planned is the same scene to the last bit, and plans nothing.
TEST(SceneGrasp, OfTheStatedHandAndObjectIsTakenFromTheScene) {
  const SceneFile file = ball_file();
  const ResolvedScene planned = resolve(file.scene({}), {.motion = true});
  const ResolvedScene stated = resolve(file.scene(planned.planned), {.motion = true});
  EXPECT_THAT(stated.planned, IsEmpty());
  EXPECT_EQ(stated.X_WH.p, planned.X_WH.p);
  EXPECT_EQ(stated.X_WH.R, planned.X_WH.R);
  EXPECT_EQ(stated.motion->angle, planned.motion->angle);
  Overrides moved = planned.planned;
  moved.emplace_back("hand.position_mm", "[0, 0, 500]");
  EXPECT_EQ(resolve(file.scene(moved), {}).X_WH.p.z(), 0.5) << "what the scene states is not checked again";
}

TEST(SceneGrasp, IsPlannedAgainForAnotherHandObjectTypeSeedOrDirection) {
  const SceneFile file = ball_file();
  const Overrides planned = resolve(file.scene({}), {}).planned;
  int tried = 0;
  for (const auto& [key, value] : Overrides{{"hand.profile", "\"small-woman\""},
                                            {"objects.0.diameter_mm", "46"},
                                            {"grasp.type", "\"pinch\""},
                                            {"grasp.seed", "2"},
                                            {"grasp.other_types", "true"},
                                            {"hand.side", "\"left\""},
                                            {"grasp.forearm", "[0, -1, 0]"},
                                            {"grasp.palm", "[0, 0, -1]"}}) {
    if (test::kSlowBuild && ++tried > 3) break;
    Overrides changed = planned;
    changed.emplace_back(key, value);
    EXPECT_NE(resolve(file.scene(changed), {}).planned, Overrides{}) << key;
  }
  // The other side is another direction.
  Overrides to_left = {{"grasp.palm", "[-1, 0, 0]"}};
  const Overrides from_right = resolve(file.scene(to_left), {}).planned;
  to_left.insert(to_left.end(), from_right.begin(), from_right.end());
  EXPECT_EQ(resolve(file.scene(to_left), {}).planned, Overrides{});
  to_left.emplace_back("grasp.palm", "[1, 0, 0]");
  EXPECT_NE(resolve(file.scene(to_left), {}).planned, Overrides{});
}

TEST(SceneGrasp, PlannedBeforeIsTakenWhereItFits) {
  const SceneFile file = ball_file();
  Overrides planned = resolve(file.scene({}), {}).planned;
  for (auto& [key, value] : planned)
    if (key == "hand.position_mm") value = "[1, 2, 300]";
  EXPECT_EQ(resolve(file.scene({}), {.planned = &planned}).X_WH.p.z(), 0.3);
  EXPECT_NE(resolve(file.scene({{"grasp.seed", "2"}}), {.planned = &planned}).X_WH.p.z(), 0.3);
}

TEST(SceneGrasp, OfAMirroredSceneIsItsMirrorImage) {
  const SceneFile file = ball_file();
  const Overrides right = resolve(file.scene({}), {}).planned;
  Overrides left = right;
  left.emplace_back("mirror", "true");
  const ResolvedScene mirrored = resolve(file.scene(left), {.motion = true});
  EXPECT_THAT(mirrored.planned, IsEmpty());
  EXPECT_EQ(mirrored.X_WH.p.x(), -mirrored.description.hand.pose.p.x());
  EXPECT_EQ(touching_digits(file.scene(left)), (std::vector<int>{0, 1, 2}));
}

TEST(SceneGrasp, ComesFromTheStatedSides) {
  for (const char* mirror : {"false", "true"}) {
    const SceneDescription scene = ball_file().scene(
        {{"grasp.forearm", "[0.6, -1, 0]"}, {"grasp.palm", "[0, 0, -1]"}, {"mirror", mirror}});
    const Mat3 R = resolve(scene, {}).description.hand.pose.R;
    EXPECT_GE(R.col(2).dot(Vec3(0.6, -1.0, 0.0).normalized()), std::cos(45.1 * kDeg)) << mirror;
    EXPECT_GE(R(2, 1), std::cos(45.1 * kDeg)) << mirror;
  }
}

TEST(SceneGrasp, DigitsThatTheDeviceLacksGoAlongTheirWay) {
  const ResolvedScene resolved = resolve(ball_file().scene({}), {.device = true, .motion = true});
  const JointArray& open = resolved.hand.parameters.open_angle;
  const Motion& motion = resolved.motion.value();
  const JointArray held =
      motion.at(resolved.description.motion.script.start_s + resolved.description.motion.script.close_s);
  const std::array<DigitCopy, kDigits>& copy = resolved.exoskeleton->controller.copy;
  ASSERT_EQ(copy[2].of, 1);
  for (int i = 0; i < kJointsPerDigit; ++i) {
    for (const auto& [digit, way] : {std::pair{2, copy[2].way}, {1, copy[2].way_of}}) {
      const std::size_t j = idx(joint_index(digit, i));
      EXPECT_NEAR(way[idx(i)], held[j] - open[j], 1e-9) << joint_name(static_cast<int>(j));
    }
  }
  EXPECT_EQ(copy[0].way_of, DigitAngles{}) << "the thumb has joints of its own";
  const SceneDescription scripted = load_scene("timing_grasp");
  EXPECT_EQ(resolve(scripted, {.device = true}).exoskeleton->controller.copy[2].way_of, DigitAngles{});
}

TEST(SceneGrasp, ThatIsNotFoundIsRefusedWithTheCondition) {
  const SceneDescription scene = ball_file().scene({{"objects.0.diameter_mm", "400"}});
  expect_scene_error(
      [&] { static_cast<void>(resolve(scene, {})); },
      {"ball.toml:3: grasp.type", "no tripod grasp by adult", "the digits reach the object", "smaller"});
}

TEST(SceneGrasp, OfAnotherTypeIsTakenWhereTheSceneAllowsIt) {
  const Overrides small = {{"objects.0.diameter_mm", "20"}, {"grasp.type", "\"sphere\""}};
  expect_scene_error([&] { static_cast<void>(resolve(ball_file().scene(small), {})); },
                     {"no sphere grasp by adult"});
  Overrides any = small;
  any.emplace_back("grasp.other_types", "true");
  const ResolvedScene resolved = resolve(ball_file().scene(any), {});
  EXPECT_EQ(resolved.planned_type, GraspType::kTripod) << "after kCylinder, of which there is none either";
  EXPECT_EQ(touching_digits(resolved.description), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(resolve(ball_file().scene({{"grasp.other_types", "true"}}), {}).planned_type, GraspType::kTripod)
      << "the stated type goes first, before kCylinder";
  any.emplace_back("objects.0.diameter_mm", "400");
  expect_scene_error([&] { static_cast<void>(resolve(ball_file().scene(any), {})); },
                     {"no sphere grasp by adult", "Other types: cylinder: none fulfils ", "; disk: none"});
}

TEST(SceneGrasp, NeedsAnObjectAndItsOwnMotion) {
  const SceneDescription bare =
      SceneFile("[grasp]\ntype = \"hook\"", "bare.toml", PHALANX_SOURCE_DIR).scene({});
  expect_scene_error([&] { static_cast<void>(resolve(bare, {})); }, {"bare.toml:2: grasp.type", "no object"});
  expect_scene_error([&] { static_cast<void>(ball_file().scene({{"motion.name", "wave"}})); },
                     {"motion.name", "posture", "ball.toml:3"});
}

}  // namespace
}  // namespace phalanx
