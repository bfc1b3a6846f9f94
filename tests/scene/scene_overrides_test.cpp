// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "phalanx/scene/scene.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

constexpr const char* kText = R"(rate_hz = 200
[force]
law = "hooke"
[[objects]]
kind = "sphere"
diameter_mm = 40
)";

SceneDescription parse_with(const Overrides& overrides) {
  return parse_scene(kText, "test.toml", "/somewhere", overrides);
}

TEST(Overrides, ReplaceWhatTheFileStates) {
  EXPECT_EQ(parse_with({{"rate_hz", "1000"}}).parameters.rate_hz, 1000.0);
}

TEST(Overrides, AddWhatItDoesNotState) {
  EXPECT_EQ(parse_with({{"limits.fingertip_force_n", "10"}}).parameters.limits.fingertip_force, 10.0);
  EXPECT_TRUE(parse_with({{"mirror", "true"}}).mirror);
}

TEST(Overrides, NeedNoQuotesForWords) {
  EXPECT_EQ(parse_with({{"force.law", "duffing"}}).parameters.force.law, ForceLaw::kDuffing);
  EXPECT_EQ(parse_with({{"force.law", "\"duffing\""}}).parameters.force.law, ForceLaw::kDuffing);
  EXPECT_FALSE(parse_with({{"limits.torque_rate_nm_per_s", "off"}}).parameters.limits.torque_rate_enabled);
}

TEST(Overrides, ReachElementsOfAnArray) {
  EXPECT_DOUBLE_EQ(parse_with({{"objects.0.diameter_mm", "80"}}).objects[0].diameter, 0.08);
  EXPECT_DOUBLE_EQ(parse_with({{"objects.0.position_mm", "[1, 2, 3]"}}).objects[0].pose.p.z(), 0.003);
}

TEST(Overrides, AppendAnElementOnePastTheEnd) {
  const SceneDescription scene =
      parse_with({{"objects.1.kind", "torus"}, {"objects.1.tube_diameter_mm", "10"}});
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[1].kind, "torus");
  EXPECT_DOUBLE_EQ(scene.objects[1].tube_diameter, 0.01);
}

TEST(Overrides, BeginAnArrayThatTheFileDoesNotHave) {
  const SceneDescription scene = parse_scene("", "test.toml", "/somewhere",
                                             {{"objects.0.kind", "sphere"}, {"objects.0.diameter_mm", "30"}});
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].kind, "sphere");
  EXPECT_DOUBLE_EQ(scene.objects[0].diameter, 0.03);
}

TEST(Overrides, ReplaceAWholeArray) {
  const SceneDescription scene = parse_with({{"objects", "[{kind = \"box\"}, {kind = \"mug\"}]"}});
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[1].kind, "mug");
}

TEST(Overrides, TakeTheLastOfSeveral) {
  EXPECT_EQ(parse_with({{"rate_hz", "1000"}, {"rate_hz", "500"}}).parameters.rate_hz, 500.0);
}

TEST(Overrides, ResolvePathsAgainstTheWorkingDirectory) {
  const auto here = std::filesystem::current_path();
  EXPECT_EQ(parse_with({{"motion.file", "m.csv"}}).motion.file, here / "m.csv");
  EXPECT_EQ(parse_with({{"objects", "[{kind = \"file\", file = \"o.obj\"}]"}}).objects[0].file,
            here / "o.obj");
  EXPECT_EQ(parse_with({{"motion.mapping", "cyberglove"}}).motion.mapping, "cyberglove");
  EXPECT_EQ(parse_with({{"motion.mapping", "./mine.toml"}}).motion.mapping, (here / "mine.toml").string());
}

TEST(Overrides, AreCheckedLikeTheFile) {
  expect_scene_error([] { static_cast<void>(parse_with({{"rate_hz", "0"}})); },
                     {"--set rate_hz=0", "rate_hz = 0", ">= 1, <= 4000"});
  expect_scene_error([] { static_cast<void>(parse_with({{"force.stifness", "1"}})); },
                     {"--set force.stifness=1", "nearest known one is force.stiffness_n_per_mm"});
  expect_scene_error([] { static_cast<void>(parse_with({{"objects.0.diameter_mm", "-1"}})); },
                     {"--set objects.0.diameter_mm=-1", "> 0"});
  expect_scene_error([] { static_cast<void>(parse_with({{"objects", "[{kind = \"spere\"}]"}})); },
                     {"--set objects=[{kind = \"spere\"}]: objects.0.kind", "sphere"});
  expect_scene_error([] { static_cast<void>(parse_with({{"force.stiffness_n_per_mm", "1\nrate_hz = 5"}})); },
                     {"is a string"});
}

TEST(Overrides, RefuseAPathThatLeadsNowhere) {
  expect_scene_error([] { static_cast<void>(parse_with({{"objects.5.kind", "box"}})); },
                     {"--set objects.5.kind=box", "from 0 to 1"});
  expect_scene_error([] { static_cast<void>(parse_with({{"rate_hz.x", "1"}})); },
                     {"--set rate_hz.x=1", "has no parts"});
  expect_scene_error([] { static_cast<void>(parse_with({{"force..law", "1"}})); }, {"empty part"});
  expect_scene_error([] { static_cast<void>(parse_with({{"", "1"}})); }, {"empty part"});
}

TEST(Overrides, AreSplitAtTheFirstEqualsSign) {
  EXPECT_EQ(parse_override("description=a=b"), (std::pair<std::string, std::string>("description", "a=b")));
  EXPECT_EQ(parse_override("rate_hz = 5"), (std::pair<std::string, std::string>("rate_hz", "5")));
  expect_scene_error([] { static_cast<void>(parse_override("rate_hz")); }, {"rate_hz", "KEY=VALUE"});
  expect_scene_error([] { static_cast<void>(parse_override("=5")); }, {"KEY=VALUE"});
}

}  // namespace
}  // namespace phalanx
