// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/scene_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "phalanx/scene/scene_error.h"

namespace phalanx {
namespace {

using ::testing::Contains;
using ::testing::Pair;

TEST(SceneValues, NameEveryValueOfTheFileAsAPersonWouldWriteIt) {
  const Overrides values = scene_values("stability_grasp", {});
  EXPECT_THAT(values, Contains(Pair("force.stiffness_n_per_mm", "1.4")));
  EXPECT_THAT(values, Contains(Pair("objects.0.kind", "\"teapot\"")).Times(1));
  EXPECT_THAT(values, Contains(Pair("objects.0.size_mm", "130")));
  EXPECT_THAT(values, Contains(Pair("hand.position_mm", "[14, -114, 98]")));
  EXPECT_THAT(values, Contains(Pair("device.copy.middle.gain", "1.32")));
}

TEST(SceneValues, TakeAnOverridesWordForTheFiles) {
  const Overrides values =
      scene_values("stability_grasp", {{"force.stiffness_n_per_mm", "0.9"}, {"smoothing.enabled", "false"}});
  EXPECT_THAT(values, Contains(Pair("force.stiffness_n_per_mm", "0.9")).Times(1));
  EXPECT_THAT(values, Contains(Pair("smoothing.enabled", "false")));
}

// What is shown can be laid over the scene again and changes nothing.
TEST(SceneValues, ReadBackTheSame) {
  const Overrides values = scene_values("first_touch", {{"smoothing.min_n_per_s", "-inf"}});
  const SceneDescription once = load_scene("first_touch", {{"smoothing.min_n_per_s", "-inf"}});
  const SceneDescription again = load_scene("first_touch", values);
  EXPECT_EQ(again.force.stiffness, once.force.stiffness);
  EXPECT_EQ(again.smoothing.min_rate, once.smoothing.min_rate);
  EXPECT_EQ(again.smoothing.max_rate, once.smoothing.max_rate);
  EXPECT_EQ(again.hand.pose.p, once.hand.pose.p);
  EXPECT_EQ(again.objects.size(), once.objects.size());
  EXPECT_EQ(scene_values("first_touch", values), values);
}

TEST(SceneValues, SayWhichSceneThereIsNot) {
  EXPECT_THROW(static_cast<void>(scene_values("no_such_scene", {})), SceneError);
}

}  // namespace
}  // namespace phalanx
