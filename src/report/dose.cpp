// SPDX-License-Identifier: Apache-2.0
#include "report/dose.h"

#include <algorithm>
#include <cmath>

#include "report/date_axis.h"

namespace phalanx::report {
namespace {

double day_begin(double utc) { return kDay * std::floor(utc / kDay); }

void add_row(Dose& dose, const ResultRow& row, const ResultDetail& detail) {
  ++dose.exercises;
  dose.trials += row.repetitions;
  if (!row.assessment && row.valid) {
    ++dose.trainings;
    dose.counted += detail.counted;
    dose.successes += row.successes;
  }
  dose.seconds += row.seconds;
  if (!is_complete(row)) ++dose.incomplete;
  dose.pain = std::max(dose.pain, detail.pain);
  dose.fatigue = std::max(dose.fatigue, detail.fatigue);
  if (std::find(dose.names.begin(), dose.names.end(), row.exercise) == dose.names.end())
    dose.names.push_back(row.exercise);
}

/// Counts days: a row of another day than the one before it begins one.
class DayCounter {
 public:
  bool is_new(double utc) {
    const double day = day_begin(utc);
    if (day == last_) return false;
    last_ = day;
    return true;
  }

 private:
  double last_ = -1.0;
};

}  // namespace

std::vector<Dose> dose_by_day(RowPointers rows, const RowDetails& details) {
  std::vector<Dose> days;
  DayCounter counter;
  for (const ResultRow* row : rows) {
    if (counter.is_new(row->date)) days.push_back({.begin = day_begin(row->date), .days = 1});
    add_row(days.back(), *row, details.at(row));
  }
  return days;
}

std::vector<Dose> dose_by_week(RowPointers rows, const RowDetails& details) {
  std::vector<Dose> weeks;
  DayCounter counter;
  for (const ResultRow* row : rows) {
    const double begin = week_begin(row->date);
    if (weeks.empty()) weeks.push_back({.begin = begin});
    while (weeks.back().begin < begin) weeks.push_back({.begin = weeks.back().begin + 7.0 * kDay});
    if (counter.is_new(row->date)) ++weeks.back().days;
    add_row(weeks.back(), *row, details.at(row));
  }
  return weeks;
}

Dose whole_dose(RowPointers rows, const RowDetails& details) {
  Dose dose;
  DayCounter counter;
  for (const ResultRow* row : rows) {
    if (dose.exercises == 0) dose.begin = row->date;
    if (counter.is_new(row->date)) ++dose.days;
    add_row(dose, *row, details.at(row));
  }
  return dose;
}

}  // namespace phalanx::report
