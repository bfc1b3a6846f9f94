// SPDX-License-Identifier: Apache-2.0
// The HTML report: each number is that of the registry, and nothing of it is loaded from elsewhere.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "phalanx/report/report.h"
#include "report/date_axis.h"
#include "report/kept_registry.h"
#include "report/xml_elements.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using testing::generated_patient;
using testing::GeneratedPatient;
using ::testing::HasSubstr;
using testing::KeptRegistry;
using ::testing::Not;
using testing::XmlElement;

constexpr std::uint64_t kHtmlSeed = 20261129;

/// A report and what it was made from.
class ReportHtml : public ::testing::Test {
 protected:
  ReportHtml() { RecordProperty("seed", static_cast<int>(kHtmlSeed)); }

  static std::string key(const std::string& score, double date, const std::string& recording,
                         const std::string& value, const std::string& unit) {
    return fmt::format("{}|{}|{}|{}|{}", score, date, recording, value, unit);
  }
  static std::vector<XmlElement> with(const std::vector<XmlElement>& all, const char* attribute) {
    std::vector<XmlElement> found;
    for (const XmlElement& each : all)
      if (each.has(attribute)) found.push_back(each);
    return found;
  }

  static const GeneratedPatient& made() {
    static const GeneratedPatient made = generated_patient(40, kHtmlSeed);
    return made;
  }
  const GeneratedPatient& made_ = made();
  static const ReportInput& kept() {
    static const ReportInput input = testing::read_back(made());
    return input;
  }
  ReportInput input_ = kept();
};

TEST_F(ReportHtml, HasEachValueOfEachTrendOnceWithAllItsDigits) {
  std::map<std::string, int> expected;
  std::size_t points = 0;
  for (const Trend& trend : input_.trends)
    for (const TrendPoint& point : trend.points) {
      if (!trend.origin && trend.points.size() < 2) continue;
      ++expected[key(trend.name, point.date, point.recording, fmt::format("{}", point.value), trend.unit)];
      ++points;
    }
  ASSERT_GT(points, 100U);
  for (const XmlElement& each :
       with(testing::xml_elements(report_html(input_, ReportLanguage::kEnglish)), "data-unit")) {
    if (!each.has("data-score")) continue;
    const auto found =
        expected.find(key(each.at("data-score"), std::stod(each.at("data-date")), each.at("data-recording"),
                          each.at("data-value"), each.at("data-unit")));
    ASSERT_NE(found, expected.end()) << each.at("data-score") << " " << each.at("data-value")
                                     << " is not in the registry";
    --found->second;
  }
  for (const auto& [name, left] : expected) EXPECT_EQ(left, 0) << name;
}

