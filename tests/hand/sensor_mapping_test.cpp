// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/sensor_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "phalanx/core/constants.h"
#include "phalanx/hand/angle_origin.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

// 0.02 x -1 x 30 + 0.25 = -0.35; clamped to -0.2 .. 0.4.
TEST(SensorMapping, IsGainTimesSignTimesRawPlusOffsetAndThenClamped) {
  JointMapping mapping{.joint = 6, .source = "s", .sign = -1.0, .gain = 0.02, .offset = 0.25};
  EXPECT_NEAR(mapped_angle(mapping, 30.0), -0.35, 1e-15);
  EXPECT_EQ(mapped_angle(mapping, 0.0), 0.25);
  mapping.clamp_min = -0.2;
  mapping.clamp_max = 0.4;
  EXPECT_NEAR(mapped_angle(mapping, 30.0), -0.35, 1e-15) << "not asked to clamp";
  mapping.clamped = true;
  EXPECT_EQ(mapped_angle(mapping, 30.0), -0.2);
  EXPECT_EQ(mapped_angle(mapping, -30.0), 0.4);
  EXPECT_EQ(mapped_angle(mapping, 0.0), 0.25);
  EXPECT_EQ(mapped_angle(mapping, -std::numeric_limits<double>::infinity()), 0.4);
}

// What is not a number says that the sensor is silent: a clamp must not make an angle of it.
TEST(SensorMapping, LeavesWhatIsNotANumberAlsoWhereItClamps) {
  JointMapping mapping{.source = "s", .clamp_min = -0.2, .clamp_max = 0.4, .clamped = true};
  EXPECT_TRUE(std::isnan(mapped_angle(mapping, std::numeric_limits<double>::quiet_NaN())));
  mapping.clamped = false;
  EXPECT_TRUE(std::isnan(mapped_angle(mapping, std::numeric_limits<double>::quiet_NaN())));
}

TEST(SensorMapping, TheIdentityReadsEachJointFromTheColumnOfItsName) {
  const SensorMapping mapping = identity_mapping();
  EXPECT_NO_THROW(check_mapping(mapping));
  ASSERT_EQ(mapping.joints.size(), static_cast<std::size_t>(kJoints));
  for (int joint = 0; joint < kJoints; ++joint) {
    const JointMapping& entry = mapping.joints[static_cast<std::size_t>(joint)];
    EXPECT_EQ(entry.joint, joint);
    EXPECT_EQ(entry.source, joint_name(joint));
    EXPECT_EQ(mapped_angle(entry, 0.7), 0.7);
  }
}

// A DIP joint at 2/3 of the PIP's angle, which is at 60 degrees: 40 degrees.
TEST(SensorMapping, CompletesAJointFromTheAngleOfAnother) {
  const JointMapping dip{.joint = 7, .gain = 2.0 / 3.0, .completed_from = 6};
  EXPECT_NEAR(mapped_angle(dip, 60.0 * kDeg), 40.0 * kDeg, 1e-15);
}

// Fingers that are spread by 12 degrees when the MCP joint is straight, and not at all when it is at 90:
// 12 - 12/90 flexion. At 45 degrees it is 6; at -45 it would be 18, and is clamped.
TEST(SensorMapping, CompletesAbductionThatVanishesWithFlexion) {
  const JointMapping abduction{.joint = 5,
                               .sign = -1.0,
                               .gain = 12.0 / 90.0,
                               .offset = 12.0 * kDeg,
                               .clamp_min = 0.0,
                               .clamp_max = 12.0 * kDeg,
                               .clamped = true,
                               .completed_from = 4};
  EXPECT_NEAR(mapped_angle(abduction, 0.0), 12.0 * kDeg, 1e-15);
  EXPECT_NEAR(mapped_angle(abduction, 45.0 * kDeg), 6.0 * kDeg, 1e-15);
  EXPECT_NEAR(mapped_angle(abduction, 90.0 * kDeg), 0.0, 1e-15);
  EXPECT_EQ(mapped_angle(abduction, -45.0 * kDeg), 12.0 * kDeg);
}

