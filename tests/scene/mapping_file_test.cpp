// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/mapping_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/hand/joints.h"
#include "phalanx/scene/hand_file.h"
#include "scene/expect_error.h"

namespace phalanx {
namespace {

void expect_mapping_refused(const std::string& text, const std::vector<std::string>& words) {
  SCOPED_TRACE(text);
  expect_scene_error([&] { static_cast<void>(parse_mapping(text, "bad.toml")); }, words);
}

// q = gain * sign * raw + offset: 2 * -1 * -0.3 + 0.1 = 0.7, by hand.
TEST(SensorMapping, IsGainTimesSignTimesRawPlusOffset) {
  JointMapping mapping;
  mapping.sign = -1.0;
  mapping.gain = 2.0;
  mapping.offset = 0.1;
  EXPECT_DOUBLE_EQ(mapped_angle(mapping, -0.3), 0.7);
}

TEST(SensorMapping, ClampsWhereItIsTold) {
  JointMapping mapping;
  mapping.clamped = true;
  mapping.clamp_min = -0.5;
  mapping.clamp_max = 1.0;
  EXPECT_EQ(mapped_angle(mapping, 3.0), 1.0);
  EXPECT_EQ(mapped_angle(mapping, -3.0), -0.5);
  EXPECT_EQ(mapped_angle(mapping, 0.25), 0.25);
}

TEST(SensorMapping, DoesNotHideANan) {
  JointMapping mapping;
  mapping.clamped = true;
  mapping.clamp_max = 1.0;
  EXPECT_TRUE(std::isnan(mapped_angle(mapping, std::numeric_limits<double>::quiet_NaN())));
}

TEST(SensorMapping, OfIdentityReadsEveryJointByItsName) {
  const SensorMapping mapping = identity_mapping();
  ASSERT_EQ(mapping.joints.size(), static_cast<std::size_t>(kJoints));
  EXPECT_NO_THROW(check_mapping(mapping));
  for (const JointMapping& entry : mapping.joints) {
    EXPECT_EQ(entry.source, joint_name(entry.joint));
    EXPECT_EQ(mapped_angle(entry, 0.37), 0.37);
  }
}

TEST(SensorMapping, WithAJointTwiceIsRefused) {
  SensorMapping mapping = identity_mapping();
  mapping.joints[1].joint = mapping.joints[0].joint;
  EXPECT_THROW(check_mapping(mapping), std::invalid_argument);
}

TEST(MappingFile, IsReadInRadiansOrDegrees) {
  const SensorMapping mapping = parse_mapping(R"(
    description = "test"
    [index_pip_flexion]
    source = "a"
    sign = -1
    gain = 0.5
    offset_deg = 10
    clamp_deg = [-20, 100]
    [thumb_ip_flexion]
    source = "b"
    offset_rad = 0.25
    clamp_rad = [-0.1, 0.2])",
                                              "mine.toml");
  ASSERT_EQ(mapping.joints.size(), 2U);
  EXPECT_EQ(mapping.name, "mine");
  const JointMapping& thumb = mapping.joints[0];
  EXPECT_EQ(joint_name(thumb.joint), "thumb_ip_flexion");
  EXPECT_EQ(thumb.sign, 1.0);
  EXPECT_EQ(thumb.gain, 1.0);
  EXPECT_EQ(thumb.offset, 0.25);
  EXPECT_EQ(thumb.clamp_min, -0.1);
  EXPECT_EQ(thumb.clamp_max, 0.2);
  const JointMapping& index = mapping.joints[1];
  EXPECT_EQ(index.source, "a");
  EXPECT_EQ(index.sign, -1.0);
  EXPECT_DOUBLE_EQ(index.offset, 10.0 * kDeg);
  EXPECT_DOUBLE_EQ(index.clamp_min, -20.0 * kDeg);
  EXPECT_DOUBLE_EQ(index.clamp_max, 100.0 * kDeg);
}

TEST(MappingFile, WithAnUnknownJointIsAnsweredWithTheNearest) {
  expect_mapping_refused("[index_pip_flection]\nsource = \"a\"",
                         {"bad.toml:1", "index_pip_flection", "index_pip_flexion"});
}

TEST(MappingFile, WithAnUnknownKeyIsAnsweredWithTheNearest) {
  expect_mapping_refused("[index_pip_flexion]\nsource = \"a\"\nofset_rad = 1",
                         {"bad.toml:3", "ofset_rad = 1", "offset_rad"});
}

TEST(MappingFile, WithoutASource) {
  expect_mapping_refused("[index_pip_flexion]\nsign = 1", {"index_pip_flexion.source", "is missing"});
}

TEST(MappingFile, WithABadNumber) {
  const std::string head = "[index_pip_flexion]\nsource = \"a\"\n";
  expect_mapping_refused(head + "sign = 0.5", {"bad.toml:3", "sign = 0.5", "must be 1 or -1"});
  expect_mapping_refused(head + "gain = -2", {"gain = -2", "> 0"});
  expect_mapping_refused(head + "gain = nan", {"gain = nan", "must be"});
  expect_mapping_refused(head + "offset_rad = inf", {"offset_rad = inf", "must be"});
  expect_mapping_refused(head + "clamp_rad = [1, 0]", {"clamp_rad", "[smallest, largest]"});
  expect_mapping_refused(head + "clamp_rad = [1]", {"clamp_rad", "2 numbers"});
}

const std::string kPipAndDip = "[index_pip_flexion]\nsource = \"a\"\n[index_dip_flexion]\n";

TEST(MappingFile, CompletesAJointFromAMeasuredOne) {
  const SensorMapping mapping = parse_mapping(
      kPipAndDip + "completed_from = \"index_pip_flexion\"\ngain = 0.5\noffset_deg = 3", "mine.toml");
  ASSERT_EQ(mapping.joints.size(), 2U);
  EXPECT_FALSE(mapping.joints[0].completed_from);
  EXPECT_FALSE(mapping.joints[0].computed);
  EXPECT_EQ(mapping.joints[1].completed_from, 6);
  EXPECT_EQ(mapping.joints[1].source, "");
  EXPECT_DOUBLE_EQ(mapped_angle(mapping.joints[1], 0.4), 0.2 + 3.0 * kDeg);
}

TEST(MappingFile, RefusesACompletionThatFollowsNothingMeasured) {
  const auto refused = [](const std::string& from, const std::vector<std::string>& words) {
    expect_mapping_refused(kPipAndDip + "completed_from = \"" + from + "\"", words);
  };
  refused("index_dip_flexion", {"bad.toml:4", "completed_from", "index_dip_flexion", "the joint itself"});
  refused("index_mcp_flexion", {"bad.toml:4", "is not measured", "name a measured joint of the index"});
  refused("thumb_ip_flexion", {"bad.toml:4", "belongs to another digit"});
  refused("index_pip", {"bad.toml:4", "is no joint of the hand", "\"index_pip_flexion\""});
  expect_mapping_refused(kPipAndDip + "completed_from = 6", {"bad.toml:4", "completed_from = 6"});
  expect_mapping_refused(kPipAndDip + "completed_from = \"index_pip_flexion\"\nsource = \"b\"",
                         {"bad.toml:4", "the joint has a source, too; keep one"});
  expect_mapping_refused(kPipAndDip + "completed_from = \"index_pip_flexion\"\ngain = inf",
                         {"bad.toml:5", "gain = inf"});
  expect_mapping_refused(kPipAndDip + "completed_from = \"index_pip_flexion\"\ncomputed = true",
                         {"bad.toml:5", "computed = true", "belongs to a source"});
  expect_mapping_refused(
      "[index_pip_flexion]\nsource = \"a\"\ncomputed = true\n[index_dip_flexion]\n"
      "completed_from = \"index_pip_flexion\"",
      {"bad.toml:5", "is itself computed"});
  expect_mapping_refused(
      "[index_mcp_flexion]\nsource = \"a\"\n[index_pip_flexion]\ncompleted_from = \"index_mcp_flexion\"\n"
      "[index_dip_flexion]\ncompleted_from = \"index_pip_flexion\"",
      {"bad.toml:6", "is itself completed"});
}

// Three joints of thumb and index, of which any may be completed from any: what the parser accepts, the check
// accepts.
TEST(MappingFile, AcceptsOnlyWhatTheCheckAccepts) {
  std::mt19937_64 random(19);
  int accepted = 0;
  int completed = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text;
    const auto any_joint = [&] { return std::string(joint_name(static_cast<int>(random() % 8))); };
    for (int entries = 0; entries < 3; ++entries) {
      const std::string name = any_joint();
      if (text.find("[" + name + "]") != std::string::npos) continue;
      text += "[" + name + "]\n";
      if (random() % 3 != 0) text += "source = \"c\"\n";
      if (random() % 5 == 0) text += "computed = true\n";
      if (random() % 2 != 0) text += "completed_from = \"" + any_joint() + "\"\n";
    }
    try {
      const SensorMapping mapping = parse_mapping(text, "fuzz.toml");
      check_mapping(mapping);
      ++accepted;
      for (const JointMapping& entry : mapping.joints)
        if (entry.completed_from) ++completed;
    } catch (const SceneError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("fuzz.toml:")) << text;
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_LT(accepted, 2500);
  EXPECT_GT(completed, 0);
}

TEST(MappingFile, WithRadiansAndDegreesAtOnce) {
  const std::string head = "[index_pip_flexion]\nsource = \"a\"\n";
  expect_mapping_refused(head + "offset_rad = 1\noffset_deg = 1", {"offset_rad", "keep one"});
  expect_mapping_refused(head + "clamp_rad = [0, 1]\nclamp_deg = [0, 1]", {"clamp", "keep one"});
}

TEST(MappingFile, WithoutAnyJoint) {
  expect_mapping_refused("description = \"x\"", {"bad.toml", "no joint is mapped"});
}

TEST(MappingFile, ThatIsMissing) {
  expect_scene_error([] { static_cast<void>(load_mapping_file("ciberglove")); },
                     {"mapping \"ciberglove\"", "did you mean \"cyberglove\"?"});
}

// A glove's open hand and fist must come out as an open hand and a fist: the signs are right.
TEST(CybergloveMapping, MakesFlexionPositive) {
  const SensorMapping mapping = load_mapping_file("cyberglove");
  EXPECT_EQ(mapping.joints.size(), static_cast<std::size_t>(kJoints));
  for (const JointMapping& entry : mapping.joints) {
    const bool finger_flexion = digit_of_joint(entry.joint) > 0 && entry.joint % kJointsPerDigit != 1;
    if (!finger_flexion) continue;
    EXPECT_NEAR(mapped_angle(entry, 0.0), 0.0, 1e-12) << joint_name(entry.joint);
    EXPECT_GT(mapped_angle(entry, -1.2), 0.8) << joint_name(entry.joint);
  }
}

// The clamps are the adult's range of motion, and the ends of the recordings' thumb (0.50 and -2.19 rad of
// rotation, -0.46 of abduction; 0.20 is closed) are its CMC joint's, as the file states.
TEST(CybergloveMapping, KeepsToTheAdultsRangeOfMotionAndOpposesTheThumb) {
  const HandParameters adult = load_hand_file("adult");
  const SensorMapping mapping = load_mapping_file("cyberglove");
  for (const JointMapping& entry : mapping.joints) {
    EXPECT_DOUBLE_EQ(entry.clamp_min, adult.min_angle[idx(entry.joint)]) << joint_name(entry.joint);
    EXPECT_DOUBLE_EQ(entry.clamp_max, adult.max_angle[idx(entry.joint)]) << joint_name(entry.joint);
  }
  const auto degrees = [&](int joint, const char* source, double raw) {
    const auto entry = std::ranges::find(mapping.joints, joint, &JointMapping::joint);
    EXPECT_EQ(entry->source, source);
    JointMapping free = *entry;
    free.clamped = false;
    return mapped_angle(free, raw) / kDeg;
  };
  const int flexion = find_joint("thumb_cmc_flexion").value();
  const int abduction = find_joint("thumb_cmc_abduction").value();
  EXPECT_NEAR(degrees(flexion, "thumb_rotation", 0.50), -13.0, 0.5);
  EXPECT_NEAR(degrees(flexion, "thumb_rotation", -2.19), 63.0, 0.5);
  EXPECT_NEAR(degrees(abduction, "thumb_abduction", -0.46), 11.0, 0.5);
  EXPECT_NEAR(degrees(abduction, "thumb_abduction", 0.20), -27.0, 0.5);
}

// Both files state the other joints, so that one of them could be changed alone.
TEST(CybergloveMapping, IsTheCompletedOneButForTheDipJointsOfTheFingers) {
  const SensorMapping plain = load_mapping_file("cyberglove");
  const SensorMapping completed = load_mapping_file("cyberglove-completed");
  ASSERT_EQ(completed.joints.size(), plain.joints.size());
  for (std::size_t j = 0; j < plain.joints.size(); ++j) {
    const JointMapping& entry = completed.joints[j];
    const std::string name(joint_name(entry.joint));
    ASSERT_EQ(entry.joint, plain.joints[j].joint);
    EXPECT_EQ(entry.clamp_min, plain.joints[j].clamp_min) << name;
    EXPECT_EQ(entry.clamp_max, plain.joints[j].clamp_max) << name;
    EXPECT_EQ(plain.joints[j].computed, name.ends_with("dip_flexion")) << name;
    if (name.ends_with("dip_flexion")) {
      EXPECT_EQ(entry.completed_from, entry.joint - 1) << name;
      EXPECT_NEAR(mapped_angle(entry, 75.0 * kDeg), 50.0 * kDeg, 1e-12) << name;
      continue;
    }
    EXPECT_EQ(entry.source, plain.joints[j].source) << name;
    EXPECT_EQ(entry.sign, plain.joints[j].sign) << name;
    EXPECT_EQ(entry.gain, plain.joints[j].gain) << name;
    EXPECT_EQ(entry.offset, plain.joints[j].offset) << name;
    EXPECT_FALSE(entry.completed_from) << name;
  }
}

}  // namespace
}  // namespace phalanx