TEST_F(ReportHtml, HasSuccessAndDifficultyOfEachTraining) {
  const auto elements = testing::xml_elements(report_html(input_, ReportLanguage::kGerman));
  std::size_t found = 0;
  std::size_t rows = 0;
  int fewer = 0;
  for (const ResultRow& row : made_.results) {
    if (row.assessment || !row.valid) continue;
    ++rows;
    for (const XmlElement& each : elements) {
      if (!each.has("data-recording") || each.at("data-recording") != row.recording) continue;
      EXPECT_EQ(std::stod(each.at("data-date")), row.date);
      if (each.at("data-score") == row.exercise + "/difficulty") {
        ++found;
        EXPECT_EQ(each.at("data-value"), fmt::format("{}", row.difficulty));
      } else {
        ASSERT_EQ(each.at("data-score"), row.exercise + "/successes");
        ++found;
        EXPECT_EQ(each.at("data-value"), fmt::format("{}", row.successes));
        EXPECT_EQ(each.at("data-trials"), fmt::format("{}", made_.details.at(row.recording).counted));
        fewer += made_.details.at(row.recording).counted < row.repetitions ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(found, 2 * rows);
  EXPECT_GT(fewer, 10) << "the share is over the trials that were scored, not all that were carried out";
}

TEST_F(ReportHtml, HasTheSumsOfEachDayAndOfAll) {
  std::map<std::string, double> expected;  // "exercise|day" -> seconds; "pain|day" and its like
  std::map<std::string, int> counted;      // by day
  double whole = 0.0;
  int trials = 0;
  for (const ResultRow& row : made_.results) {
    const std::string day = report::iso_day(row.date);
    expected[row.exercise + "|" + day] += row.seconds;
    expected["all|" + day] += row.seconds;
    whole += row.seconds;
    trials += row.repetitions;
    expected["trials|" + day] += row.repetitions;
    const testing::GeneratedDetail& detail = made_.details.at(row.recording);
    if (!row.assessment && row.valid) {
      expected["successes|" + day] += row.successes;
      counted[day] += detail.counted;
    }
    for (const auto& [name, rating] :
         {std::pair{"pain|", detail.pain}, std::pair{"fatigue|", detail.fatigue}}) {
      if (rating < 0) continue;
      double& most = expected[name + day];
      most = std::max(most, static_cast<double>(rating));
    }
  }
  const auto elements = testing::xml_elements(report_html(input_, ReportLanguage::kEnglish));
  const auto days = with(elements, "data-day-of");
  EXPECT_EQ(days.size(), expected.size());
  for (const XmlElement& each : days) {
    const std::string day = report::iso_day(std::stod(each.at("data-date")));
    EXPECT_EQ(std::stod(each.at("data-value")), expected.at(each.at("data-day-of") + "|" + day));
    if (each.at("data-day-of") == "successes") {
      EXPECT_EQ(each.at("data-trials"), fmt::format("{}", counted.at(day)));
    }
  }
  std::map<std::string, double> sums;
  for (const XmlElement& each : with(elements, "data-sum"))
    sums[each.at("data-sum")] = std::stod(each.at("data-value"));
  EXPECT_EQ(sums.at("days"), 40.0);
  EXPECT_EQ(sums.at("exercises"), static_cast<double>(made_.results.size()));
  EXPECT_EQ(sums.at("seconds"), whole);
  EXPECT_EQ(sums.at("trials"), trials);
  double bars = 0.0;
  for (const XmlElement& each : elements)
    if (each.has("data-score") && each.at("data-score") == "dose/seconds")
      bars += std::stod(each.at("data-value"));
  EXPECT_NEAR(bars, whole, 1e-6 * whole);
}

TEST_F(ReportHtml, ShowsWhatItsAttributesStateToFourDigits) {
  const std::string html = report_html(input_, ReportLanguage::kEnglish);
  static const std::regex cell(
      R"re(<td class="n" data-(?:score|test)="[^>]*data-value="([^"]+)" data-unit[^>]*>(\u2212?)([0-9.]+))re");
  int cells = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), cell), end; it != end; ++it, ++cells) {
    const double exact = std::stod((*it)[1]);
    const double shown = std::stod((*it)[3]) * ((*it)[2].length() > 0 ? -1.0 : 1.0);
    EXPECT_NEAR(shown, exact, 5.1e-4 * std::abs(exact)) << (*it)[0];
  }
  EXPECT_GE(cells, static_cast<int>(made_.tests.size()));
}

TEST_F(ReportHtml, HasAllScoresOfASessionWithTheValueBefore) {
  const ResultRow& row = made_.results.at(made_.results.size() / 2);
  input_.day = report::iso_day(row.date);
  const auto elements = testing::xml_elements(report_html(input_, ReportLanguage::kEnglish));
  std::map<std::string, std::string> shown;
  for (const XmlElement& each : with(elements, "data-recording"))
    shown[each.at("data-recording") + "|" + each.at("data-score")] = each.at("data-value");
  std::size_t expected = 0;
  for (const ResultRow& each : made_.results) {
    if (report::iso_day(each.date) != input_.day) continue;
    const auto field = [&](const std::string& name, const std::string& value) {
      ++expected;
      EXPECT_EQ(shown[each.recording + "|" + each.exercise + "/" + name], value) << name;
    };
    field("seconds", fmt::format("{}", each.seconds));
    field("repetitions", fmt::format("{}", each.repetitions));
    if (!each.assessment) field("successes", fmt::format("{}", each.successes));
    if (!each.assessment) field("difficulty", fmt::format("{}", each.difficulty));
    const testing::GeneratedDetail& detail = made_.details.at(each.recording);
    if (detail.pain >= 0) field("pain", fmt::format("{}", detail.pain));
    if (detail.fatigue >= 0) field("fatigue", fmt::format("{}", detail.fatigue));
    for (const Score& score : each.scores)
      if (score.valid()) field(score.name, fmt::format("{}", score.value));
  }
  EXPECT_GT(expected, 12U);
  EXPECT_EQ(shown.size(), expected) << "and nothing of another day";
}

TEST_F(ReportHtml, StatesInBothLanguagesWhatTheDeviceIsNot) {
  EXPECT_THAT(report_html(input_, ReportLanguage::kEnglish),
              AllOf(HasSubstr("no medical device"), HasSubstr("no benefit"), HasSubstr("does not assist"),
                    HasSubstr("lang=\"en\"")));
  EXPECT_THAT(report_html(input_, ReportLanguage::kGerman),
              AllOf(HasSubstr("kein Medizinprodukt"), HasSubstr("nicht erwiesen"),
                    HasSubstr("unterst\u00FCtzt sie nicht"), HasSubstr("lang=\"de\""),
                    HasSubstr("rechte Hand"), HasSubstr("Baum")));
}

