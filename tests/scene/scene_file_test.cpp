// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "phalanx/scene/scene.h"
#include "record/temporary_folder.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

using ::testing::Contains;
using ::testing::Pair;

TEST(SceneFile, NamesEveryValueOfTheFileAsAPersonWouldWriteIt) {
  const Overrides values = SceneFile("stability_grasp").with_values({}).values;
  EXPECT_THAT(values, Contains(Pair("force.stiffness_n_per_mm", "1.4")));
  EXPECT_THAT(values, Contains(Pair("objects.0.kind", "\"teapot\"")).Times(1));
  EXPECT_THAT(values, Contains(Pair("objects.0.size_mm", "130")));
  EXPECT_THAT(values, Contains(Pair("hand.position_mm", "[14, -114, 98]")));
  EXPECT_THAT(values, Contains(Pair("device.copy.middle.gain", "1.32")));
}

TEST(SceneFile, TakesAnOverridesValueForTheFiles) {
  const Overrides values = SceneFile("stability_grasp")
                               .with_values({{"force.stiffness_n_per_mm", "0.9"}, {"mirror", "true"}})
                               .values;
  EXPECT_THAT(values, Contains(Pair("force.stiffness_n_per_mm", "0.9")).Times(1));
  EXPECT_THAT(values, Contains(Pair("mirror", "true")));
}

// What is shown can be laid over the scene again and changes nothing.
TEST(SceneFile, ReadsItsValuesBackTheSame) {
  const Overrides values = SceneFile("first_touch").with_values({{"smoothing.min_n_per_s", "-inf"}}).values;
  const SceneDescription once = load_scene("first_touch", {{"smoothing.min_n_per_s", "-inf"}});
  const SceneDescription again = load_scene("first_touch", values);
  EXPECT_EQ(again.parameters.force.stiffness, once.parameters.force.stiffness);
  EXPECT_EQ(again.parameters.stabiliser.min_rate, once.parameters.stabiliser.min_rate);
  EXPECT_EQ(again.parameters.stabiliser.max_rate, once.parameters.stabiliser.max_rate);
  EXPECT_EQ(again.hand.pose.p, once.hand.pose.p);
  EXPECT_EQ(again.objects.size(), once.objects.size());
  EXPECT_EQ(SceneFile("first_touch").with_values(values).values, values);
}

TEST(SceneFile, GivesTheSceneTogetherWithItsValues) {
  const SceneFile file("rate_hz = 400\n[force]\nlaw = \"duffing\"\n", "s.toml", ".");
  const SceneWithValues read = file.with_values({{"force.stiffness_n_per_mm", "0.9"}});
  EXPECT_EQ(read.scene.parameters.rate_hz, 400.0);
  EXPECT_EQ(read.scene.parameters.force.law, ForceLaw::kDuffing);
  EXPECT_EQ(read.scene.parameters.force.stiffness, 900.0);
  EXPECT_THAT(read.values,
              ::testing::UnorderedElementsAre(Pair("rate_hz", "400"), Pair("force.law", "\"duffing\""),
                                              Pair("force.stiffness_n_per_mm", "0.9")));
  EXPECT_THROW(static_cast<void>(file.with_values({{"rate_hz", "0"}})), SceneError);
}

TEST(SceneFile, RefusesANamedPipeWithoutAWait) {
  const testing::TemporaryFolder folder;
  const std::string pipe = folder / "pipe.toml";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_scene_error([&] { static_cast<void>(SceneFile(pipe)); }, {pipe, "is not a regular file"});
}

TEST(SceneFile, SaysWhichSceneThereIsNot) {
  EXPECT_THROW(static_cast<void>(SceneFile("no_such_scene")), SceneError);
}

// The scene depends on the text and the overrides alone, not on the scenes made before.
TEST(SceneFile, GivesAKeyTheFilesValueWhereAnOverrideIsTakenAway) {
  const SceneFile file("first_touch");
  const SceneDescription plain = load_scene("first_touch");
  const SceneDescription first =
      file.scene({{"smoothing.max_n_per_s", "30"}, {"force.law", "duffing"}, {"seed", "7"}});
  EXPECT_EQ(first.parameters.force.law, ForceLaw::kDuffing);
  EXPECT_EQ(first.seed, 7U);
  const SceneDescription second =
      file.scene({{"force.stiffness_n_per_mm", "0.9"}, {"description", "'another'"}});
  EXPECT_EQ(second.parameters.force.stiffness, 900.0);
  EXPECT_EQ(second.description, "another");
  EXPECT_EQ(second.parameters.force.law, plain.parameters.force.law);
  EXPECT_EQ(second.parameters.stabiliser.max_rate, plain.parameters.stabiliser.max_rate);
  EXPECT_EQ(second.seed, plain.seed);
  EXPECT_EQ(second.objects.size(), plain.objects.size());
  EXPECT_EQ(second.hand.pose.p, plain.hand.pose.p);
}

TEST(SceneFile, OpensNoOtherFile) {
  const SceneFile file("[device]\nfile = \"none\"\n[hand]\nfile = \"none\"\n", "s.toml", ".");
  EXPECT_EQ(file.scene({}).device.file, "none");
  EXPECT_THROW(static_cast<void>(parse_scene("[device]\nfile = \"none\"\n", "s.toml", ".")), SceneError)
      << "load_scene() checks the device";
}

}  // namespace
}  // namespace phalanx
