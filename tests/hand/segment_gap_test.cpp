// SPDX-License-Identifier: Apache-2.0
// The anatomical meshes of assets/hands/generic: sixteen closed solids that fit assets/hands/adult.toml and
// close on each other at every angle of its joints. tests/support/segment_rims.h states the gap criterion.
// It holds along the whole rim of the fourteen joints of the fingers and of the thumb beyond its metacarpal,
// and within 14 mm of the thumb's CMC joint. Farther out lies the web between thumb and index finger, where
// real skin stretches by centimetres: there a fold opens between two closed solids.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "phalanx/core/index.h"
#include "phalanx/mesh/import.h"
#include "phalanx/scene/hand_file.h"
#include "support/sanitized.h"
#include "support/segment_rims.h"

namespace phalanx {
namespace {

constexpr int kSteps = test::kSlowBuild ? 10 : 30;   ///< of the range of a joint
constexpr int kCmcSteps = test::kSlowBuild ? 4 : 9;  ///< of the range of each of two joints
constexpr double kGap = 1e-3;
constexpr double kCmcReach = 14e-3;  // [m]
constexpr double kWebGap = 17e-3;    // [m] how far the fold of the web opens

HandModel adult() {
  SegmentMeshes meshes;
  for (int s = 0; s < kSegments; ++s) meshes[idx(s)] = test::read_generic_mesh(s);
  return {load_hand_file("adult", PHALANX_SOURCE_DIR), Handedness::kRight, Pose{}, meshes};
}

test::Rim rim_of(const HandModel& hand, int segment) {
  return test::read_rim(segment, hand.mesh(segment).vertices,
                        hand.mesh(test::neighbour_of(segment)).vertices);
}

struct Worst {
  double width = 0.0;
  std::string where;
};

/// The widest gap between segment k of the digit (`moving` instead of its mesh) and its neighbour, over a
/// grid of the range of the joints between them.
Worst widest_over_the_range(const HandModel& hand, int digit, int k, const TriangleMesh& moving, int steps,
                            double reach = test::kFar) {
  const int s = segment_index(digit, k);
  const test::Rim rim = rim_of(hand, s);
  EXPECT_GT(rim.own.size(), 20U) << segment_name(s);
  const int first = k == 0 ? 0 : k + 1;
  Worst worst;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j <= (k == 0 ? steps : 0); ++j) {
      DigitAngles q{};
      const auto set = [&](int joint, int step) {
        const std::size_t n = idx(joint_index(digit, joint));
        const double low = hand.parameters().min_angle[n];
        q[idx(joint)] = low + step * (hand.parameters().max_angle[n] - low) / steps;
      };
      set(first, i);
      if (k == 0) set(1, j);
      DigitPose pose;
      hand.digit_pose(digit, q, pose);
      const Pose X_WN = k == 0 ? hand.palm_pose() : pose.segment[idx(k - 1)];
      const test::Gap gap = test::widest_gap(rim, moving, hand.mesh(test::neighbour_of(s)),
                                             X_WN.inverse() * pose.segment[idx(k)], reach);
      if (gap.width <= worst.width) continue;
      std::ostringstream text;
      text << segment_name(s) << ": " << 1e3 * gap.width << " mm at "
           << q[idx(first)] * 180.0 / std::numbers::pi;
      if (k == 0) text << " and " << q[1] * 180.0 / std::numbers::pi;
      text << " deg, at (" << 1e3 * gap.at.transpose() << ") mm";
      worst = {gap.width, text.str()};
    }
  }
  return worst;
}

TEST(SegmentMeshes, AreSixteenSolidsEachOneClosedShellWithoutFindings) {
  int triangles = 0;
  for (int s = 0; s < kSegments; ++s) {
    const ImportedMesh read = import_and_check(test::generic_mesh_file(s), {.unit = 1e-3});
    const std::string name(segment_name(s));
    EXPECT_TRUE(is_closed(read.mesh)) << name;
    EXPECT_GT(signed_volume(read.mesh), 1e-6) << name;
    EXPECT_EQ(read.report.solids, 1U) << name;
    EXPECT_EQ(read.report.cavities, 0U) << name;
    EXPECT_EQ(read.report.sheets, 0U) << name;
    EXPECT_TRUE(read.report.complete) << name;
    // Among them: degenerate and duplicate faces, pinch vertices, self-intersections, inside-out shells.
    for (const MeshFinding& finding : read.report.findings)
      ADD_FAILURE() << name << " has " << finding.found << " of finding " << static_cast<int>(finding.kind);
    triangles += static_cast<int>(read.mesh.triangles.size());
  }
  EXPECT_LT(triangles, 3500) << "triangles cost time at every step";
}

