// SPDX-License-Identifier: Apache-2.0
// What is just inside a limit of the files that a scene reads, and what is just outside.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "phalanx/scene/build_model.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/motion_file.h"
#include "phalanx/scene/scene.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

// A row of 65,536 characters is read, one of 65,537 is not: blanks at its end make it so long.
TEST(SceneBounds, ALineOfACsvFileHas65536CharactersAtMost) {
  const auto text_of = [](std::size_t characters) {
    std::string row = "0,0.5";
    row.resize(characters, ' ');
    return "time_s,index_pip_flexion\n" + row + "\n";
  };
  EXPECT_EQ(parse_motion(text_of(65'536), "m.csv").time_s.size(), 1U);
  expect_scene_error([&] { static_cast<void>(parse_motion(text_of(65'537), "m.csv")); },
                     {"m.csv:2", "65537 characters"});
}

// A full turn either way is the most that is believed.
TEST(SceneBounds, AnAngleOfAMotionIsAFullTurnAtMostEitherWay) {
  const auto read = [](const std::string& angle) {
    return parse_motion("time_s,index_pip_flexion\n0," + angle + "\n", "m.csv");
  };
  for (const char* angle : {"6.28", "-6.28"}) EXPECT_EQ(read(angle).time_s.size(), 1U) << angle;
  for (const char* angle : {"6.29", "-6.29", "90", "-90"})
    expect_scene_error([&] { static_cast<void>(read(angle)); }, {"m.csv:2", "more than a full turn"});
}

TEST(SceneBounds, ATorusHasATubeThinnerThanItsRing) {
  const auto read = [](const std::string& tube) {
    return parse_scene("[[objects]]\nkind = \"torus\"\nring_diameter_mm = 20\ntube_diameter_mm = " + tube,
                       "bad.toml", ".");
  };
  EXPECT_EQ(read("19.9").objects.size(), 1U);
  expect_scene_error([&] { static_cast<void>(read("20")); }, {"tube_diameter_mm = 20", "thinner"});
}

// The count is looked at before anything is made: an object of no known kind is refused for its kind only if
// the count is not too large.
TEST(SceneBounds, ASceneMayHaveSoManyTrianglesAndNotOneMore) {
  const auto scene_of = [](int triangles) {
    SceneDescription scene;
    scene.objects.resize(2);
    for (ObjectDescription& object : scene.objects) object.kind = "none";
    scene.objects[0].triangles = 1'000'000;
    scene.objects[1].triangles = triangles;
    return scene;
  };
  static_assert(kMostSceneTriangles == 4'000'000);
  expect_scene_error([&] { static_cast<void>(make_world_mesh(scene_of(3'000'000))); },
                     {"is no kind of object"});
  expect_scene_error([&] { static_cast<void>(make_world_mesh(scene_of(3'000'001))); },
                     {"objects[1]", "4000001"});
}

// Both spheres of a capsule are seen where it is longer than the difference of their radii: 10 - 5 mm.
TEST(SceneBounds, ASegmentIsLongerThanTheDifferenceOfItsRadii) {
  std::ifstream in(PHALANX_SOURCE_DIR "/assets/hands/adult.toml");
  std::stringstream text;
  text << in.rdbuf();
  const auto read = [&](const std::string& length) {
    const std::string first = "length_mm = 46.22, radius_base_mm = 13.0,  radius_tip_mm = 11.5";
    std::string hand = text.str();
    const std::size_t at = hand.find(first);
    EXPECT_NE(at, std::string::npos);
    hand.replace(at, first.size(), "length_mm = " + length + ", radius_base_mm = 10, radius_tip_mm = 5");
    return parse_hand(hand, "hand.toml");
  };
  EXPECT_DOUBLE_EQ(read("5.001").segments[0].length, 5.001e-3);
  expect_scene_error([&] { static_cast<void>(read("5")); }, {"length_mm = 5", "contains the other"});
  expect_scene_error([&] { static_cast<void>(read("4.999")); }, {"length_mm = 4.999", "contains the other"});
}

}  // namespace
}  // namespace phalanx
