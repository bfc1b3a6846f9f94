// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/fit.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/hand/hand_meshes.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

constexpr int kMiddle = static_cast<int>(Digit::kMiddle);

/// The simple hand, its knuckles 90 mm beyond the wrist.
HandParameters forward_knuckles() {
  HandParameters hand = test::simple_parameters();
  for (DigitParameters& digit : hand.digits) digit.base.z() = -0.09;
  return hand;
}

SegmentMeshes capsules(const HandParameters& parameters) {
  return make_capsule_meshes(parameters, Handedness::kRight, 800);
}

/// Where the fit puts one point of a segment.
Vec3 moved(const HandParameters& base, const HandFit& fit, int segment, const Vec3& p) {
  SegmentMeshes meshes;
  meshes[idx(segment)].vertices = {p};
  return fitted_meshes(base, fit, meshes)[idx(segment)].vertices.front();
}

HandSize random_size(std::mt19937_64& random, const HandParameters& base) {
  std::uniform_real_distribution<double> ratio(0.8, 1.25);
  std::bernoulli_distribution stated(0.5);
  HandSize size;
  size.hand_length = ratio(random) * hand_length(base);
  size.hand_breadth = ratio(random) * hand_breadth(base);
  for (int s = 0; s < kSegments - 1; ++s) {
    if (stated(random)) size.segment[idx(s)].length = ratio(random) * segment_length(base, s);
    if (stated(random)) size.segment[idx(s)].breadth = ratio(random) * segment_breadth(base, s);
  }
  return size;
}

TEST(Fit, OfNothingStatedIsTheBaseHand) {
  const HandParameters base = forward_knuckles();
  const HandFit fit = fit_hand(base, {});
  const HandParameters hand = fitted_parameters(base, fit);
  for (std::size_t d = 0; d < kDigits; ++d) {
    EXPECT_EQ(hand.digits[d].base, base.digits[d].base);
    for (std::size_t i = 0; i < kJointsPerDigit; ++i)
      EXPECT_EQ(hand.digits[d].dh[i].a, base.digits[d].dh[i].a);
  }
  const SegmentMeshes before = capsules(base);
  const SegmentMeshes after = fitted_meshes(base, fit, before);
  for (std::size_t s = 0; s < kSegments; ++s) {
    for (std::size_t v = 0; v < before[s].vertices.size(); ++v)
      EXPECT_LT((after[s].vertices[v] - before[s].vertices[v]).norm(), 1e-15);
  }
}

TEST(Fit, HandLengthIsTheSumOfItsPartsByHand) {
  HandParameters p = forward_knuckles();
  DigitParameters& middle = p.digits[kMiddle];
  middle.base = {0.003, 0.001, -0.09};
  middle.distal = {0.0, -0.6, -0.8};
  middle.dh[0].a = 0.0;
  middle.dh[1].a = 0.045;
  middle.dh[2].a = 0.026;
  SegmentShape& tip = p.segments[idx(segment_index(kMiddle, 2))];
  tip.length = 0.015;
  tip.radius_tip = 0.006;
  EXPECT_NEAR(hand_length(p), 0.09 + 0.8 * (0.045 + 0.026 + 0.015 + 0.006), 1e-15);
}

TEST(Fit, ReproducesHandLengthAndBreadthAndEveryStatedSegment) {
  const HandParameters base = forward_knuckles();
  std::mt19937_64 random(11);
  for (int n = 0; n < 300; ++n) {
    const HandSize size = random_size(random, base);
    const HandFit fit = fit_hand(base, size);
    HandParameters hand;
    try {
      hand = fitted_parameters(base, fit);
    } catch (const std::invalid_argument&) {
      continue;  // too short for its breadth: another test's
    }
    EXPECT_NEAR(hand_length(hand), *size.hand_length, 1e-12) << "seed 11 case " << n;
    EXPECT_NEAR(hand_breadth(hand), *size.hand_breadth, 1e-12) << "seed 11 case " << n;
    for (int s = 0; s < kSegments - 1; ++s) {
      const auto& breadth = size.segment[idx(s)].breadth;
      if (breadth) {
        EXPECT_NEAR(segment_breadth(hand, s), *breadth, 1e-12) << "seed 11 case " << n;
      }
      const auto& stated = size.segment[idx(s)].length;
      if (stated) {
        EXPECT_NEAR(segment_length(hand, s), *stated, 1e-12) << "seed 11 case " << n;
      }
    }
  }
}

