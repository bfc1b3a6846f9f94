// SPDX-License-Identifier: Apache-2.0
// The German report: reasons of results are translated, and no English word of the program is left.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "phalanx/exercise/reasons.h"
#include "phalanx/report/report.h"
#include "report/date_axis.h"
#include "report/kept_registry.h"
#include "report/report_words.h"
#include "report/score_names.h"
#include "report/xml_elements.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint64_t kGermanSeed = 20261201;

/// @returns the English text of a reason with numbers and a digit at its placeholders
std::string sample_of(const ReasonWords& reason) {
  std::string text;
  for (std::size_t i = 0; i < reason.english.size(); ++i) {
    if (reason.english[i] != '{') {
      text.push_back(reason.english[i]);
      continue;
    }
    const std::size_t close = reason.english.find('}', i);
    const std::string_view spec = reason.english.substr(i + 1, close - i - 1);
    text.append(spec.empty() ? "ring" : spec == ":d" ? "3" : "1.25");
    i = close;
  }
  return text;
}

/// @returns words and numbers of a text, in lower case, with one blank before each and one at the end
std::string words_of_text(const std::string& text) {
  std::string out = " ";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool part = byte >= 0x80 || std::isalnum(byte) != 0 || c == '_';
    if (part) out.push_back(static_cast<char>(std::tolower(byte)));
    if (!part && out.back() != ' ') out.push_back(' ');
  }
  if (out.back() != ' ') out.push_back(' ');
  return out;
}

/// @returns the words between the placeholders of a format
std::vector<std::string> pieces_of(std::string_view format) {
  std::vector<std::string> pieces;
  while (true) {
    const std::size_t open = format.find('{');
    if (std::string words = words_of_text(std::string(format.substr(0, open))); words != " ")
      pieces.push_back(std::move(words));
    if (open == std::string_view::npos) return pieces;
    format.remove_prefix(format.find('}', open) + 1);
  }
}

std::vector<const char*> table_of(ReportLanguage language) {
  const auto all = std::bit_cast<std::array<const char*, sizeof(report::Words) / sizeof(const char*)>>(
      report::words_of(language));
  return {all.begin(), all.end()};
}

TEST(GermanReasons, EachReasonIsFoundByItsEnglishTextAndHasAGermanOne) {
  std::set<std::string_view> codes;
  for (const ReasonWords& each : kReasons) {
    const std::string english = sample_of(each);
    SCOPED_TRACE(english);
    ASSERT_TRUE(find_reason(english).has_value());
    EXPECT_EQ(reason_code(*find_reason(english)), each.code);
    EXPECT_TRUE(codes.insert(each.code).second) << "two reasons have this code";
    const std::string german = report::reason_label(english, ReportLanguage::kGerman);
    EXPECT_THAT(german, Not(HasSubstr("{")));
    EXPECT_THAT(german, Not(HasSubstr("im Wortlaut")));
    EXPECT_THAT(german, Not(HasSubstr("ring "))) << "the digit has a German name";
    EXPECT_THAT(german, Not(HasSubstr("1.25"))) << "numbers have a decimal comma";
    for (const std::string& piece : pieces_of(each.english))
      if (std::count(piece.begin(), piece.end(), ' ') > 2) {
        EXPECT_THAT(words_of_text(german), Not(HasSubstr(piece)));
      }
    EXPECT_EQ(report::reason_label(english, ReportLanguage::kEnglish), english);
  }
}

TEST(GermanReasons, HaveTheirNumbersDigitsAndReasonsWithin) {
  const auto german = [](const std::string& english) {
    return report::reason_label(english, ReportLanguage::kGerman);
  };
  EXPECT_EQ(german(reason_text<Reason::kStepFaultAt>(reason_text<Reason::kNoSample>(), 2.5)),
            "nicht gewertet: Das Ger\u00E4t hat keinen Messwert gesendet (bei 2,500 s); bitte den Versuch "
            "wiederholen");
  EXPECT_EQ(german(reason_text<Reason::kAngleNotMeasured>("index_pip_flexion", "completed")),
            "nicht gemessen: Der Winkel ist erg\u00E4nzt (Zeigefinger PIP, Beugung)");
  EXPECT_EQ(german(reason_text<Reason::kNotCounted>(reason_text<Reason::kPressTooShort>(3, 20))),
            "nicht gewertet: Das Dr\u00FCcken z\u00E4hlt nicht: 3 Werte der gesendeten Steifigkeit statt 20; "
            "bitte l\u00E4nger dr\u00FCcken");
  EXPECT_EQ(german(reason_text<Reason::kAllTrialsDone>() + "; " + reason_text<Reason::kPainLimit>(6, 5)),
            "Alle Versuche sind gemacht; Schmerz 6 von 10 hat die Grenze 5 erreicht");
  EXPECT_EQ(german(reason_text<Reason::kNotProven>(
                reason_text<Reason::kOtherResultVersion>("0.1.0", 17, "a; b", "c\" and \"d"))),
            "nicht belegt: mit einer anderen Version aufgezeichnet (0.1.0); erster Unterschied bei Byte 17");
  EXPECT_EQ(german("a text of an older program"), "im Wortlaut: \u201Ea text of an older program\u201C");
}

