// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/profile_file.h"

#include <cmath>

#include "phalanx/core/constants.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/hand_meshes.h"
#include "scene/expect_error.h"
#include "scene/hands/hand_files.h"

namespace phalanx {
namespace {

const std::string kProfileHead = "name = \"p\"\nhandedness = \"right\"\n";

Profile parse_with_head(const std::string& text) { return parse_profile(kProfileHead + text, "p.toml"); }

void expect_profile_refused(const std::string& text, const std::vector<std::string>& words) {
  expect_scene_error([&] { (void)fit_profile(parse_with_head(text), load_hand_file("adult")); }, words);
}

TEST(Profile, StatesSizesInMillimetresAndRangesInDegrees) {
  const Profile p = parse_with_head(R"(
    hand_length_mm = 180
    hand_breadth_mm = 80
    segments = [{ name = "index-finger-phalanx-proximal", length_mm = 40, breadth_mm = 20 }]
    [range_of_motion]
    index_pip_flexion = [0, 60])");
  EXPECT_DOUBLE_EQ(*p.size.hand_length, 0.18);
  EXPECT_DOUBLE_EQ(*p.size.hand_breadth, 0.08);
  EXPECT_DOUBLE_EQ(*p.size.segment[3].length, 0.04);
  EXPECT_DOUBLE_EQ(*p.size.segment[3].breadth, 0.02);
  EXPECT_FALSE(p.size.segment[4].length.has_value());
  ASSERT_TRUE(p.range[6].has_value());
  EXPECT_DOUBLE_EQ(p.range[6]->second, 60 * kDeg);
}

TEST(Profile, FitsTheAdultHandToTheNanometre) {
  const HandParameters base = load_hand_file("adult");
  for (const double length_mm : {145.0, 165.0, 185.7, 210.0, 230.0}) {
    for (const double breadth_mm : {66.0, 81.5, 105.0}) {
      const FittedHand hand =
          fit_profile(parse_with_head("hand_length_mm = " + std::to_string(length_mm) +
                                      "\nhand_breadth_mm = " + std::to_string(breadth_mm)),
                      base);
      EXPECT_NEAR(hand_length(hand.parameters), 1e-3 * length_mm, 1e-9);
      EXPECT_NEAR(hand_breadth(hand.parameters), 1e-3 * breadth_mm, 1e-9);
    }
  }
}

TEST(Profile, OfANameThatShipsIsReadAndMakesAHand) {
  for (const char* name : {"small-woman", "large-man", "stiff-hand"}) {
    HandDescription hand;
    hand.profile = name;
    const LoadedHand loaded = load_hand(hand);
    const Profile profile = load_profile(name);
    EXPECT_EQ(loaded.handedness, profile.handedness);
    EXPECT_NEAR(hand_length(loaded.parameters), *profile.size.hand_length, 1e-9);
    EXPECT_NEAR(hand_breadth(loaded.parameters), *profile.size.hand_breadth, 1e-9);
    for (const TriangleMesh& mesh : loaded.meshes.collision) {
      EXPECT_TRUE(is_closed(mesh));
      EXPECT_GT(signed_volume(mesh), 0.0);
    }
  }
}

TEST(Profile, MovesTheOpenAngleIntoItsOwnRange) {
  const FittedHand hand = fit_profile(parse_with_head("[range_of_motion]\nindex_pip_flexion = [15, 60]"),
                                      load_hand_file("adult"));
  EXPECT_DOUBLE_EQ(hand.parameters.min_angle[6], 15 * kDeg);
  EXPECT_DOUBLE_EQ(hand.parameters.max_angle[6], 60 * kDeg);
  EXPECT_DOUBLE_EQ(hand.parameters.open_angle[6], 15 * kDeg);
  EXPECT_EQ(hand.parameters.open_angle[7], 0.0);
}

TEST(Profile, RefusesSizesBeyondFourDeviationsWithTheRangeAndItsSource) {
  expect_profile_refused("hand_length_mm = 19.0",
                         {"p.toml:3: hand_length_mm = 19", "141.7 to 233 mm", "Gordon"});
  expect_profile_refused("hand_length_mm = 233.1", {"hand_length_mm = 233.1", "141.7 to 233 mm"});
  expect_profile_refused("hand_breadth_mm = 120", {"hand_breadth_mm = 120", "64.2 to 107.2 mm"});
  expect_profile_refused("hand_breadth_mm = nan", {"hand_breadth_mm = nan"});
  // Index proximal: 39.78 +- 4 x 4.94 mm.
  expect_profile_refused("segments = [{ name = \"index-finger-phalanx-proximal\", length_mm = 60 }]",
                         {"segments.0.length_mm = 60", "20.02 to 59.54 mm", "Buryanov"});
  expect_profile_refused(
      "segments = [{ name = \"index-finger-phalanx-proximal\", breadth_mm = 40 }]",
      {"p.toml:3: segments.0.breadth_mm: the breadth of index-finger-phalanx-proximal is 40 mm",
       "our own bounds"});
}

TEST(Profile, AcceptsTheVeryEndsOfTheRanges) {
  const HandParameters base = load_hand_file("adult");
  EXPECT_NO_THROW((void)fit_profile(parse_with_head("hand_length_mm = 141.7\nhand_breadth_mm = 64.2"), base));
  EXPECT_NO_THROW((void)fit_profile(parse_with_head("hand_length_mm = 233\nhand_breadth_mm = 107.2"), base));
}

TEST(Profile, RefusesSizesThatOnlyFollow) {
  // 230 mm with a middle finger of a small hand leaves a palm of 1.6 times the base's.
  expect_profile_refused(R"(hand_length_mm = 230
    segments = [{ name = "middle-finger-phalanx-proximal", length_mm = 30 },
                { name = "middle-finger-phalanx-intermediate", length_mm = 15 },
                { name = "middle-finger-phalanx-distal", length_mm = 11 }])",
                         {"p.toml", "the palm's length", "Buryanov"});
}

TEST(Profile, RefusesImpossibleAngles) {
  expect_profile_refused(
      "[range_of_motion]\nindex_pip_flexion = [0, 200]",
      {"range_of_motion.index_pip_flexion = [0, 200]", "-45 to 130 deg", "our own bounds"});
  expect_profile_refused("[range_of_motion]\nindex_pip_flexion = [60, 60]", {"is an empty range"});
  expect_profile_refused("[range_of_motion]\nindex_pip_flexoin = [0, 60]",
                         {"nearest known one is range_of_motion.index_pip_flexion"});
}

TEST(Profile, RefusesKeysAndSegmentsThatNobodyKnows) {
  expect_profile_refused("hand_lenght_mm = 180", {"p.toml:3: hand_lenght_mm", "hand_length_mm"});
  expect_profile_refused("segments = [{ name = \"index-finger-phalanx\", length_mm = 40 }]",
                         {"is no segment of a digit", "index-finger-phalanx-"});
  expect_profile_refused("segments = [{ name = \"wrist\", length_mm = 40 }]",
                         {"hand_length_mm and hand_breadth_mm"});
  expect_profile_refused("segments = [{ name = \"index-finger-phalanx-distal\" }]", {"states neither"});
  expect_profile_refused(R"(segments = [{ name = "index-finger-phalanx-distal", length_mm = 15 },
                                { name = "index-finger-phalanx-distal", length_mm = 16 }])",
                         {"segments.1.name", "stated twice"});
  expect_scene_error([] { (void)parse_profile("name = \"p\"", "p.toml"); }, {"handedness", "is missing"});
  expect_scene_error([] { (void)parse_profile("name = \"p\"\nhandedness = \"both\"", "p.toml"); },
                     {"handedness = ", "\"right\" or \"left\""});
  expect_scene_error([] { (void)load_profile("smal-woman"); }, {"did you mean \"small-woman\"?"});
}

