// SPDX-License-Identifier: Apache-2.0
// Neighbouring segments of the adult's anatomical hand keep closing on each other when a profile stretches
// them: the criterion of tests/support/segment_rims.h where tests/hand/segment_gap_test.cpp applies it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "phalanx/core/index.h"
#include "phalanx/hand/fit.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/hand_meshes.h"
#include "phalanx/scene/profile_file.h"
#include "support/sanitized.h"
#include "support/segment_rims.h"

namespace phalanx {
namespace {

constexpr double kCmcReach = 14e-3;  // [m]

/// At the joint in front of each segment of a digit, the largest distance over seeded angles [m].
std::array<double, kPalm> rim_distances(const Profile& profile) {
  const HandFile file = read_hand_file("adult");
  const SegmentMeshes base_meshes = load_hand({}, HandDetail::kCollision).meshes.collision;
  const FittedHand fitted = fit_profile(profile, file.parameters);
  const HandModel hand(fitted.parameters, Handedness::kRight, {},
                       fitted_meshes(file.parameters, fitted.fit, base_meshes));
  // The rims with the meshes as the files number them, stretched as the meshes are; at the thumb's CMC joint
  // the points that count in the base hand.
  SegmentMeshes numbered;
  for (int s = 0; s < kSegments; ++s) numbered[idx(s)] = test::read_generic_mesh(s);
  const auto rim = [&](int s) {
    return test::read_rim(s, numbered[idx(s)].vertices, numbered[idx(test::neighbour_of(s))].vertices);
  };
  const test::Rim base_cmc = rim(0);
  numbered = fitted_meshes(file.parameters, fitted.fit, numbered);
  std::vector<test::Rim> rims;
  for (int s = 0; s < kPalm; ++s) rims.push_back(rim(s));
  test::Rim near_cmc;
  for (std::size_t i = 0; i < base_cmc.own.size(); ++i) {
    if (base_cmc.own[i].norm() >= kCmcReach) continue;
    near_cmc.own.push_back(rims[0].own[i]);
    near_cmc.neighbours.push_back(rims[0].neighbours[i]);
  }
  EXPECT_FALSE(near_cmc.own.empty());
  rims[0] = near_cmc;
  std::mt19937_64 random(31);
  std::array<double, kPalm> largest{};
  for (int n = 0; n < (test::kSlowBuild ? 8 : 30); ++n) {
    JointArray q{};
    for (std::size_t j = 0; j < kJoints; ++j) {
      std::uniform_real_distribution<double> u(fitted.parameters.min_angle[j],
                                               fitted.parameters.max_angle[j]);
      q[j] = n == 0 ? u.a() : n == 1 ? u.b() : u(random);
    }
    HandPoses poses;
    hand.poses(q, poses);
    for (int d = 0; d < kDigits; ++d) {
      const auto pose = [&](int k) { return k < 0 ? hand.palm_pose() : poses.digit[idx(d)].segment[idx(k)]; };
      const auto segment = [&](int k) { return k < 0 ? kPalm : segment_index(d, k); };
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const int s = segment(k);
        const test::Gap gap = test::widest_gap(rims[idx(s)], hand.mesh(s), hand.mesh(segment(k - 1)),
                                               pose(k - 1).inverse() * pose(k));
        largest[idx(s)] = std::max(largest[idx(s)], gap.width);
      }
    }
  }
  return largest;
}

Profile profile(const std::string& text) {
  return parse_profile("name = \"p\"\nhandedness = \"right\"\n" + text, "p.toml");
}

class FittedGap : public ::testing::TestWithParam<const char*> {};

// Between phalanges the criterion is the base hand's, 1 mm. Where a digit leaves the palm it grows with the
// hand, and with the hand's disproportion: along and across it the palm's rim has two ratios, the digit's root
// has one. Measured over these poses: 0.84 mm in the base hand, 1.09 mm at 232 x 107 mm, 1.10 mm at 150 x 95 mm,
// 1.40 mm at 225 x 72 mm.
TEST_P(FittedGap, StaysWithinTheBaseHandsCriterionAtTheExtremesOfSize) {
  const FittedHand fitted = fit_profile(profile(GetParam()), load_hand_file("adult"));
  const double along = fitted.fit.palm_length;
  const double across = fitted.fit.palm_breadth;
  const double ratio = std::max({1.0, along, across}) * std::max(along / across, across / along);
  const auto gap = rim_distances(profile(GetParam()));
  RecordProperty("largest_mm", std::to_string(1e3 * *std::max_element(gap.begin(), gap.end())));
  for (int s = 0; s < kPalm; ++s) {
    const bool at_palm = s % kSegmentsPerDigit == 0;
    EXPECT_LT(gap[idx(s)], at_palm ? 1e-3 * ratio : 1e-3) << segment_name(s) << " seed 31";
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FittedGap,
                         ::testing::Values("", "hand_length_mm = 142\nhand_breadth_mm = 65",
                                           "hand_length_mm = 166\nhand_breadth_mm = 73.7",
                                           "hand_length_mm = 232\nhand_breadth_mm = 107",
                                           // Far off in length and as far the other way in breadth.
                                           "hand_length_mm = 150\nhand_breadth_mm = 95",
                                           "hand_length_mm = 225\nhand_breadth_mm = 72",
                                           // One finger longer, one shorter than the others, one swollen.
                                           R"(hand_length_mm = 186
                                           segments = [
                                             { name = "index-finger-phalanx-proximal", length_mm = 48 },
                                             { name = "middle-finger-phalanx-intermediate", length_mm = 22 },
                                             { name = "ring-finger-phalanx-intermediate", breadth_mm = 22 }])"));

}  // namespace
}  // namespace phalanx