TEST_F(ReportHtml, HasABandOnlyWhereADifferenceIsPublished) {
  const std::string html = report_html(input_, ReportLanguage::kEnglish);
  std::size_t bands = 0;
  for (std::size_t at = html.find("fill=\"#e2eef5\""); at != std::string::npos;
       at = html.find("fill=\"#e2eef5\"", at + 1))
    ++bands;
  std::size_t expected = 0;
  for (const Trend& trend : input_.trends)
    if (trend.smallest_real_difference && trend.points.size() > 1) ++expected;
  EXPECT_EQ(expected, 4U) << "two of box and block, grip, nine-hole peg";
  EXPECT_EQ(bands, expected);
  std::size_t words = 0;
  for (std::size_t at = html.find("Band: "); at != std::string::npos; at = html.find("Band: ", at + 1))
    ++words;
  EXPECT_EQ(words, expected) << "each band is explained";
  EXPECT_THAT(html, HasSubstr("change not proven: no smallest real difference is published"));
}

TEST_F(ReportHtml, IsWholeAndLoadsNothing) {
  for (const ReportLanguage language : {ReportLanguage::kEnglish, ReportLanguage::kGerman}) {
    const std::string html = report_html(input_, language);
    EXPECT_THAT(html, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("src=")), Not(HasSubstr("href=")),
                            Not(HasSubstr("url(")), Not(HasSubstr("@import")), Not(HasSubstr("\"nan\"")),
                            Not(HasSubstr("nan,"))));
    EXPECT_EQ(html, report_html(input_, language)) << "equal data, equal bytes";
  }
}

TEST_F(ReportHtml, HasThePatientsNumbersWithAllTheirDigits) {
  const Patient& patient = made_.patient;
  std::map<std::string, std::string> expected = {
      {"force_limit_n", fmt::format("{}", *patient.force_limit_n)},
      {"stiffness_limit_n_per_mm", fmt::format("{}", *patient.stiffness_limit_n_per_mm)},
      {"torque_limit_nm", fmt::format("{}", *patient.torque_limit_nm)},
      {"entry/flexion_deg", fmt::format("{}", patient.entry->flexion_deg)},
      {"entry/release_deg", fmt::format("{}", patient.entry->release_deg)},
      {"own_force_n/thumb", fmt::format("{}", patient.own_force_n[0])},
      {"own_force_n/index", fmt::format("{}", patient.own_force_n[1])},
      {"own_force_n/middle", fmt::format("{}", patient.own_force_n[2])},
      {"own_force_n/little", fmt::format("{}", patient.own_force_n[4])}};
  std::map<std::string, std::string> shown;
  for (const XmlElement& each :
       with(testing::xml_elements(report_html(input_, ReportLanguage::kGerman)), "data-field"))
    EXPECT_TRUE(shown.emplace(each.at("data-field"), each.at("data-value")).second);
  EXPECT_EQ(shown, expected);
}

TEST_F(ReportHtml, HasAProvenDeteriorationInABoxOfItsOwn) {
  EnteredTest first{.kind = TestKind::kBoxAndBlock,
                    .value = 40.0,
                    .side = TestSide::kMoreAffected,
                    .date = "2026-01-05",
                    .rater = "AB",
                    .note = {}};
  EnteredTest last = first;
  last.value = 20.0;
  last.date = "2026-03-05";
  input_.trends = make_trends({}, std::vector<EnteredTest>{first, last});
  std::string html = report_html(input_, ReportLanguage::kEnglish);
  EXPECT_THAT(html, AllOf(HasSubstr("class=\"note bad\""), HasSubstr("Proven deteriorations"),
                          Not(HasSubstr("class=\"note good\""))));
  std::swap(first.value, last.value);
  input_.trends = make_trends({}, std::vector<EnteredTest>{first, last});
  html = report_html(input_, ReportLanguage::kEnglish);
  EXPECT_THAT(html, AllOf(HasSubstr("class=\"note good\""), Not(HasSubstr("class=\"note bad\""))));
}

