// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_skin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/hand/hand_meshes.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr double kRightAngle = std::numbers::pi / 2.0;

/// The simple hand, its knuckles 90 mm beyond the wrist.
HandParameters forward_hand() {
  HandParameters hand = test::simple_parameters();
  for (DigitParameters& digit : hand.digits) digit.base.z() = -0.09;
  return hand;
}

/// A right hand's skin without a vertex.
HandSkin bare(const HandParameters& parameters) {
  HandSkin skin;
  skin.X_BS = bind_poses(parameters, Handedness::kRight);
  return skin;
}

/// Adds the point p_S of a segment; within the first 8 mm of the bone the segment before it has a share.
void add_vertex(HandSkin& skin, int segment, const Vec3& p_S) {
  const int before = segment % kSegmentsPerDigit == 0 ? kPalm : segment - 1;
  const double own = segment == kPalm ? 1.0 : std::clamp(0.5 - p_S.z() / 0.016, 0.0, 1.0);
  skin.mesh.vertices.emplace_back(skin.X_BS[idx(segment)] * p_S);
  skin.segment.push_back({static_cast<std::uint8_t>(segment), static_cast<std::uint8_t>(before), 0, 0});
  skin.weight.push_back({static_cast<float>(own), 1.0F - static_cast<float>(own), 0.0F, 0.0F});
}

/// The capsules of all segments as one skin.
HandSkin capsule_skin(const HandParameters& parameters) {
  HandSkin skin = bare(parameters);
  const SegmentMeshes meshes = make_capsule_meshes(parameters, Handedness::kRight, 800);
  for (int s = 0; s < kSegments; ++s) {
    const auto first = static_cast<std::int32_t>(skin.mesh.vertices.size());
    for (const Vec3& v : meshes[idx(s)].vertices) add_vertex(skin, s, v);
    for (const Triangle& t : meshes[idx(s)].triangles)
      skin.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return skin;
}

std::array<Pose, kSegments> poses(const HandParameters& parameters, Handedness handedness,
                                  const JointArray& angle, const Pose& X_WH = {}) {
  const HandModel hand = make_hand_model(parameters, handedness, X_WH, 800);
  HandPoses digits;
  hand.poses(angle, digits);
  std::array<Pose, kSegments> X_WS;
  for (int s = 0; s < kPalm; ++s) {
    X_WS[idx(s)] = digits.digit[idx(s / kSegmentsPerDigit)].segment[idx(s % kSegmentsPerDigit)];
  }
  X_WS[kPalm] = X_WH;
  return X_WS;
}

JointArray random_angles(Random& random, const HandParameters& hand) {
  JointArray angle{};
  for (std::size_t j = 0; j < kJoints; ++j) angle[j] = random.between(hand.min_angle[j], hand.max_angle[j]);
  return angle;
}

HandFit uniform_fit(double ratio) {
  HandFit fit{.palm_length = ratio, .palm_breadth = ratio, .segment = {}};
  fit.segment.fill({ratio, ratio, ratio, ratio});
  return fit;
}

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

// The simple hand's digits run along -Z from their bases and have the hand frame's directions.
TEST(BindPoses, AreTheStraightHands) {
  const std::array<Pose, kSegments> X_BS = bind_poses(forward_hand(), Handedness::kRight);
  for (int d = 0; d < kDigits; ++d) {
    const Vec3 base(0.1 * (d - 1), 0.0, -0.09);
    const std::array<double, kSegmentsPerDigit> along = {0.0, test::kLength1,
                                                         test::kLength1 + test::kLength2};
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const Pose& X = X_BS[idx(segment_index(d, k))];
      EXPECT_LT((X.p - (base - along[idx(k)] * Vec3::UnitZ())).norm(), 1e-15);
      EXPECT_LT((X.R - Mat3::Identity()).norm(), 1e-15);
    }
  }
  EXPECT_EQ(X_BS[kPalm].p, Vec3(Vec3::Zero()));
  EXPECT_EQ(X_BS[kPalm].R, Mat3(Mat3::Identity()));
}

TEST(Skinned, IsTheSkinItselfInTheStraightPose) {
  const HandParameters hand = forward_hand();
  const HandSkin skin = capsule_skin(hand);
  EXPECT_LT(largest_difference(skinned(skin, skin.X_BS), skin.mesh.vertices), 1e-8);  // weights are floats
  const Pose X_WH{rotation_about(Vec3(1, 2, 3).normalized(), 0.7), Vec3(0.1, -0.2, 0.3)};
  std::vector<Vec3> carried;
  for (const Vec3& v : skin.mesh.vertices) carried.emplace_back(X_WH * v);
  EXPECT_LT(largest_difference(skinned(skin, poses(hand, Handedness::kRight, {}, X_WH)), carried), 1e-7);
}