TEST(Fit, ScalesAMeshToItsStatedBreadthInTheMiddleOfTheBone) {
  const HandParameters base = forward_knuckles();
  const int s = segment_index(1, 1);
  HandSize size;
  size.segment[idx(s)].breadth = 1.2 * segment_breadth(base, s);
  size.hand_breadth = hand_breadth(base);
  const HandFit fit = fit_hand(base, size);
  const double half = 0.5 * segment_length(base, s);
  const Vec3 p = moved(base, fit, s, {0.01, -0.005, -half});
  EXPECT_NEAR(p.x(), 0.012, 1e-15);
  EXPECT_NEAR(p.y(), -0.006, 1e-15);
  EXPECT_NEAR(p.z(), -half, 1e-15) << "by symmetry: both joints are scaled alike";
}

TEST(Fit, WhatIsNotStatedFollowsTheHandsLengthAndBreadth) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  size.hand_length = 1.1 * hand_length(base);
  HandFit fit = fit_hand(base, size);
  for (const SegmentFit& own : fit.segment) EXPECT_NEAR(own.length, 1.1, 1e-12);
  EXPECT_NEAR(fit.palm_breadth, 1.1, 1e-12) << "no breadth is stated: the hand keeps its proportions";
  size.hand_breadth = 0.9 * hand_breadth(base);
  fit = fit_hand(base, size);
  for (const SegmentFit& own : fit.segment) EXPECT_NEAR(own.breadth_middle, 0.9, 1e-12);
  EXPECT_NEAR(fit.palm_length, 1.1, 1e-12);
  HandSize part;
  part.segment[idx(segment_index(1, 0))].length = 1.2 * segment_length(base, segment_index(1, 0));
  fit = fit_hand(base, part);
  EXPECT_EQ(fit.segment[idx(segment_index(1, 1))].length, 1.0)
      << "one finger's phalanx says nothing of others";
  HandSize all;
  for (int s = 0; s < kSegments - 1; ++s) all.segment[idx(s)].length = 1.2 * segment_length(base, s);
  EXPECT_NEAR(fit_hand(base, all).palm_length, 1.2, 1e-12);
}

// A breadth of two neighbours' mean at each joint; at the knuckle the palm's.
TEST(Fit, AFingerIsAsBroadAsThePalmAtItsKnuckle) {
  const HandParameters base = forward_knuckles();
  const int s = segment_index(1, 0);
  HandSize size;
  size.hand_breadth = hand_breadth(base);
  size.segment[idx(s)].breadth = 1.2 * segment_breadth(base, s);
  const HandFit fit = fit_hand(base, size);
  EXPECT_NEAR(fit.segment[idx(s)].breadth_base, 1.0, 1e-12);
  EXPECT_NEAR(fit.segment[idx(s)].breadth_middle, 1.2, 1e-12);
  EXPECT_NEAR(fit.segment[idx(s)].breadth_end, 1.1, 1e-12);
  EXPECT_NEAR(fit.segment[idx(s + 1)].breadth_base, 1.1, 1e-12);
}

// Only a breadth is stated: the hand keeps its proportions.
TEST(Fit, LengthsFollowABreadthThatAloneIsStated) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  size.hand_breadth = 0.9 * hand_breadth(base);
  const HandFit fit = fit_hand(base, size);
  EXPECT_NEAR(fit.palm_length, 0.9, 1e-12);
  for (const SegmentFit& own : fit.segment) EXPECT_NEAR(own.length, 0.9, 1e-12);
}