std::string refusal_of(const std::function<void(SensorMapping&)>& change) {
  SensorMapping mapping = identity_mapping();
  change(mapping);
  try {
    check_mapping(mapping);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SensorMapping, IsRefusedByTheNameOfTheJointAndWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const int joint : {-1, kJoints, kJoints + 1}) {
    EXPECT_THAT(refusal_of([&](SensorMapping& m) { m.joints[3].joint = joint; }),
                HasSubstr("joint number " + std::to_string(joint)));
  }
  EXPECT_THAT(refusal_of([](SensorMapping& m) { m.joints[3].joint = 6; }),
              HasSubstr("index_pip_flexion is mapped twice"));
  EXPECT_EQ(refusal_of([](SensorMapping& m) { m.joints[6].source.clear(); }),
            "mapping \"joint names\": index_pip_flexion has an empty source; name a column or sensor");
  for (const double sign : {0.0, 2.0, -0.5, nan})
    EXPECT_THAT(refusal_of([&](SensorMapping& m) { m.joints[6].sign = sign; }), HasSubstr("sign")) << sign;
  for (const double gain : {0.0, -1.0, nan, infinite})
    EXPECT_THAT(refusal_of([&](SensorMapping& m) { m.joints[6].gain = gain; }), HasSubstr("gain")) << gain;
  for (const double offset : {nan, -infinite})
    EXPECT_THAT(refusal_of([&](SensorMapping& m) { m.joints[6].offset = offset; }), HasSubstr("offset"));
  const auto clamp = [](double low, double high) {
    return refusal_of([&](SensorMapping& m) {
      m.joints[6].clamp_min = low;
      m.joints[6].clamp_max = high;
      m.joints[6].clamped = true;
    });
  };
  EXPECT_EQ(clamp(-0.1, 0.1), "");
  EXPECT_THAT(clamp(0.1, 0.1), HasSubstr("clamp")) << "every count would be the same angle";
  EXPECT_THAT(clamp(0.2, 0.1), HasSubstr("clamp"));
  EXPECT_THAT(clamp(-infinite, 0.1), HasSubstr("clamp"));
  EXPECT_THAT(clamp(0.1, nan), HasSubstr("clamp"));
}

/// The refusal of the index finger's DIP joint, completed from `joint`.
std::string refusal_of_completion(int joint, const std::function<void(SensorMapping&)>& change = {}) {
  return refusal_of([&](SensorMapping& mapping) {
    mapping.joints[7].source.clear();
    mapping.joints[7].completed_from = joint;
    if (change) change(mapping);
  });
}

TEST(SensorMapping, ACompletionFollowsAMeasuredJointOfItsDigit) {
  EXPECT_EQ(refusal_of_completion(6), "");
  EXPECT_EQ(refusal_of_completion(4), "");
  EXPECT_THAT(refusal_of_completion(7), HasSubstr("index_dip_flexion: completed_from is the joint itself"));
  EXPECT_THAT(refusal_of_completion(10),
              HasSubstr("belongs to another digit; name a measured joint of the index"));
  for (const int joint : {-1, kJoints})
    EXPECT_THAT(refusal_of_completion(joint), HasSubstr("does not exist"));
  EXPECT_THAT(refusal_of_completion(6, [](SensorMapping& m) { m.joints.erase(m.joints.begin() + 6); }),
              HasSubstr("is not measured"));
  EXPECT_THAT(refusal_of_completion(6,
                                    [](SensorMapping& m) {
                                      m.joints[6].source.clear();
                                      m.joints[6].completed_from = 4;
                                    }),
              HasSubstr("index_dip_flexion: completed_from is itself completed"));
  EXPECT_THAT(refusal_of_completion(6, [](SensorMapping& m) { m.joints[6].computed = true; }),
              HasSubstr("index_dip_flexion: completed_from is itself computed"));
  EXPECT_THAT(refusal_of_completion(6, [](SensorMapping& m) { m.joints[7].computed = true; }),
              HasSubstr("computed belongs to a source"));
  EXPECT_THAT(refusal_of_completion(6, [](SensorMapping& m) { m.joints[7].source = "column"; }),
              HasSubstr("has a source and is completed; keep one"));
  EXPECT_THAT(refusal_of_completion(
                  6, [](SensorMapping& m) { m.joints[7].gain = std::numeric_limits<double>::infinity(); }),
              HasSubstr("gain"));
}

TEST(AngleOrigin, IsUnknownUnlessStated) {
  EXPECT_EQ(AngleOrigins{}[3], AngleOrigin::kUnknown);
  EXPECT_EQ(angle_origin_name(AngleOrigin::kUnknown), "unknown");
  EXPECT_EQ(angle_origin_name(AngleOrigin::kScripted), "scripted");
  EXPECT_EQ(angle_origin_name(AngleOrigin::kMeasured), "measured");
  EXPECT_EQ(angle_origin_name(AngleOrigin::kCompleted), "completed");
  EXPECT_EQ(angle_origin_name(AngleOrigin::kFixed), "fixed");
}

TEST(SensorMapping, WithSignMinusOneAndAnUnusedClampIsFine) {
  EXPECT_EQ(refusal_of([](SensorMapping& m) {
              m.joints[6].sign = -1.0;
              m.joints[6].clamp_min = m.joints[6].clamp_max = 1.0;
            }),
            "");
  EXPECT_EQ(refusal_of([](SensorMapping& m) { m.joints.clear(); }), "") << "the others stay open";
}

// The defaults of a mapping: joint 0, the source's own angle, limits of 0.
TEST(SensorMapping, LeavesTheAngleAsItIsWhereNothingIsStated) {
  EXPECT_EQ(JointMapping{}.joint, 0);
  EXPECT_EQ(mapped_angle({}, 0.7), 0.7);
  EXPECT_EQ(mapped_angle({}, -0.7), -0.7);
  EXPECT_EQ(mapped_angle({.source = "s", .clamp_max = 0.4, .clamped = true}, -0.7), 0.0);
  EXPECT_EQ(mapped_angle({.source = "s", .clamp_min = -0.4, .clamped = true}, 0.7), 0.0);
}

}  // namespace
}  // namespace phalanx