// Where a finger ends: bone + soft tip, assets/hands/adult.toml [lengths].
TEST(SegmentMeshes, EndWhereTheHandFileSaysThatTheFingersEnd) {
  const std::array<double, kDigits> soft_tip = {5.67e-3, 3.84e-3, 3.95e-3, 3.95e-3, 3.73e-3};
  const HandModel hand = adult();
  for (int d = 0; d < kDigits; ++d) {
    const double end = hand.parameters().digits[idx(d)].dh[3].a + soft_tip[idx(d)];
    EXPECT_NEAR(-bounds(hand.mesh(segment_index(d, 2))).min.z(), end, 1e-5) << digit_name(d);
  }
}

// Between two phalanges the skin is as thick as the capsules of the hand file say: mean of breadth and
// thickness along the rim. Drawing rims in, so that nothing gaps, has cost some of it.
TEST(SegmentMeshes, AreAsThickAtTheirJointsAsTheCapsules) {
  const HandModel hand = adult();
  for (int d = 0; d < kDigits; ++d) {
    for (int k = 1; k < kSegmentsPerDigit; ++k) {
      if (d == 0 && k == 1) continue;  // the thumb's MCP joint lies in the thenar
      const int s = segment_index(d, k);
      const test::Rim rim = rim_of(hand, s);
      Vec3 low = Vec3::Constant(test::kFar);
      Vec3 high = -low;
      for (const Vec3& p : rim.own) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
      const double mean = (high.x() - low.x() + high.y() - low.y()) / 4.0;
      EXPECT_NEAR(mean, hand.parameters().segments[idx(s)].radius_base, 1.0e-3) << segment_name(s);
    }
  }
}

// Before anything turns the two sides of every cut coincide, so that the straight hand is one skin. (The file
// has micrometres.)
TEST(SegmentMeshes, FitTogetherWithoutASeamInTheStraightHand) {
  const HandModel hand = adult();
  HandPoses straight;
  hand.poses({}, straight);
  for (int s = 0; s < kPalm; ++s) {
    const test::Rim rim = rim_of(hand, s);
    const auto pose = [&](int segment) {
      return segment == kPalm
                 ? hand.palm_pose()
                 : straight.digit[idx(segment / kSegmentsPerDigit)].segment[idx(segment % kSegmentsPerDigit)];
    };
    for (std::size_t i = 0; i < rim.own.size(); ++i) {
      const double apart = (pose(s) * rim.own[i] - pose(test::neighbour_of(s)) * rim.neighbours[i]).norm();
      EXPECT_LT(apart, 3e-6) << segment_name(s);
    }
  }
}

// A left hand is the right hand's mirror image, poses and meshes alike, so that this holds for both.
TEST(SegmentMeshes, LeaveNoGapWiderThanAMillimetreAtAnyAngle) {
  const HandModel hand = adult();
  for (int d = 0; d < kDigits; ++d) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int s = segment_index(d, k);
      const bool cmc = d == 0 && k == 0;
      const Worst worst = widest_over_the_range(hand, d, k, hand.mesh(s), k == 0 ? kCmcSteps : kSteps,
                                                cmc ? kCmcReach : test::kFar);
      RecordProperty(std::string(segment_name(s)), worst.where);
      EXPECT_LE(worst.width, kGap) << worst.where;
    }
  }
}

TEST(SegmentMeshes, OpenTheWebOfTheThumbNoFartherThanSaid) {
  const HandModel hand = adult();
  const Worst worst = widest_over_the_range(hand, 0, 0, hand.mesh(0), 9);
  RecordProperty("web", worst.where);
  EXPECT_LE(worst.width, kWebGap) << worst.where;
  EXPECT_GT(worst.width, kGap) << "it closes: then the criterion holds here as well; drop the exception";
}

// The criterion can fail: with the dome at its base pressed flat a middle phalanx opens when the finger
// flexes.
TEST(SegmentMeshes, WouldLeaveAGapIfTheirCapsWereFlat) {
  const HandModel hand = adult();
  for (int d = 1; d < kDigits; ++d) {
    TriangleMesh flat = hand.mesh(segment_index(d, 1));
    for (Vec3& v : flat.vertices) v.z() = std::min(v.z(), 0.0);
    const Worst worst = widest_over_the_range(hand, d, 1, flat, kSteps);
    EXPECT_GT(worst.width, 2.0 * kGap) << digit_name(d);
  }
}

}  // namespace
}  // namespace phalanx