TEST_F(ReportHtml, OfOneDayDoesNotJudgeTrainingsAndNamesTheDayOfThePatientsFields) {
  ReportedExercise training{.name = "train_press", .title = "Press", .needs_attention = true};
  training.success = SuccessReport{.verdict = SuccessVerdict::kOutOfRange,
                                   .successes = 6,
                                   .counted = 30,
                                   .share = 0.2,
                                   .low = 0.08,
                                   .high = 0.39,
                                   .text = "out of range after 10 sessions"};
  training.sessions = 10;
  input_.exercises = {training};
  EXPECT_THAT(report_html(input_, ReportLanguage::kEnglish),
              HasSubstr("Press: out of range after 10 sessions"));
  const std::string german = report_html(input_, ReportLanguage::kGerman);
  EXPECT_THAT(german, AllOf(HasSubstr("au\u00DFerhalb des Bereichs nach 10 Sitzungen: Erfolg in 6 von 30"),
                            HasSubstr("unter 60 bis 80 %; Zufall"), Not(HasSubstr("out of range"))));
  input_.day = report::iso_day(made_.results.front().date);
  EXPECT_THAT(report_html(input_, ReportLanguage::kEnglish),
              AllOf(Not(HasSubstr("out of range")), HasSubstr("To note, as of 29 Nov"),
                    HasSubstr("Patient, as of 29 Nov")));
}

TEST_F(ReportHtml, StatesThatASimulatedParticipantDidTheExercises) {
  EXPECT_THAT(report_html(input_, ReportLanguage::kEnglish), HasSubstr("no person did these exercises"));
  input_.patient.code = "P07";
  for (ResultRow& row : input_.results) row.conditions.device = "beihang";
  EXPECT_THAT(report_html(input_, ReportLanguage::kEnglish), Not(HasSubstr("no person did")));
}

TEST_F(ReportHtml, HasADashForADayWithoutATraining) {
  ReportInput one;
  one.patient.code = "P01";
  one.results = {made_.results.front()};
  ASSERT_TRUE(one.results[0].assessment);
  const auto elements = testing::xml_elements(report_html(one, ReportLanguage::kEnglish));
  for (const XmlElement& each : with(elements, "data-day-of")) EXPECT_NE(each.at("data-day-of"), "successes");
  EXPECT_THAT(report_html(one, ReportLanguage::kEnglish), HasSubstr("<td class=\"n\">\u2013</td>"));
}

TEST_F(ReportHtml, EscapesAllTexts) {
  const std::string attack = "<script>alert('&\"')</script>";
  input_.patient.warnings = {attack};
  input_.patient.note = attack;
  input_.notes = {{.date = made_.results[0].date, .account = attack, .text = attack}};
  input_.exercises[0].title = attack;
  input_.results[0].recording = attack;
  input_.results[0].scores.push_back({.name = attack, .unit = attack, .invalid = attack});
  input_.results[0].conditions.device = attack;
  input_.results[0].detail = "{\"ended\": 7, \"trials\": [1, {\"invalid\": \"<b>\"}]}";
  input_.version = "\"; } body { display: none";
  for (const std::string& day : {std::string(), report::iso_day(made_.results[0].date)}) {
    input_.day = day;
    const std::string html = report_html(input_, ReportLanguage::kEnglish);
    EXPECT_THAT(html, AllOf(Not(HasSubstr("<script")), Not(HasSubstr("<b>\"")), HasSubstr("&lt;script&gt;")));
    EXPECT_FALSE(testing::xml_elements(html).empty()) << "well-formed";
  }
}

TEST_F(ReportHtml, OfAPatientWithoutAnythingIsShort) {
  ReportInput empty;
  empty.patient.code = "P01";
  empty.patient.symbol = "sun";
  const std::string html = report_html(empty, ReportLanguage::kEnglish);
  EXPECT_THAT(html, AllOf(HasSubstr("P01"), Not(HasSubstr("<svg"))));
  EXPECT_FALSE(testing::xml_elements(html).empty());
}

TEST_F(ReportHtml, RefusesADayOnWhichNothingWasDone) {
  for (const char* day : {"2025-01-01", "2026-13-01", "2026-1-5", "today", "2026-02-30"}) {
    input_.day = day;
    EXPECT_THROW(static_cast<void>(report_html(input_, ReportLanguage::kEnglish)), std::invalid_argument)
        << day;
    EXPECT_THROW(static_cast<void>(report_fhir(input_)), std::invalid_argument) << day;
  }
}

TEST_F(ReportHtml, NamesInterruptedAndInvalidExercisesAndScoresThatWereNotMeasured) {
  const std::string html = report_html(input_, ReportLanguage::kEnglish);
  EXPECT_THAT(html, AllOf(HasSubstr("a person has ended it"), HasSubstr("motor of the digit ring alone"),
                          HasSubstr("trials not scored: 1 (the device sent no sample"),
                          HasSubstr("goniometer + jig")));
}

}  // namespace
}  // namespace phalanx