// 4 mm of soft tip beyond a bone of 20 mm: with a length of 1.1 both grow by it, so that the mesh ends where
// the hand's length says; a middle segment's end grows with its breadth of 0.9.
TEST(Fit, ASoftTipGrowsWithItsBone) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  size.hand_length = 1.1 * hand_length(base);
  size.hand_breadth = 0.9 * hand_breadth(base);
  const HandFit fit = fit_hand(base, size);
  for (const int k : {1, 2}) {
    const int s = segment_index(1, k);
    const double bone = segment_length(base, s);
    EXPECT_NEAR(moved(base, fit, s, {0.0, 0.0, -bone - 4e-3}).z(), -1.1 * bone - (k == 2 ? 1.1 : 0.9) * 4e-3,
                1e-12)
        << k;
  }
}

// Capsule and palm of a fit that is written by hand. The segment's ends take 0.9 and 1.1 of their radii, then
// both the factor that makes their sum 1.2 times the base's; only the palm's offset along z goes with its
// length.
TEST(Fit, ScalesCapsulesAndPalmAsByHand) {
  HandParameters base = forward_knuckles();
  const int s = segment_index(1, 0);
  base.segments[idx(s)].radius_base = 8e-3;
  base.segments[idx(s)].radius_tip = 7e-3;
  base.segments[idx(s)].length = 40e-3;
  base.palm = {.length = 0.08,
               .wrist_breadth = 0.06,
               .wrist_thickness = 0.03,
               .knuckle_breadth = 0.08,
               .knuckle_thickness = 0.025,
               .offset = Vec3(0.01, -0.02, 0.15)};
  base.digits[3].metacarpal_base = Vec3(0.01, -0.01, -0.03);
  base.digits[3].coupling.metacarpal_per_flexion = 0.2;
  HandFit fit;
  fit.segment[idx(s)] = {.length = 1.0, .breadth_base = 0.9, .breadth_middle = 1.2, .breadth_end = 1.1};
  fit.palm_length = 1.2;
  fit.palm_breadth = 0.9;
  const HandParameters hand = fitted_parameters(base, fit);
  const double sum = 0.9 * 8.0 + 1.1 * 7.0;  // 14.9 mm, which 1.2 x 15 mm = 18 mm are
  EXPECT_NEAR(hand.segments[idx(s)].radius_base, 7.2e-3 * 18.0 / sum, 1e-15);
  EXPECT_NEAR(hand.segments[idx(s)].radius_tip, 7.7e-3 * 18.0 / sum, 1e-15);
  EXPECT_NEAR(hand.segments[idx(s)].length, 40e-3, 1e-15);
  EXPECT_LT((hand.digits[3].metacarpal_base - Vec3(0.009, -0.009, -0.036)).norm(), 1e-15);
  EXPECT_NEAR(hand.digits[3].coupling.metacarpal_per_flexion, 0.2 * 0.9 / 1.2, 1e-15);
  EXPECT_NEAR(hand.palm.length, 0.096, 1e-15);
  EXPECT_NEAR(hand.palm.wrist_breadth, 0.054, 1e-15);
  EXPECT_NEAR(hand.palm.wrist_thickness, 0.027, 1e-15);
  EXPECT_NEAR(hand.palm.knuckle_breadth, 0.072, 1e-15);
  EXPECT_NEAR(hand.palm.knuckle_thickness, 0.0225, 1e-15);
  EXPECT_LT((hand.palm.offset - Vec3(0.009, -0.018, 0.18)).norm(), 1e-15);
}

