// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/anthropometry.h"

#include <gtest/gtest.h>

#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace phalanx {
namespace {

// 180.5 - 4 x 9.7 (women) and 193.8 + 4 x 9.8 (men);  79.4 - 4 x 3.8 and 90.4 + 4 x 4.2.
TEST(Anthropometry, RangesReachFromTheSmallestGroupsToTheLargestGroupsFourDeviations) {
  EXPECT_NEAR(plausible_hand_length().min, 0.1417, 1e-12);
  EXPECT_NEAR(plausible_hand_length().max, 0.2330, 1e-12);
  EXPECT_NEAR(plausible_hand_breadth().min, 0.0642, 1e-12);
  EXPECT_NEAR(plausible_hand_breadth().max, 0.1072, 1e-12);
}

TEST(Anthropometry, NormsAreThePublishedMeansAndDeviationsOfMenAndWomen) {
  const auto expect_norms = [](std::span<const Norm> norms, const std::vector<Norm>& published) {
    ASSERT_EQ(norms.size(), published.size());
    for (std::size_t i = 0; i < published.size(); ++i) {
      EXPECT_EQ(norms[i].group, published[i].group);
      EXPECT_NEAR(norms[i].mean, published[i].mean, 1e-12);
      EXPECT_NEAR(norms[i].sd, published[i].sd, 1e-12);
    }
  };
  expect_norms(hand_length_norms(), {{"men", 0.1938, 0.0098}, {"women", 0.1805, 0.0097}});
  expect_norms(hand_breadth_norms(), {{"men", 0.0904, 0.0042}, {"women", 0.0794, 0.0038}});
}

// Buryanov & Kotiuk 2010, bone by bone: mean and SD [mm] from the thumb to the little finger.
TEST(Anthropometry, BonesHaveThePublishedMeansAndDeviations) {
  using Row = std::vector<std::pair<double, double>>;
  const Row metacarpals = {{46.22, 3.94}, {68.12, 6.27}, {64.60, 5.38}, {58.00, 5.06}, {53.69, 4.36}};
  const Row proximal = {{31.57, 3.13}, {39.78, 4.94}, {44.63, 3.81}, {41.37, 3.87}, {32.74, 2.77}};
  const Row middle = {{22.38, 2.51}, {26.33, 3.00}, {25.65, 3.29}, {18.11, 2.54}};  // the thumb has none
  const Row distal = {{21.67, 1.60}, {15.82, 2.26}, {17.40, 1.85}, {17.30, 2.22}, {15.96, 2.45}};
  const auto expect = [](const Norm& norm, const std::pair<double, double>& published) {
    EXPECT_NEAR(norm.mean, published.first * 1e-3, 1e-12);
    EXPECT_NEAR(norm.sd, published.second * 1e-3, 1e-12);
  };
  for (int digit = 0; digit < kDigits; ++digit) {
    SCOPED_TRACE(digit);
    const auto i = static_cast<std::size_t>(digit);
    const bool thumb = digit == 0;
    expect(metacarpal_length_norm(digit), metacarpals[i]);
    expect(segment_length_norm(segment_index(digit, 0)), thumb ? metacarpals[0] : proximal[i]);
    expect(segment_length_norm(segment_index(digit, 1)), thumb ? proximal[0] : middle[i - 1]);
    expect(segment_length_norm(segment_index(digit, 2)), distal[i]);
  }
}

// The middle finger's middle phalanx: 26.33 +- 4 x 3.00;  its metacarpal: 64.60 +- 4 x 5.38.
TEST(Anthropometry, SegmentsAreInTheOrderOfTheirNames) {
  const int segment = find_segment("middle-finger-phalanx-intermediate").value();
  EXPECT_NEAR(plausible_segment_length(segment).min, 0.01433, 1e-12);
  EXPECT_NEAR(plausible_segment_length(segment).max, 0.03833, 1e-12);
  EXPECT_NEAR(plausible_palm_ratio().min, 1.0 - 4.0 * 5.38 / 64.60, 1e-12);
  EXPECT_NEAR(plausible_palm_ratio().max, 1.0 + 4.0 * 5.38 / 64.60, 1e-12);
  EXPECT_EQ(segment_length_norm(find_segment("thumb-metacarpal").value()).mean,
            metacarpal_length_norm(0).mean);
}

// In every finger each bone is shorter than the one before it, as in every human hand.
TEST(Anthropometry, BonesGetShorterTowardsTheTip) {
  for (int digit = 0; digit < kDigits; ++digit) {
    for (int k = 0; k + 1 < kSegmentsPerDigit; ++k) {
      EXPECT_GT(segment_length_norm(segment_index(digit, k)).mean,
                segment_length_norm(segment_index(digit, k + 1)).mean);
    }
    EXPECT_GE(metacarpal_length_norm(digit).mean, segment_length_norm(segment_index(digit, 0)).mean);
  }
}

TEST(Anthropometry, AnglesHoldTheTypicalRangeOfEveryJoint) {
  const auto holds = [](const char* joint, double min_deg, double max_deg) {
    const PlausibleRange range = plausible_angle(find_joint(joint).value());
    EXPECT_LT(range.min, min_deg * std::numbers::pi / 180.0) << joint;
    EXPECT_GT(range.max, max_deg * std::numbers::pi / 180.0) << joint;
  };
  // AAOS 1965 and Eaton, as in assets/hands/adult.toml.
  holds("index_mcp_flexion", -45, 90);
  holds("ring_mcp_abduction", -20, 20);
  holds("little_pip_flexion", 0, 100);
  holds("middle_dip_flexion", 0, 90);
  holds("thumb_mcp_flexion", -10, 55);
  holds("thumb_ip_flexion", -20, 80);
}

// Our own bounds [deg]: what lies beyond is a wrong sign or unit. A profile is refused there, so they do not
// move by accident.
TEST(Anthropometry, NoJointsRangeMayReachBeyondTheseAngles) {
  const auto expect = [](const std::string& joint, double min, double max) {
    const PlausibleRange range = plausible_angle(find_joint(joint).value());
    EXPECT_NEAR(range.min, min * std::numbers::pi / 180.0, 1e-12) << joint;
    EXPECT_NEAR(range.max, max * std::numbers::pi / 180.0, 1e-12) << joint;
  };
  expect("thumb_cmc_flexion", -60, 80);
  expect("thumb_cmc_abduction", -60, 80);
  expect("thumb_mcp_flexion", -60, 100);
  expect("thumb_ip_flexion", -90, 110);
  for (const std::string finger : {"index", "middle", "ring", "little"}) {
    expect(finger + "_mcp_flexion", -90, 120);
    expect(finger + "_mcp_abduction", -50, 50);
    expect(finger + "_pip_flexion", -45, 130);
    expect(finger + "_dip_flexion", -45, 110);
  }
  EXPECT_EQ(plausible_breadth_ratio().min, 0.6);
  EXPECT_EQ(plausible_breadth_ratio().max, 1.6);
}

TEST(Anthropometry, NormsAndRangesAreZeroUntilStated) {
  EXPECT_EQ(Norm{}.mean, 0.0);
  EXPECT_EQ(Norm{}.sd, 0.0);
  EXPECT_EQ(PlausibleRange{}.min, 0.0);
  EXPECT_EQ(PlausibleRange{}.max, 0.0);
}

}  // namespace
}  // namespace phalanx