// Half of each, 10 mm below the PIP joint, which is at a right angle: the first segment keeps the point
// there, the second takes it to 10 mm behind the joint. Half way round it is still 10 mm from the axis; the
// mean of both places would be 7.07 mm from it.
TEST(Skinned, KeepsItsDistanceFromABentJoint) {
  const HandParameters hand = forward_hand();
  HandSkin skin = bare(hand);
  add_vertex(skin, segment_index(test::kIndex, 1), Vec3(0.0, -0.010, 0.0));
  const auto X_WS = poses(hand, Handedness::kRight, test::index_angles(0.0, kRightAngle));
  const Vec3 pip(0.0, 0.0, -0.09 - test::kLength1);
  const double along = 0.010 / std::numbers::sqrt2;
  EXPECT_LT((skinned(skin, X_WS).front() - (pip + Vec3(0.0, -along, along))).norm(), 1e-12);
}

// Half the palm's, half the second segment's, which MCP and PIP joint together have turned by 190 deg: the
// vertex turns by 95 deg, not by 85 deg the other way round. Its centre is the PIP joint, which goes half way
// to where the MCP joint's 90 deg take it.
TEST(Skinned, BlendsMoreThanHalfATurnTheWayItWasBent) {
  const HandParameters hand = forward_hand();
  HandSkin skin = bare(hand);
  add_vertex(skin, segment_index(test::kIndex, 1), Vec3(0.002, -0.010, 0.0));
  skin.segment.front()[1] = kPalm;
  constexpr double kDegree = std::numbers::pi / 180.0;
  const auto X_WS = poses(hand, Handedness::kRight, test::index_angles(90.0 * kDegree, 100.0 * kDegree));
  const Vec3 mcp(0.0, 0.0, -0.09);
  const Vec3 straight = mcp - test::kLength1 * Vec3::UnitZ(), bent = mcp - test::kLength1 * Vec3::UnitY();
  const Vec3 turned = rotation_about(-Vec3::UnitX(), 95.0 * kDegree) * Vec3(0.002, -0.010, 0.0);
  EXPECT_LT((skinned(skin, X_WS).front() - ((straight + bent) / 2.0 + turned)).norm(), 1e-12);
}

TEST(Skinned, IsRigidWhereOneSegmentHoldsIt) {
  const HandParameters hand = forward_hand();
  const HandSkin skin = capsule_skin(hand);
  constexpr std::uint64_t kSeed = 41;
  Random random(kSeed);
  for (int n = 0; n < 20; ++n) {
    const auto X_WS = poses(hand, Handedness::kRight, random_angles(random, hand));
    const std::vector<Vec3> vertices = skinned(skin, X_WS);
    int rigid = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (skin.weight[i][0] != 1.0F) continue;
      const std::size_t s = skin.segment[i][0];
      const Vec3 expected = X_WS[s] * (skin.X_BS[s].inverse() * skin.mesh.vertices[i]);
      ASSERT_LT((vertices[i] - expected).norm(), 1e-15) << "seed " << kSeed << ", vertex " << i;
      ++rigid;
    }
    EXPECT_GT(rigid, 100);
  }
}

TEST(SkinMirror, TwiceIsTheSameToTheLastBit) {
  const HandSkin skin = capsule_skin(forward_hand());
  HandSkin twice = skin;
  mirror(twice);
  EXPECT_NE(twice.mesh.vertices, skin.mesh.vertices);
  mirror(twice);
  EXPECT_EQ(twice.mesh.vertices, skin.mesh.vertices);
  EXPECT_EQ(twice.mesh.triangles, skin.mesh.triangles);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_EQ(twice.X_BS[s].R, skin.X_BS[s].R);
    EXPECT_EQ(twice.X_BS[s].p, skin.X_BS[s].p);
  }
}