// Each row of the D-H table goes with the segment that its joint moves, both MCP axes with the first one; a
// distal capsule ends where its bone and its soft tip do: 1.3 x 25 mm less the tip's 5 mm. What the fit does
// not name stays.
TEST(Fit, ScalesDhRowsAndLengthsWithTheirSegments) {
  HandParameters base = forward_knuckles();
  DigitParameters& index = base.digits[test::kIndex];
  index.dh[0].a = 5e-3;
  const std::array<double, kJointsPerDigit> offset = {2e-3, -3e-3, 4e-3, 1e-3};
  for (std::size_t i = 0; i < kJointsPerDigit; ++i) index.dh[i].d = offset[i];
  HandFit fit;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    fit.segment[idx(segment_index(test::kIndex, k))].length = 1.1 + 0.1 * k;
  const HandParameters hand = fitted_parameters(base, fit);
  const std::array<double, kJointsPerDigit> a = {5.5e-3, 44e-3, 30e-3, 26e-3};
  const std::array<double, kJointsPerDigit> d = {2.2e-3, -3.3e-3, 4.8e-3, 1.3e-3};
  for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
    EXPECT_NEAR(hand.digits[test::kIndex].dh[i].a, a[i], 1e-15) << i;
    EXPECT_NEAR(hand.digits[test::kIndex].dh[i].d, d[i], 1e-15) << i;
    EXPECT_EQ(hand.digits[kMiddle].dh[i].a, base.digits[kMiddle].dh[i].a) << i;
  }
  EXPECT_NEAR(hand.segments[idx(segment_index(test::kIndex, 0))].length, 44e-3, 1e-15);
  EXPECT_NEAR(hand.segments[idx(segment_index(test::kIndex, 1))].length, 30e-3, 1e-15);
  EXPECT_NEAR(hand.segments[idx(segment_index(test::kIndex, 2))].length, 27.5e-3, 1e-15);
  for (std::size_t s = 0; s < kSegments - 1; ++s) {
    EXPECT_NEAR(hand.segments[s].radius_base, base.segments[s].radius_base, 1e-15) << s;
    EXPECT_NEAR(hand.segments[s].radius_tip, base.segments[s].radius_tip, 1e-15) << s;
  }
  EXPECT_EQ(hand.digits[kMiddle].base, base.digits[kMiddle].base);
  EXPECT_EQ(hand.palm.length, base.palm.length);
  EXPECT_EQ(hand.palm.knuckle_breadth, base.palm.knuckle_breadth);
}

// Thumb tip 1.2, index proximal 0.8, the rest 1: a tip has no neighbour beyond it, least of all the next
// digit's first segment.
TEST(Fit, ATipIsAsBroadAtItsEndAsInItsMiddle) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  size.hand_breadth = hand_breadth(base);
  size.segment[idx(segment_index(0, 2))].breadth = 1.2 * segment_breadth(base, segment_index(0, 2));
  size.segment[idx(segment_index(1, 0))].breadth = 0.8 * segment_breadth(base, segment_index(1, 0));
  const HandFit fit = fit_hand(base, size);
  EXPECT_NEAR(fit.segment[idx(segment_index(0, 1))].breadth_end, 1.1, 1e-12);
  EXPECT_NEAR(fit.segment[idx(segment_index(0, 2))].breadth_base, 1.1, 1e-12);
  EXPECT_NEAR(fit.segment[idx(segment_index(0, 2))].breadth_end, 1.2, 1e-12);
  EXPECT_NEAR(fit.segment[idx(segment_index(1, 0))].breadth_base, 1.0, 1e-12);
  EXPECT_NEAR(fit.segment[idx(segment_index(1, 0))].breadth_end, 0.9, 1e-12);
  EXPECT_NEAR(fit.segment[idx(segment_index(1, 2))].breadth_end, 1.0, 1e-12);
}

// All fifteen breadths, and nothing else: what they have in common is the hand's.
TEST(Fit, ThePalmAndTheLengthsFollowTheBreadthsIfAllAreStated) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  for (int s = 0; s < kSegments - 1; ++s) size.segment[idx(s)].breadth = 0.9 * segment_breadth(base, s);
  HandFit fit = fit_hand(base, size);
  EXPECT_NEAR(fit.palm_breadth, 0.9, 1e-12);
  EXPECT_NEAR(fit.palm_length, 0.9, 1e-12);
  for (const SegmentFit& own : fit.segment) EXPECT_NEAR(own.length, 0.9, 1e-12);
  size.segment.back().breadth.reset();
  fit = fit_hand(base, size);
  EXPECT_EQ(fit.palm_breadth, 1.0) << "one is not stated";
}