TEST(Profile, OfASceneSaysWhichHand) {
  const auto scene = [](const std::string& text, const Overrides& overrides = {}) {
    return parse_scene(text, "s.toml", "/", overrides);
  };
  const HapticModel model = build_model(scene("hand.profile = \"large-man\"\nhand.meshes = \"capsules\""));
  EXPECT_EQ(model.hand.handedness(), Handedness::kLeft);
  EXPECT_NEAR(hand_length(model.hand.parameters()), 0.2085, 1e-9);
  EXPECT_EQ(build_model(scene("", {{"hand.profile", "stiff-hand"}})).hand.parameters().name, "stiff hand");
  expect_scene_error([&] { (void)scene("hand.profile = \"large-man\"\nhand.side = \"left\""); },
                     {"s.toml:2: hand.side = ", "the profile states this", "hand.profile = "});
  expect_scene_error([&] { (void)scene("hand.file = \"adult\"", {{"hand.profile", "large-man"}}); },
                     {"s.toml:1: hand.file = ", "--set hand.profile=large-man"});
}

TEST(Profile, ScalesMeshesOutOfFiles) {
  const test::HandFolder folder;
  folder.write_meshes(make_capsule_meshes(load_hand_file("adult"), Handedness::kRight, 800));
  const std::string hand = folder.write_hand("collision = \"meshes/{segment}.obj\"\nunit_mm = 1\n");
  const std::filesystem::path file = folder.path() / "profile.toml";
  std::ofstream(file) << "name = \"p\"\nhandedness = \"left\"\nhand = \"hand.toml\"\nhand_length_mm = 170\n";
  HandDescription description;
  description.profile = file.string();
  const LoadedHand loaded = load_hand(description);
  const HandParameters base = load_hand_file(hand);
  const double ratio = 0.17 / hand_length(base);
  const int tip = segment_index(static_cast<int>(Digit::kMiddle), 2);
  const auto s = static_cast<std::size_t>(tip);
  const double before = base.segments[s].length + base.segments[s].radius_tip;
  EXPECT_NEAR(bounds(loaded.meshes.collision[s]).min.z(), -ratio * before, 1e-7);
  EXPECT_EQ(loaded.handedness, Handedness::kLeft);
}

}  // namespace
}  // namespace phalanx
