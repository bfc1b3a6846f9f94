// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/mapping_file.h"

#include <cmath>
#include <limits>

#include "phalanx/core/constants.h"
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

}  // namespace
}  // namespace phalanx