// By hand, on a bone of 40 mm. Smooth steps from 0.9 through 1.2 to 1.1: at an eighth 0.9 + 0.3 x 0.15625, at
// five eighths 1.2 - 0.1 x 0.15625. Along it 1.2 t^2 (3 - 2 t) + 0.9 t (1 - t)^2 - 1.1 t^2 (1 - t):
// 0.12265625 and 0.73828125.
TEST(Fit, MovesAPointBesideABoneAsByHand) {
  const HandParameters base = forward_knuckles();
  const int s = segment_index(1, 0);
  HandFit fit;
  fit.segment[idx(s)] = {.length = 1.2, .breadth_base = 0.9, .breadth_middle = 1.2, .breadth_end = 1.1};
  const Vec3 eighth = moved(base, fit, s, {0.01, -0.005, -0.005});
  EXPECT_LT((eighth - Vec3(0.00946875, -0.004734375, -0.00490625)).norm(), 1e-15);
  const Vec3 five_eighths = moved(base, fit, s, {0.01, -0.005, -0.025});
  EXPECT_LT((five_eighths - Vec3(0.01184375, -0.005921875, -0.02953125)).norm(), 1e-15);
}

// A bone of 0.4 of its length between joints of 1.2 and 1.3 times their breadth: beyond its ends the mesh
// grows by 2.5 x 0.4 = 1 at most, so that 4 mm stay 4 mm.
TEST(Fit, AShortBoneKeepsItsEndsSlopesWithinTwoAndAHalfTimesItsLength) {
  const HandParameters base = forward_knuckles();
  const int s = segment_index(1, 0);
  HandFit fit;
  fit.segment[idx(s)] = {.length = 0.4, .breadth_base = 1.2, .breadth_middle = 1.2, .breadth_end = 1.3};
  EXPECT_NEAR(moved(base, fit, s, {0.0, 0.0, 0.004}).z(), 0.004, 1e-15);
  EXPECT_NEAR(moved(base, fit, s, {0.0, 0.0, -0.044}).z(), -0.020, 1e-15);
}

// Around a joint both segments are scaled by one number in all directions, so that turning them against each
// other opens no gap that the base hand's did not have.
TEST(Fit, ScalesBothSegmentsOfAJointAlikeAroundIt) {
  const HandParameters base = forward_knuckles();
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> u(-0.004, 0.004);
  for (int n = 0; n < 100; ++n) {
    const HandFit fit = fit_hand(base, random_size(random, base));
    for (int digit = 0; digit < kDigits; ++digit) {
      for (int k = 0; k < kSegmentsPerDigit - 1; ++k) {
        const int s = segment_index(digit, k);
        const double ratio = fit.segment[idx(s)].breadth_end;
        ASSERT_EQ(ratio, fit.segment[idx(s + 1)].breadth_base);
        const Vec3 offset(u(random), u(random), -std::abs(u(random)));  // beyond the near bone's end
        const Vec3 end(0.0, 0.0, -segment_length(base, s));
        const Vec3 new_end(0.0, 0.0, fit.segment[idx(s)].length * end.z());
        EXPECT_LT((moved(base, fit, s, end + offset) - new_end - ratio * offset).norm(), 1e-14)
            << "seed 12 case " << n;
        const Vec3 behind(offset.x(), offset.y(), -offset.z());  // behind the far segment's joint
        EXPECT_LT((moved(base, fit, s + 1, behind) - ratio * behind).norm(), 1e-14) << "seed 12 case " << n;
      }
    }
  }
}

