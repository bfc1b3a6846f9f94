// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/hand_file.h"

#include <fstream>
#include <iterator>
#include <numbers>

#include "scene/expect_error.h"

namespace phalanx {
namespace {

/// A hand file without coupled rotations, whose numbers stay (tests/scene/hands/papers_hand_test.cpp).
std::string papers_text() {
  std::ifstream file(PHALANX_SOURCE_DIR "/assets/hands/papers.toml");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// papers.toml with one piece of text replaced by another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = papers_text();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_hand_refused(const std::string& text, const std::vector<std::string>& words) {
  expect_scene_error([&] { static_cast<void>(parse_hand(text, "bad.toml")); }, words);
}

// Buryanov & Kotiuk 2010, mm: metacarpal (thumb) or proximal, middle or proximal (thumb), distal; soft tip.
TEST(AdultHand, HasThePublishedBoneLengths) {
  constexpr double kPublished[kDigits][4] = {{46.22, 31.57, 21.67, 5.67},
                                             {39.78, 22.38, 15.82, 3.84},
                                             {44.63, 26.33, 17.40, 3.95},
                                             {41.37, 25.65, 17.30, 3.95},
                                             {32.74, 18.11, 15.96, 3.73}};
  const HandParameters hand = load_hand_file("adult");
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto d = static_cast<std::size_t>(digit);
    EXPECT_EQ(hand.digits[d].dh[0].a, 0.0);
    for (std::size_t bone = 0; bone < 3; ++bone) {
      EXPECT_NEAR(hand.digits[d].dh[bone + 1].a, kPublished[d][bone] * 1e-3, 1e-12)
          << digit_name(digit) << " " << bone;
    }
    const SegmentShape& distal = hand.segments[d * 3 + 2];
    EXPECT_NEAR(distal.length + distal.radius_tip, (kPublished[d][2] + kPublished[d][3]) * 1e-3, 2e-5)
        << digit_name(digit);
  }
}

// Base + metacarpal length along base -> knuckle, computed here from the numbers that the file's comment
// states.
TEST(AdultHand, HasItsKnucklesAMetacarpalFromTheirBases) {
  struct Metacarpal {
    Vec3 base, knuckle;
    double length;
  };
  const Metacarpal metacarpals[] = {{{-10.17, -7.07, -29.22}, {-23.55, -7.32, -88.55}, 68.12},
                                    {{-3.43, -6.06, -29.11}, {-1.73, -2.55, -91.65}, 64.60},
                                    {{8.09, -6.06, -27.00}, {17.46, -6.53, -84.70}, 58.00},
                                    {{23.00, -9.42, -34.08}, {35.05, -13.70, -73.90}, 53.69}};
  const HandParameters hand = load_hand_file("adult");
  for (std::size_t i = 0; i < 4; ++i) {
    const Metacarpal& m = metacarpals[i];
    const Vec3 expected = (m.base + m.length * (m.knuckle - m.base).normalized()) * 1e-3;
    EXPECT_LT((hand.digits[i + 1].base - expected).norm(), 1e-5) << digit_name(static_cast<int>(i) + 1);
  }
}

TEST(AdultHand, HasOrthonormalDirections) {
  for (const DigitParameters& digit : load_hand_file("adult").digits) {
    EXPECT_NEAR(digit.distal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(digit.dorsal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(digit.dorsal.dot(digit.distal), 0.0, 1e-12);
  }
}

TEST(AdultHand, OpensWithinItsRangeOfMotion) {
  const HandParameters hand = load_hand_file("adult");
  for (std::size_t j = 0; j < kJoints; ++j) {
    EXPECT_LE(hand.min_angle[j], hand.open_angle[j]);
    EXPECT_GE(hand.max_angle[j], hand.open_angle[j]);
  }
  EXPECT_NEAR(hand.max_angle[6], 100.0 * std::numbers::pi / 180.0, 1e-12) << "index PIP";
}

// One joint's line with a number of its own in each place, and the numbers that the file has for the palm and
// for the thumb's first segment.
TEST(HandFile, StatesEachNumberInItsUnit) {
  const HandParameters hand =
      parse_hand(changed("a_mm = 0.0,   alpha_deg = 90.0,  d_mm = 0.0, theta_deg = 0.0, min_deg = -18.0, "
                         "max_deg = 35.0, open_deg = 0.0",
                         "a_mm = 4, alpha_deg = 80, d_mm = -3, theta_deg = 20, min_deg = -15, max_deg = 30, "
                         "open_deg = 5"),
                 "good.toml");
  constexpr double kDegree = std::numbers::pi / 180.0;
  const DhRow& row = hand.digits[0].dh[0];
  EXPECT_DOUBLE_EQ(row.a, 0.004);
  EXPECT_DOUBLE_EQ(row.alpha, 80.0 * kDegree);
  EXPECT_DOUBLE_EQ(row.d, -0.003);
  EXPECT_DOUBLE_EQ(row.theta, 20.0 * kDegree);
  EXPECT_DOUBLE_EQ(hand.min_angle[0], -15.0 * kDegree);
  EXPECT_DOUBLE_EQ(hand.max_angle[0], 30.0 * kDegree);
  EXPECT_DOUBLE_EQ(hand.open_angle[0], 5.0 * kDegree);
  EXPECT_DOUBLE_EQ(hand.segments[0].length, 46.22e-3);
  EXPECT_DOUBLE_EQ(hand.segments[0].radius_base, 13e-3);
  EXPECT_DOUBLE_EQ(hand.segments[0].radius_tip, 11.5e-3);
  EXPECT_DOUBLE_EQ(hand.palm.length, 66e-3);
  EXPECT_DOUBLE_EQ(hand.palm.wrist_breadth, 58e-3);
  EXPECT_DOUBLE_EQ(hand.palm.wrist_thickness, 36e-3);
  EXPECT_DOUBLE_EQ(hand.palm.knuckle_breadth, 81.5e-3);
  EXPECT_DOUBLE_EQ(hand.palm.knuckle_thickness, 30.5e-3);
  EXPECT_LT((hand.palm.offset - Vec3(5e-3, -7e-3, -14e-3)).norm(), 1e-15);
}

// Neighbouring straight fingers: the least distance of their centre lines against the sum of the radii there.
TEST(AdultHand, KeepsItsOpenFingersApart) {
  const HandParameters hand = load_hand_file("adult");
  const auto along = [&](std::size_t digit, double s) {
    return Vec3(hand.digits[digit].base + s * hand.digits[digit].distal);
  };
  const auto radius = [&](std::size_t digit, double s) {
    for (std::size_t k = 0; k < 3; ++k) {
      const SegmentShape& shape = hand.segments[digit * 3 + k];
      const double bone = hand.digits[digit].dh[k + 1].a;
      if (s <= bone || k == 2)
        return shape.radius_base + (shape.radius_tip - shape.radius_base) * std::min(1.0, s / shape.length);
      s -= bone;
    }
    return 0.0;
  };
  for (std::size_t digit = 1; digit < 4; ++digit) {
    for (double s = 0.0; s < 0.07; s += 0.005) {
      for (double t = 0.0; t < 0.07; t += 0.005) {
        const double gap =
            (along(digit, s) - along(digit + 1, t)).norm() - radius(digit, s) - radius(digit + 1, t);
        EXPECT_GT(gap, -1e-3) << digit_name(static_cast<int>(digit)) << " at " << s << " m, next at " << t
                              << " m";
      }
    }
  }
}

TEST(HandFile, WithALineThatNobodyKnows) {
  expect_hand_refused(changed("offset_mm", "offsett_mm = [0, 0, 0]\noffset_mm"),
                      {"bad.toml:", "palm.offsett_mm", "nearest known one is palm.offset_mm"});
}

TEST(HandFile, WithoutADigit) { expect_hand_refused("name = \"x\"", {"bad.toml", "thumb", "is missing"}); }

TEST(HandFile, WithANumberThatIsNotFinite) {
  expect_hand_refused(changed("a_mm = 46.22", "a_mm = nan"), {"a_mm = nan", "must be"});
}

TEST(HandFile, WithANegativeRadius) {
  expect_hand_refused(changed("radius_tip_mm = 11.5", "radius_tip_mm = -11.5"),
                      {"thumb.segments.0.radius_tip_mm = -11.5", "> 0"});
}

// Each number in the place of the first one of that name in papers.toml.
TEST(HandFile, TakesEachNumberUpToItsBoundAndNoFurther) {
  struct Bound {
    const char* key;
    const char* before;  ///< what stands there before the number
    const char* usual;
    const char* good;
    const char* bad;
  };
  for (const Bound& b : {Bound{"thumb.base_mm", "base_mm = [", "-28.03", "300", "300.1"},
                         Bound{"thumb.base_mm", "base_mm = [", "-28.03", "-300", "-300.1"},
                         Bound{"thumb.distal", "distal = [", "-0.519", "1000", "1000.1"},
                         Bound{"thumb.distal", "distal = [", "-0.519", "-1000", "-1000.1"},
                         Bound{"thumb.joints.0.a_mm", " a_mm = ", "0.0", "200", "200.1"},
                         Bound{"thumb.joints.0.a_mm", " a_mm = ", "0.0", "0", "-0.001"},
                         Bound{"thumb.joints.0.alpha_deg", "alpha_deg = ", "90.0", "180", "180.1"},
                         Bound{"thumb.joints.0.alpha_deg", "alpha_deg = ", "90.0", "-180", "-180.1"},
                         Bound{"thumb.joints.0.d_mm", " d_mm = ", "0.0", "300", "300.1"},
                         Bound{"thumb.joints.0.d_mm", " d_mm = ", "0.0", "-300", "-300.1"},
                         Bound{"thumb.joints.0.theta_deg", "theta_deg = ", "0.0", "180", "180.1"},
                         Bound{"thumb.joints.0.theta_deg", "theta_deg = ", "0.0", "-180", "-180.1"},
                         Bound{"thumb.joints.0.min_deg", "min_deg = ", "-18.0", "-180", "-180.1"},
                         Bound{"thumb.joints.0.max_deg", "max_deg = ", "35.0", "180", "180.1"},
                         Bound{"thumb.joints.0.open_deg", "open_deg = ", "0.0", "35", "35.1"},
                         Bound{"thumb.joints.0.open_deg", "open_deg = ", "0.0", "-18", "-18.1"},
                         Bound{"thumb.segments.0.length_mm", " length_mm = ", "46.22", "200", "200.1"},
                         Bound{"thumb.segments.0.radius_tip_mm", "radius_tip_mm = ", "11.5", "1e-9", "0"},
                         Bound{"palm.wrist_breadth_mm", "wrist_breadth_mm = ", "58.0", "200", "200.1"},
                         Bound{"palm.wrist_breadth_mm", "wrist_breadth_mm = ", "58.0", "1e-9", "0"},
                         Bound{"palm.offset_mm", "offset_mm = [", "5.0", "300", "300.1"},
                         Bound{"meshes.unit_mm", "unit_mm = ", "1\n", "1000000\n", "1000000.1\n"},
                         Bound{"meshes.unit_mm", "unit_mm = ", "1\n", "0.01\n", "0.0099\n"}}) {
    const std::string before = b.before;
    EXPECT_NO_THROW(static_cast<void>(parse_hand(changed(before + b.usual, before + b.good), "good.toml")))
        << b.key << " = " << b.good;
    SCOPED_TRACE(b.bad);
    expect_hand_refused(changed(before + b.usual, before + b.bad), {std::string(b.key) + " = ", "must be"});
  }
}

TEST(HandFile, WithAnEmptyRangeOfMotion) {
  expect_hand_refused(changed("max_deg = 35.0", "max_deg = -18.0"),
                      {"thumb.joints.0.max_deg = -18", "> -18"});
}

TEST(HandFile, WithAnOpenAngleOutsideItsRange) {
  expect_hand_refused(changed("open_deg = 0.0", "open_deg = 36.0"),
                      {"thumb.joints.0.open_deg = 36", "<= 35"});
}

TEST(HandFile, WithTwoJointsSwapped) {
  expect_hand_refused(changed("thumb_cmc_flexion", "thumb_cmc_abduction"),
                      {"thumb.joints.0.name", "\"thumb_cmc_flexion\""});
}

TEST(HandFile, WithABackAlongTheFinger) {
  expect_hand_refused(changed("dorsal = [-0.852, 0.207, 0.481]", "dorsal = [-0.519, -0.462, -0.719]"),
                      {"thumb.dorsal", "parallel"});
}

TEST(HandFile, WithADirectionThatIsNone) {
  expect_hand_refused(changed("distal = [-0.519, -0.462, -0.719]", "distal = [0, 0, 0]"),
                      {"thumb.distal", "has no direction"});
}

TEST(HandFile, ThatIsMissing) {
  expect_scene_error([] { static_cast<void>(load_hand_file("adlt")); },
                     {"hand \"adlt\"", "did you mean \"adult\"?"});
  expect_scene_error([] { static_cast<void>(load_hand_file("none.toml", "/nowhere")); },
                     {"/nowhere/none.toml", "there is no file"});
}

TEST(HandFileCoupling, ReadsThePronationOfADigitAndItsMetacarpal) {
  const HandParameters hand = parse_hand(
      changed(
          "[ring]\n",
          "[ring]\nmetacarpal = { per_flexion = 0.1, base_mm = [8.09, -6.06, -27.0], axis = [-2, 0, 0] }\n"
          "pronation = { per_flexion = -0.2, per_abduction = 0.3 }\n"),
      "hand.toml");
  const DigitParameters& ring = hand.digits[static_cast<std::size_t>(Digit::kRing)];
  EXPECT_EQ(ring.coupling, (DigitCoupling{-0.2, 0.3, 0.1}));
  EXPECT_LT((ring.metacarpal_base - Vec3(8.09e-3, -6.06e-3, -27e-3)).norm(), 1e-15);
  EXPECT_EQ(ring.metacarpal_axis, Vec3(-1.0, 0.0, 0.0)) << "made a unit vector";
  EXPECT_EQ(hand.digits[0].coupling, DigitCoupling{}) << "the other digits have none";
  const HandParameters thumb =
      parse_hand(changed("[thumb]\n", "[thumb]\npronation = { per_flexion = 0.25 }\n"), "hand.toml");
  EXPECT_EQ(thumb.digits[0].coupling, (DigitCoupling{0.25, 0.0, 0.0})) << "abduction may be left out";
}

TEST(HandFileCoupling, IsRefusedByItsPlace) {
  const auto refuse = [](const std::string& line, const std::vector<std::string>& words) {
    SCOPED_TRACE(line);
    expect_hand_refused(changed("[thumb]\n", "[thumb]\n" + line + "\n"), words);
  };
  refuse("pronation = 0.2", {"bad.toml:", "thumb.pronation"});
  refuse("pronation = { per_abduction = 0.1 }", {"thumb.pronation.per_flexion"});
  refuse("pronation = { per_flexion = 23 }", {"thumb.pronation.per_flexion", "23", "1"});
  refuse("pronation = { per_flexion = nan }", {"thumb.pronation.per_flexion"});
  refuse("pronation = { per_flexion = 0.2, per_flex = 1 }", {"thumb.pronation.per_flex"});
  refuse("metacarpal = { per_flexion = 0.2, base_mm = [0, 0, 0] }", {"thumb.metacarpal.axis"});
  refuse("metacarpal = { per_flexion = 0.2, axis = [1, 0, 0] }", {"thumb.metacarpal.base_mm"});
  refuse("metacarpal = { per_flexion = 0.2, base_mm = [0, 0, 0], axis = [0, 0, 0] }",
         {"thumb.metacarpal.axis", "direction"});
}

}  // namespace
}  // namespace phalanx
