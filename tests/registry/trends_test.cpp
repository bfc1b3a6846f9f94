// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/trends.h"

#include <gmock/gmock.h>

#include "registry/registry_files.h"

namespace phalanx {
namespace {

using testing::example_result;
using ::testing::HasSubstr;
using ::testing::StartsWith;

EnteredTest entered(TestKind kind, double value, const char* date, TestSide side = TestSide::kMoreAffected) {
  return {.kind = kind, .value = value, .side = side, .date = date, .rater = "LW", .note = {}};
}

std::vector<Trend> of_tests(const std::vector<EnteredTest>& tests) { return make_trends({}, tests); }

ResultRow later(double value) {
  ResultRow out = example_result("later.mcap", 1, value);
  out.date += 86400.0;
  return out;
}

TEST(Trends, ProveAChangeByThePublishedDifferenceAlone) {
  const auto verdict = [](TestKind kind, double from, double to, TestSide side) {
    return of_tests({entered(kind, to, "2026-06-01", side), entered(kind, from, "2026-05-04", side)}).at(0);
  };
  const Trend better = verdict(TestKind::kBoxAndBlock, 20.0, 25.5, TestSide::kMoreAffected);
  EXPECT_TRUE(better.proven);
  EXPECT_EQ(better.verdict,
            "improved: +5.5 blocks/min from 2026-05-04 to 2026-06-01; smallest real difference 5.5 "
            "blocks/min, Chen "
            "et al. 2009");
  const Trend same = verdict(TestKind::kBoxAndBlock, 20.0, 25.5, TestSide::kLessAffected);
  EXPECT_FALSE(same.proven);
  EXPECT_THAT(same.verdict, StartsWith("change not proven: +5.5 blocks/min"));
  EXPECT_THAT(same.verdict, HasSubstr("7.8"));
}

TEST(Trends, KnowEachDifferenceOfChenAndOthers) {
  struct Case {
    TestKind kind;
    TestSide side;
    double difference;
  };
  for (const Case& each : {Case{TestKind::kGrip, TestSide::kMoreAffected, 2.9},
                           Case{TestKind::kGrip, TestSide::kLessAffected, 4.7},
                           Case{TestKind::kBoxAndBlock, TestSide::kMoreAffected, 5.5},
                           Case{TestKind::kBoxAndBlock, TestSide::kLessAffected, 7.8},
                           Case{TestKind::kNineHolePeg, TestSide::kMoreAffected, 32.8},
                           Case{TestKind::kNineHolePeg, TestSide::kLessAffected, 6.2}}) {
    const auto proven = [&](double change) {
      const Trend trend = of_tests({entered(each.kind, 50.0, "2026-05-04", each.side),
                                    entered(each.kind, 50.0 + change, "2026-05-05", each.side)})
                              .at(0);
      EXPECT_EQ(trend.smallest_real_difference, each.difference);
      return trend.proven;
    };
    EXPECT_TRUE(proven(each.difference)) << each.difference;
    EXPECT_TRUE(proven(-each.difference)) << each.difference;
    EXPECT_FALSE(proven(each.difference - 0.01)) << each.difference;
  }
}

TEST(Trends, CallAQuickerPegTestBetter) {
  EXPECT_THAT(of_tests({entered(TestKind::kNineHolePeg, 90, "2026-05-04"),
                        entered(TestKind::kNineHolePeg, 50, "2026-06-04")})
                  .at(0)
                  .verdict,
              StartsWith("improved: -40 s"));
  EXPECT_THAT(of_tests({entered(TestKind::kGrip, 9, "2026-05-04"), entered(TestKind::kGrip, 5, "2026-06-04")})
                  .at(0)
                  .verdict,
              StartsWith("worse: -4 kg"));
}

TEST(Trends, SayThatAChangeWithoutAPublishedDifferenceIsNotProven) {
  const std::vector<ResultRow> rows = {example_result("a.mcap", 1, 2.0), later(9.0)};
  const std::vector<Trend> trends =
      make_trends(rows, std::vector<EnteredTest>{entered(TestKind::kAshworth, 3, "2026-05-04"),
                                                 entered(TestKind::kAshworth, 0, "2026-06-04")});
  ASSERT_EQ(trends.size(), 2U);
  EXPECT_EQ(trends[0].name, "ashworth/more_affected");
  EXPECT_THAT(trends[0].verdict, StartsWith("change not proven: -3 points"));
  EXPECT_EQ(trends[1].name, "press_and_hold/mean_n");
  EXPECT_THAT(trends[1].verdict, StartsWith("change not proven: +7 N from 2026-05-04 to 2026-05-05"));
  EXPECT_FALSE(trends[1].smallest_real_difference.has_value());
}

TEST(Trends, JoinOnlyEqualConditions) {
  for (int condition = 0; condition < 7; ++condition) {
    std::vector<ResultRow> rows = {example_result("a.mcap", 1, 2.0), later(9.0)};
    ResultConditions& changed = rows[1].conditions;
    std::string* const fields[] = {&changed.device,       &changed.serial,     &changed.calibration_method,
                                   &changed.contact_mode, &changed.stabiliser, &changed.rendering,
                                   &changed.protocol};
    *fields[condition] += "x";
    const std::vector<Trend> trends = make_trends(rows, {});
    ASSERT_EQ(trends.size(), 2U) << condition;
    EXPECT_EQ(trends[0].points.size(), 1U);
    EXPECT_THAT(trends[1].verdict, HasSubstr("not joined with the earlier values")) << condition;
  }
}

TEST(Trends, WithoutARecordedProtocolJoinOnlyOneAnother) {
  std::vector<ResultRow> rows = {example_result("a.mcap", 1, 2.0), later(9.0)};
  for (ResultRow& row : rows) row.conditions.protocol.clear();
  EXPECT_EQ(make_trends(rows, {}).at(0).points.size(), 2U);
  rows[1].conditions.protocol = "0123456789abcdef";
  const std::vector<Trend> trends = make_trends(rows, {});
  ASSERT_EQ(trends.size(), 2U);
  EXPECT_THAT(trends[1].verdict, HasSubstr("another assessment's protocol"));
}

TEST(Trends, LeaveOutWhatIsNoAssessmentOrNotValid) {
  const auto without = [](const std::function<void(ResultRow&)>& change) {
    ResultRow row = later(9.0);
    change(row);
    return make_trends(std::vector<ResultRow>{example_result("a.mcap", 1, 2.0), row}, {})
               .at(0)
               .points.size() == 1;
  };
  EXPECT_FALSE(without([](ResultRow&) {}));
  EXPECT_TRUE(without([](ResultRow& row) { row.assessment = false; }));
  EXPECT_TRUE(without([](ResultRow& row) { row.valid = false; }));
  EXPECT_TRUE(without([](ResultRow& row) { row.interrupted = true; }));
  EXPECT_TRUE(without([](ResultRow& row) { row.scores[0].invalid = "slip"; }));
  EXPECT_TRUE(without([](ResultRow& row) { row.scores[0].unit = "kg"; }));
  EXPECT_TRUE(without([](ResultRow& row) { row.scores[0].origin = ScoreOrigin::kMeasured; }));
  EXPECT_TRUE(make_trends({}, {}).empty());
}

}  // namespace
}  // namespace phalanx