TEST(Fit, ScalesThePalmAroundAKnuckleAsTheFinger) {
  HandParameters base = forward_knuckles();
  for (int d = 0; d < kDigits; ++d) base.digits[idx(d)].base = {0.06 * (d - 2), 0.0, -0.08};
  HandSize size;
  size.hand_length = 1.2 * hand_length(base);
  size.hand_breadth = 0.9 * hand_breadth(base);
  const HandFit fit = fit_hand(base, size);
  const Vec3 knuckle = base.digits[kMiddle].base;
  const Vec3 offset(0.002, 0.004, -0.003);
  const Vec3 new_knuckle = fitted_parameters(base, fit).digits[kMiddle].base;
  // The other knuckles, 60 mm away, weigh (0.0054 / 0.06)^4 = 7e-5 each and lie at the same height.
  EXPECT_LT((moved(base, fit, kPalm, knuckle + offset) - new_knuckle - 0.9 * offset).norm(), 1e-12);
  const Vec3 wrist(0.02, 0.0, 0.0);
  EXPECT_LT((moved(base, fit, kPalm, wrist) - Vec3(0.018, 0.0, 0.0)).norm(), 1e-12);
}

// From 10 to 35 mm of a knuckle the palm passes from its breadth's ratio to its length's. At 22.5 mm, half of
// it: 1.2 z - 0.3 x 0.5 x 13.5 mm. At 16.25 mm, a quarter, 1 - 0.15625 of it: 1.2 z - 0.3 x 0.84375 x 9.75
// mm.
TEST(Fit, ThePalmPassesSmoothlyFromItsKnucklesToItsWhole) {
  HandParameters base = forward_knuckles();
  for (int d = 0; d < kDigits; ++d) base.digits[idx(d)].base = {0.06 * (d - 2), 0.0, -0.08};
  HandFit fit;
  fit.palm_length = 1.2;
  fit.palm_breadth = 0.9;
  const Vec3 half = moved(base, fit, kPalm, {0.0, 0.018, -0.0665});
  EXPECT_LT((half - Vec3(0.0, 0.0162, -0.081825)).norm(), 1e-12);
  const Vec3 quarter = moved(base, fit, kPalm, {0.0, 0.013, -0.07025});
  EXPECT_LT((quarter - Vec3(0.0, 0.0117, -0.08676796875)).norm(), 1e-12);
}

// Four knuckles 10 mm away at z = -80 mm, one 20 mm away at -60 mm, of a sixteenth of the weight of each: the
// height is (-64 x 80 - 60) / 65 mm = -80 mm + 20/65 mm. At a knuckle it is that knuckle's alone.
TEST(Fit, ThePalmWeighsItsKnucklesByTheInverseFourthPowerOfTheirDistance) {
  HandParameters base = forward_knuckles();
  for (DigitParameters& digit : base.digits) digit.base = {0.0, 0.0, -0.08};
  base.digits.back().base = {0.0, 0.010, -0.06};
  HandFit fit;
  fit.palm_length = 1.2;
  fit.palm_breadth = 0.9;
  const Vec3 between = moved(base, fit, kPalm, {0.0, 0.010, -0.08});
  EXPECT_LT((between - Vec3(0.0, 0.009, -0.096 + 0.3 * 0.02 / 65.0)).norm(), 1e-12);
  const Vec3 knuckle = moved(base, fit, kPalm, {0.0, 0.010, -0.06});
  EXPECT_LT((knuckle - Vec3(0.0, 0.009, -0.072)).norm(), 1e-12);
}

TEST(Fit, KeepsMeshesClosedAndOutwardAtTheExtremes) {
  const HandParameters base = forward_knuckles();
  std::mt19937_64 random(13);
  for (int n = 0; n < 20; ++n) {
    const SegmentMeshes meshes =
        fitted_meshes(base, fit_hand(base, random_size(random, base)), capsules(base));
    for (int s = 0; s < kSegments; ++s) {
      EXPECT_TRUE(is_closed(meshes[idx(s)])) << segment_name(s);
      EXPECT_GT(signed_volume(meshes[idx(s)]), 0.0) << segment_name(s) << " seed 13 case " << n;
    }
  }
}

