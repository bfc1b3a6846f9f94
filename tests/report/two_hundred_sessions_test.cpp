// SPDX-License-Identifier: Apache-2.0
// A registry with 200 sessions: list, course and report have the right counts.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "phalanx/report/report.h"
#include "report/kept_registry.h"
#include "report/xml_elements.h"

namespace phalanx {
namespace {

constexpr int kManySessions = 200;
constexpr std::uint64_t kManySeed = 20261130;

TEST(ReportOfTwoHundredSessions, HasEveryResultOfTheRegistry) {
  RecordProperty("seed", static_cast<int>(kManySeed));
  const testing::GeneratedPatient made = testing::generated_patient(kManySessions, kManySeed);
  testing::KeptRegistry kept(made);
  const auto patients = kept.registry().patients(Actor::owner());
  ASSERT_EQ(patients.size(), 1U);
  EXPECT_EQ(patients[0].code, made.patient.code);
  EXPECT_EQ(kept.registry().results(Actor::owner(), kept.record()).size(), made.results.size());

  const ReportInput input = kept.input();
  const auto trainings = std::count_if(made.results.begin(), made.results.end(),
                                       [](const ResultRow& row) { return !row.assessment; });
  EXPECT_EQ(trainings, 3 * kManySessions);
  EXPECT_EQ(std::count_if(input.results.begin(), input.results.end(),
                          [](const ResultRow& row) { return !row.assessment; }),
            trainings);
  EXPECT_EQ(input.tests.size(), made.tests.size());
  std::size_t points = 0;
  for (const Trend& trend : input.trends) points += trend.points.size();
  std::size_t expected = made.tests.size();
  for (const ResultRow& row : made.results)
    if (row.assessment && row.valid && !row.interrupted)
      expected += static_cast<std::size_t>(std::count_if(row.scores.begin(), row.scores.end(),
                                                         [](const Score& score) { return score.valid(); }));
  EXPECT_EQ(points, expected);

  std::map<std::string, std::string> sums;
  for (const testing::XmlElement& each : testing::xml_elements(report_html(input, ReportLanguage::kGerman)))
    if (each.has("data-sum")) sums[each.at("data-sum")] = each.at("data-value");
  EXPECT_EQ(sums["days"], std::to_string(kManySessions));
  EXPECT_EQ(sums["exercises"], std::to_string(made.results.size()));

  std::size_t scores = 0;
  std::size_t faults = 0;
  for (const ResultRow& row : made.results) {
    scores += row.scores.size();
    faults += row.valid ? 0U : 1U;
    faults += row.interrupted ? 1U : 0U;
    faults += made.details.at(row.recording).unscored > 0 ? 1U : 0U;
  }
  const auto bundle = nlohmann::json::parse(report_fhir(input));
  EXPECT_EQ(bundle["entry"].size(), 1 + made.results.size() + scores + faults + made.tests.size())
      << "and one device";
}

}  // namespace
}  // namespace phalanx
