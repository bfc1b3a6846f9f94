// SPDX-License-Identifier: Apache-2.0
// Dates of the charts' axes and sums by day and week.
#include "report/date_axis.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "report/dose.h"

namespace phalanx::report {
namespace {

using ::testing::ElementsAre;
using ::testing::Le;

constexpr double kMonday = 1'777'852'800.0;  // 2026-05-04, 00:00 UTC

std::vector<std::string> labels(double days, int most, ReportLanguage language) {
  std::vector<std::string> all;
  for (const DateTick& tick : date_ticks(kMonday, kMonday + days * kDay, most, language))
    all.push_back(tick.label);
  return all;
}

TEST(DateAxis, HasDaysThenMondaysThenMonths) {
  EXPECT_THAT(labels(3, 4, ReportLanguage::kEnglish), ElementsAre("4 May", "5 May", "6 May", "7 May"));
  EXPECT_THAT(labels(20, 4, ReportLanguage::kGerman), ElementsAre("4. Mai", "11. Mai", "18. Mai"));
  EXPECT_THAT(labels(100, 4, ReportLanguage::kEnglish), ElementsAre("Jun 2026", "Jul", "Aug"));
  EXPECT_THAT(labels(700, 4, ReportLanguage::kGerman),
              ElementsAre("Jul 2026", "Jan 2027", "Jul", "Jan 2028"));
  for (const double days : {0.01, 1.0, 9.0, 40.0, 333.0, 2000.0, 20000.0})
    EXPECT_THAT(labels(days, 5, ReportLanguage::kEnglish).size(), Le(7U)) << days;
}

TEST(DateAxis, NamesDaysInTheLanguage) {
  EXPECT_EQ(day_label(kMonday + 3600.0, ReportLanguage::kEnglish), "4 May 2026");
  EXPECT_EQ(day_label("2026-05-04", ReportLanguage::kGerman), "04.05.2026");
  EXPECT_EQ(day_label("soon", ReportLanguage::kGerman), "soon");
  EXPECT_EQ(iso_day(kMonday - 1.0), "2026-05-03");
  EXPECT_EQ(time_label(kMonday + 34200.0), "09:30");
  EXPECT_EQ(week_begin(kMonday), kMonday);
  EXPECT_EQ(week_begin(kMonday - 1.0), kMonday - 7.0 * kDay);
}

ResultRow done(double date, const char* exercise, int trials, bool assessment = false) {
  ResultRow row;
  row.date = date;
  row.exercise = exercise;
  row.repetitions = trials;
  row.successes = trials / 2;
  row.seconds = 60.0;
  row.assessment = assessment;
  return row;
}

TEST(Dose, AddsUpDaysAndWeeksWithTheEmptyOnes) {
  const std::vector<ResultRow> rows = {done(kMonday + 10.0, "a", 4), done(kMonday + 20.0, "b", 6, true),
                                       done(kMonday + kDay, "a", 10), done(kMonday + 15.0 * kDay, "a", 2)};
  std::vector<const ResultRow*> pointers;
  RowDetails details;
  for (const ResultRow& row : rows) {
    pointers.push_back(&row);
    details.emplace(&row, result_detail(row));
  }
  const std::vector<Dose> days = dose_by_day(pointers, details);
  ASSERT_EQ(days.size(), 3U);
  EXPECT_EQ(days[0].trials, 10);
  EXPECT_EQ(days[0].successes, 2) << "an assessment has none";
  EXPECT_EQ(days[0].counted, 4) << "an assessment has none";
  EXPECT_EQ(days[0].trainings, 1);
  EXPECT_THAT(days[0].names, ElementsAre("a", "b"));
  const std::vector<Dose> weeks = dose_by_week(pointers, details);
  ASSERT_EQ(weeks.size(), 3U);
  EXPECT_EQ(weeks[0].days, 2);
  EXPECT_EQ(weeks[0].seconds, 180.0);
  EXPECT_EQ(weeks[1].exercises, 0);
  EXPECT_EQ(weeks[2].trials, 2);
  EXPECT_EQ(whole_dose(pointers, details).days, 3);
  EXPECT_TRUE(dose_by_week({}, {}).empty());
}

}  // namespace
}  // namespace phalanx::report