TEST(Fit, RefusesAMiddleFingerThatIsLongerThanTheHand) {
  const HandParameters base = forward_knuckles();
  HandSize size;
  size.hand_length = 0.05;
  size.segment[idx(segment_index(kMiddle, 0))].length = 0.06;
  EXPECT_THAT([&] { (void)fit_hand(base, size); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("longer than the hand")));
}

TEST(Fit, RefusesABaseHandWhoseMiddleFingerDoesNotBeginBeyondTheWrist) {
  for (const double z : {0.0, 0.01}) {
    HandParameters base = forward_knuckles();
    base.digits[kMiddle].base.z() = z;
    HandSize size;
    size.hand_length = 0.1;
    size.segment[idx(segment_index(kMiddle, 0))].length = 0.04;
    EXPECT_THAT([&] { (void)fit_hand(base, size); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("beyond the wrist")))
        << z;
    // With no segment of that finger stated the palm goes with the hand: 40 + 25 + 20 + 5 mm less z are 100.
    size.segment[idx(segment_index(kMiddle, 0))].length.reset();
    EXPECT_NEAR(fit_hand(base, size).palm_length, 0.1 / (0.09 - z), 1e-12);
  }
}

// Radii of 8 and 7 mm: spheres less than 1 mm apart lie one inside the other.
TEST(Fit, RefusesASegmentThatIsNotLongerThanTheDifferenceOfItsRadii) {
  HandParameters base = forward_knuckles();
  SegmentShape& shape = base.segments[idx(segment_index(1, 0))];
  for (const bool thicker_tip : {false, true}) {
    shape.radius_base = thicker_tip ? 7e-3 : 8e-3;
    shape.radius_tip = thicker_tip ? 8e-3 : 7e-3;
    shape.length = 1.5e-3;
    EXPECT_NO_THROW((void)fitted_parameters(base, {})) << thicker_tip;
    shape.length = 0.5e-3;
    EXPECT_THAT([&] { (void)fitted_parameters(base, {}); },
                ::testing::ThrowsMessage<std::invalid_argument>(
                    ::testing::HasSubstr("index-finger-phalanx-proximal is too short")))
        << thicker_tip;
  }
}

TEST(Fit, RefusesSizesThatAreNoLengths) {
  const HandParameters base = forward_knuckles();
  for (const double bad : {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto expect_refused = [&](const HandSize& size, const char* what) {
      EXPECT_THAT([&] { (void)fit_hand(base, size); },
                  ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(what)))
          << bad;
    };
    HandSize size;
    size.hand_breadth = bad;
    expect_refused(size, "hand breadth is");
    size = {};
    size.hand_length = bad;
    expect_refused(size, "hand length is");
    for (const auto& [segment, name] :
         {std::pair{0, "thumb-metacarpal"}, {14, "pinky-finger-phalanx-distal"}}) {
      size = {};
      size.segment[idx(segment)].length = bad;
      expect_refused(size, (std::string(name) + ": length is").c_str());
      size = {};
      size.segment[idx(segment)].breadth = bad;
      expect_refused(size, (std::string(name) + ": breadth is").c_str());
    }
  }
}

// An error in the second person's sizes does not affect the first person's.
TEST(Fit, ReadsTheSegmentsOfOnePersonAlone) {
  const HandParameters base = forward_knuckles();
  std::array<HandSize, 2> people;
  for (int s = 0; s < kSegments - 1; ++s) people[0].segment[idx(s)].length = 1.2 * segment_length(base, s);
  people[1].hand_length = -0.1;
  people[1].hand_breadth = -0.1;
  HandFit fit;
  ASSERT_NO_THROW(fit = fit_hand(base, people[0]));
  EXPECT_NEAR(fit.palm_length, 1.2, 1e-12);
}

}  // namespace
}  // namespace phalanx