TEST(SkinMirror, MovesAsTheOtherHandDoes) {
  HandParameters hand = forward_hand();
  hand.digits[0].distal = Vec3(-0.5, -0.3, -0.8).normalized();  // a thumb that is not parallel to the rest
  hand.digits[0].dorsal = Vec3(-0.8, 0.6, 0.275).normalized();
  const HandSkin right = capsule_skin(hand);
  HandSkin left = right;
  mirror(left);
  const auto X_BS = bind_poses(hand, Handedness::kLeft);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_LT((left.X_BS[s].R - X_BS[s].R).norm() + (left.X_BS[s].p - X_BS[s].p).norm(), 1e-15);
    EXPECT_NEAR(left.X_BS[s].R.determinant(), 1.0, 1e-12);
  }
  EXPECT_GT(signed_volume(left.mesh), 0.0);
  constexpr std::uint64_t kSeed = 42;
  Random random(kSeed);
  for (int n = 0; n < 20; ++n) {
    const JointArray angle = random_angles(random, hand);
    std::vector<Vec3> image = skinned(right, poses(hand, Handedness::kRight, angle));
    for (Vec3& v : image) v.x() = -v.x();
    EXPECT_LT(largest_difference(skinned(left, poses(hand, Handedness::kLeft, angle)), image), 1e-14)
        << "seed " << kSeed << ", pose " << n;
  }
}

TEST(FittedSkin, OfRatioOneIsTheSame) {
  const HandParameters hand = forward_hand();
  const HandSkin skin = capsule_skin(hand);
  const HandSkin fitted = fitted_skin(hand, HandFit{}, skin);
  EXPECT_LT(largest_difference(fitted.mesh.vertices, skin.mesh.vertices), 1e-8);
  EXPECT_EQ(fitted.mesh.triangles, skin.mesh.triangles);
  EXPECT_EQ(fitted.segment, skin.segment);
  EXPECT_EQ(fitted.weight, skin.weight);
  for (std::size_t s = 0; s < kSegments; ++s) EXPECT_EQ(fitted.X_BS[s].p, skin.X_BS[s].p);
}

TEST(FittedSkin, OfOneRatioIsThatManyTimesTheSize) {
  const HandParameters hand = forward_hand();
  const HandSkin skin = capsule_skin(hand);
  for (const double ratio : {0.75, 1.3}) {
    const HandSkin fitted = fitted_skin(hand, uniform_fit(ratio), skin);
    std::vector<Vec3> expected = skin.mesh.vertices;
    for (Vec3& v : expected) v *= ratio;
    EXPECT_LT(largest_difference(fitted.mesh.vertices, expected), 1e-8) << ratio;
    for (std::size_t s = 0; s < kSegments; ++s)
      EXPECT_LT((fitted.X_BS[s].p - ratio * skin.X_BS[s].p).norm(), 1e-15);
  }
}

// At random fits every vertex is the blend of where its segments' fitted meshes have it.
TEST(FittedSkin, FollowsTheFittedMeshes) {
  const HandParameters hand = forward_hand();
  const HandSkin skin = capsule_skin(hand);
  constexpr std::uint64_t kSeed = 43;
  Random random(kSeed);
  for (int n = 0; n < 10; ++n) {
    HandFit fit = uniform_fit(1.0);
    fit.palm_length = random.between(0.8, 1.25);
    fit.palm_breadth = random.between(0.8, 1.25);
    for (SegmentFit& segment : fit.segment) {
      for (double* ratio :
           {&segment.length, &segment.breadth_base, &segment.breadth_middle, &segment.breadth_end})
        *ratio = random.between(0.8, 1.25);
    }
    const HandSkin fitted = fitted_skin(hand, fit, skin);
    const auto X_BS = bind_poses(fitted_parameters(hand, fit), Handedness::kRight);
    std::vector<Vec3> expected(skin.mesh.vertices.size(), Vec3::Zero());
    for (std::size_t s = 0; s < kSegments; ++s) {
      SegmentMeshes all;  // every vertex as if it were this segment's
      for (const Vec3& v : skin.mesh.vertices) all[s].vertices.emplace_back(skin.X_BS[s].inverse() * v);
      all = fitted_meshes(hand, fit, all);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
          if (skin.segment[i][k] == s)
            expected[i] += static_cast<double>(skin.weight[i][k]) * (X_BS[s] * all[s].vertices[i]);
        }
      }
    }
    EXPECT_LT(largest_difference(fitted.mesh.vertices, expected), 1e-15) << "seed " << kSeed;
    for (std::size_t s = 0; s < kSegments; ++s) EXPECT_EQ(fitted.X_BS[s].p, X_BS[s].p);
  }
}

TEST(FittedSkin, OfAHandThatCannotBeIsRefused) {
  const HandParameters hand = forward_hand();
  HandFit fit = uniform_fit(1.0);
  fit.segment[2].breadth_middle = 100.0;
  EXPECT_THROW((void)fitted_skin(hand, fit, capsule_skin(hand)), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx
