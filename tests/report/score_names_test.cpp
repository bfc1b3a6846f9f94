// SPDX-License-Identifier: Apache-2.0
// Names of scores, exercises and numbers for people.
#include "report/score_names.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/exercise/discrimination.h"
#include "phalanx/exercise/force_scores.h"
#include "phalanx/exercise/identification.h"
#include "phalanx/exercise/motion_scores.h"
#include "phalanx/exercise/smoothness.h"
#include "phalanx/hand/joints.h"
#include "report/report_words.h"

namespace phalanx::report {
namespace {

constexpr ReportLanguage kEn = ReportLanguage::kEnglish;
constexpr ReportLanguage kDe = ReportLanguage::kGerman;

TEST(ScoreNames, AreWordsInBothLanguages) {
  EXPECT_EQ(score_label("mean_force_n", kEn), "Mean force");
  EXPECT_EQ(score_label("mean_force_n", kDe), "Mittlere Kraft");
  EXPECT_EQ(score_label("index_peak_force_n", kEn), "Index finger: largest force");
  EXPECT_EQ(score_label("rom_index_pip_flexion_deg", kEn), "Index finger PIP, flexion: range of motion");
  EXPECT_EQ(score_label("min_thumb_cmc_abduction_deg", kDe), "Daumen CMC, Abspreizung: kleinster Winkel");
  EXPECT_EQ(score_label("tam_ring_deg", kEn), "Ring finger: total active motion");
  EXPECT_EQ(score_label("opposition_little_mm", kDe), "Abstand Daumen \u2013 Kleinfinger");
  EXPECT_EQ(score_label("opposition_held_ring_mm", kEn),
            "Distance of the thumb to the ring finger, held for 1 s");
  EXPECT_EQ(score_label("opposition_held_ring_mm", kDe),
            "Abstand Daumen \u2013 Ringfinger, 1 s lang gehalten");
  EXPECT_EQ(score_label("index_enslaving_middle", kEn), "Index finger: middle finger: moves along");
  EXPECT_EQ(score_label("an_unknown_score", kDe), "An unknown score");
  EXPECT_EQ(score_label("rom_nose_deg", kEn), "Rom nose deg");
  EXPECT_EQ(score_label("", kEn), "");
}

/// @returns each name that a function of scores produces
std::set<std::string> produced_names() {
  std::set<std::string> names;
  const auto add = [&](const std::vector<Score>& scores, const std::string& prefix = "") {
    for (const Score& score : scores) names.insert(prefix + score.name);
  };
  const DigitFlags index = {false, true, false, false, false};
  const DigitFlags all = {true, true, true, true, true};
  SqueezeAndRelease squeeze{.digits = index};
  squeeze.release_cue = 1.0;
  add(press_and_hold_scores({}, {.digits = index, .target = 1.0}, all));
  add(force_tracking_scores({}, {}, {.digits = index}, all));
  add(squeeze_and_release_scores({}, squeeze, all));
  add(pinch_scores({}, {}, all));
  add(range_of_motion_scores({}, {}));
  add(total_active_motion_scores({}, {.digits = all}));
  add(opposition_scores({}, {}));
  add(smoothness_scores({}, {}));
  add(threshold_scores({}));
  add(identification_scores({}));
  for (int digit = 0; digit < kDigits; ++digit) {  // of each digit by itself: own force, independence
    const std::string name(digit_name(digit));
    add(squeeze_and_release_scores({}, squeeze, all), name + "_");
    add(motion_independence_scores({}, {.instructed = digit, .digits = all}), name + "_");
    names.insert("entry_flexion_" + name + "_deg");
    names.insert("entry_release_" + name + "_deg");
  }
  return names;
}

TEST(ScoreNames, CoverEachNameThatScoresHave) {
  const std::set<std::string> names = produced_names();
  EXPECT_GT(names.size(), 100U);
  EXPECT_TRUE(names.contains("opposition_held_index_mm"));
  for (const std::string& name : names) {
    std::string fallback = name;
    std::replace(fallback.begin(), fallback.end(), '_', ' ');
    std::string german = score_label(name, kDe);
    german[0] = name[0];
    EXPECT_NE(german, fallback) << name;
    EXPECT_NE(score_label(name, kDe), score_label(name, kEn)) << name;
  }
}

TEST(ScoreNames, CoverEachJointAndDigitOfTheHand) {
  for (int joint = 0; joint < kJoints; ++joint) {
    const std::string name = "max_" + std::string(joint_name(joint)) + "_deg";
    EXPECT_EQ(score_label(name, kEn).find('_'), std::string::npos) << name;
    EXPECT_NE(score_label(name, kEn), score_label(name, kDe)) << name;
  }
  for (const std::string_view symbol : patient_symbols()) EXPECT_NE(symbol_label(symbol, kDe), symbol);
  for (const TestKindInfo& kind : test_kinds()) EXPECT_NE(test_label(kind.kind, kDe), kind.title);
}

TEST(ReportNumbers, HaveFourDigitsAndTheLanguagesComma) {
  EXPECT_EQ(number_label(12.3456, kEn), "12.35");
  EXPECT_EQ(number_label(12.3456, kDe), "12,35");
  EXPECT_EQ(number_label(-0.5, kEn), "\u22120.5");
  EXPECT_EQ(number_label(123456.0, kEn), "123456");
  EXPECT_EQ(value_label(40.0, "deg", kEn), "40\u00B0");
  EXPECT_EQ(value_label(0.25, "-", kDe), "0,25");
  EXPECT_EQ(value_label(2.5, "N", kEn), "2.5\u202FN");
  EXPECT_EQ(minutes_label(330.0, kDe), "5,5");
  EXPECT_EQ(minutes_label(1230.0, kEn), "20");
  EXPECT_EQ(change_label(2.0, "N", kEn), "+2\u202FN");
  EXPECT_EQ(exact_text(0.1 + 0.2), "0.30000000000000004");
}

TEST(ReportLanguages, AreEnglishAndGermanOnly) {
  EXPECT_EQ(report_language("de"), kDe);
  EXPECT_THROW(static_cast<void>(report_language("fr")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(report_language("")), std::invalid_argument);
}

}  // namespace
}  // namespace phalanx::report