/// A patient whose report has every chapter, with German texts where people enter them.
class GermanReport : public ::testing::Test {
 protected:
  GermanReport() : input_(testing::read_back(testing::generated_patient(40, kGermanSeed))) {
    RecordProperty("seed", static_cast<int>(kGermanSeed));
    Patient& patient = input_.patient;
    patient.warnings = {"kalte Finger"};
    patient.contraindications = {"frische Naht"};
    patient.note = "links dominant";
    patient.consent = false;
    patient.entry->suitable = false;
    patient.calibration_expires = "2026-06-01";
    for (const char* key : {"trials", "target_success", "difficulty", "pain_limit", "fatigue_limit",
                            "most_repetitions", "most_minutes"})
      patient.prescription[0].overrides[key] = "0.5";
    for (PatientNote& note : input_.notes) note = {.date = note.date, .account = "AB", .text = "Hand warm"};
    for (EnteredTest& test : input_.tests) test.note = "sitzend";
    ResultRow& row = input_.results.front();  // of every reason one score
    for (const ReasonWords& each : kReasons)
      row.scores.push_back(
          {.name = fmt::format("tam_{}_deg", digit_name(static_cast<int>(each.code.size()) % 5)),
           .unit = "deg",
           .invalid = sample_of(each)});
    input_.results[1].interrupted = true;
    input_.results[2].valid = false;
    input_.results[2].invalid = reason_text<Reason::kRecordingEndsBefore>();
    for (std::size_t i = 0; i < input_.trends.size(); ++i)
      if (!input_.trends[i].origin && input_.trends[i].points.size() > 1) {
        input_.trends[i].proven = true;
        if (i % 2 == 0) std::reverse(input_.trends[i].points.begin(), input_.trends[i].points.end());
      }
  }
  ReportInput input_;
};

TEST_F(GermanReport, HasNoStringOfTheEnglishTable) {
  std::set<std::string> german;
  for (const char* text : table_of(ReportLanguage::kGerman))
    for (const std::string& piece : pieces_of(text)) german.insert(piece);
  std::set<std::string> english;
  const auto is_german = [&](const std::string& piece) {  // "patient" is a word of both languages
    return std::ranges::any_of(
        german, [&](const std::string& each) { return each.find(piece) != std::string::npos; });
  };
  for (const char* text : table_of(ReportLanguage::kEnglish))
    for (const std::string& piece : pieces_of(text))
      if (!is_german(piece)) english.insert(piece);
  for (const ReasonWords& each : kReasons)
    for (const std::string& piece : pieces_of(each.english))
      if (std::count(piece.begin(), piece.end(), ' ') > 2) english.insert(piece);
  for (const ResultRow& row : input_.results)
    for (const Score& score : row.scores)
      english.insert(words_of_text(report::score_label(score.name, ReportLanguage::kEnglish)));
  for (const ReportedExercise& exercise : input_.exercises) english.insert(words_of_text(exercise.title));
  for (const char* word :
       {"the", "of", "and", "is", "are", "were", "not", "with", "by", "for", "than", "trial", "steps",
        "force", "device", "finger's", "simulated", "participant", "person's"})
    english.insert(words_of_text(word));
  ASSERT_GT(english.size(), 200U);
  for (const std::string& day : {std::string(), report::iso_day(input_.results.front().date)}) {
    input_.day = day;
    const std::string html = report_html(input_, ReportLanguage::kGerman);
    EXPECT_THAT(html, HasSubstr("St\u00F6rungen und Abbr\u00FCche"));
    EXPECT_THAT(html, HasSubstr("Nicht gemessen"));
    std::size_t nodes = 0;
    for (const std::string& text : testing::xml_texts(html)) {
      ++nodes;
      static const std::regex names(
          R"(Neurorehabilitation and Neural Repair|Box-and-Block|contact\.mode = "sliding")");
      const std::string words = words_of_text(std::regex_replace(text, names, ""));
      for (const std::string& piece : english)
        EXPECT_EQ(words.find(piece), std::string::npos) << "\"" << piece << "\" in \"" << text << "\"";
    }
    EXPECT_GT(nodes, 100U);
  }
}

TEST_F(GermanReport, HasTheChaptersOfTheEnglishOne) {
  const auto count = [&](ReportLanguage language, const char* name) {
    const auto all = testing::xml_elements(report_html(input_, language));
    return std::count_if(all.begin(), all.end(),
                         [&](const testing::XmlElement& each) { return each.name == name; });
  };
  for (const char* name : {"h2", "h3", "h4", "td", "li", "dt", "svg"})
    EXPECT_EQ(count(ReportLanguage::kGerman, name), count(ReportLanguage::kEnglish, name)) << name;
  EXPECT_GE(count(ReportLanguage::kGerman, "h2"), 10) << "every chapter";
}

}  // namespace
}  // namespace phalanx
