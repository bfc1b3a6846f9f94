// SPDX-License-Identifier: Apache-2.0
#include "report/date_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>

#include "registry/field_checks.h"

namespace phalanx::report {
namespace {

constexpr std::array<std::string_view, 12> kEnglishMonths = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                             "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::array<std::string_view, 12> kGermanMonths = {"Jan", "Feb", "M\u00E4r", "Apr", "Mai", "Jun",
                                                            "Jul", "Aug", "Sep",      "Okt", "Nov", "Dez"};

std::chrono::sys_days day_of(double utc) {
  return std::chrono::sys_days(std::chrono::days(static_cast<int>(std::floor(utc / kDay))));
}
double utc_of(std::chrono::sys_days day) {
  return kDay * static_cast<double>(day.time_since_epoch().count());
}

std::string_view month_label(std::chrono::year_month_day date, ReportLanguage language) {
  const auto month = static_cast<std::size_t>(static_cast<unsigned>(date.month()) - 1U);
  return language == ReportLanguage::kGerman ? kGermanMonths.at(month) : kEnglishMonths.at(month);
}

std::string short_day(std::chrono::sys_days day, ReportLanguage language) {
  const std::chrono::year_month_day date(day);
  return fmt::format("{}{} {}", static_cast<unsigned>(date.day()),
                     language == ReportLanguage::kGerman ? "." : "", month_label(date, language));
}

std::vector<DateTick> day_ticks(double from, double to, int spacing, ReportLanguage language) {
  std::vector<DateTick> ticks;
  std::chrono::sys_days day = day_of(from);
  if (spacing % 7 == 0) {
    day = day_of(week_begin(from));
  }
  for (; utc_of(day) <= to; day += std::chrono::days(spacing))
    if (utc_of(day) >= from) ticks.push_back({.utc = utc_of(day), .label = short_day(day, language)});
  return ticks;
}

std::vector<DateTick> month_ticks(double from, double to, int spacing, ReportLanguage language) {
  std::vector<DateTick> ticks;
  const std::chrono::year_month_day first(day_of(from));
  std::chrono::year_month_day month(first.year(), first.month(), std::chrono::day(1));
  for (; utc_of(std::chrono::sys_days(month)) <= to; month += std::chrono::months(1)) {
    const auto number = static_cast<int>(static_cast<unsigned>(month.month())) - 1;
    if ((static_cast<int>(month.year()) * 12 + number) % spacing != 0 ||
        utc_of(std::chrono::sys_days(month)) < from)
      continue;
    std::string label(month_label(month, language));
    if (ticks.empty() || number == 0) label.append(fmt::format(" {}", static_cast<int>(month.year())));
    ticks.push_back({.utc = utc_of(std::chrono::sys_days(month)), .label = std::move(label)});
  }
  return ticks;
}

}  // namespace

std::string iso_day(double utc) { return registry::utc_text(utc).substr(0, 10); }

std::string day_label(double utc, ReportLanguage language) {
  const std::chrono::year_month_day date(day_of(utc));
  if (language == ReportLanguage::kGerman)
    return fmt::format("{:02}.{:02}.{}", static_cast<unsigned>(date.day()),
                       static_cast<unsigned>(date.month()), static_cast<int>(date.year()));
  return fmt::format("{} {}", short_day(day_of(utc), language), static_cast<int>(date.year()));
}

std::string day_label(const std::string& day, ReportLanguage language) {
  const double utc = registry::utc_of_day(day);
  return utc == 0.0 ? day : day_label(utc, language);
}

std::string time_label(double utc) { return registry::utc_text(utc).substr(11, 5); }

double week_begin(double utc) {
  const std::chrono::sys_days day = day_of(utc);
  return utc_of(day - (std::chrono::weekday(day) - std::chrono::Monday));
}

std::vector<DateTick> date_ticks(double from, double to, int most, ReportLanguage language) {
  constexpr double kMonth = 30.44 * kDay;
  for (const int spacing : {1, 2, 7, 14})
    if ((to - from) / (spacing * kDay) <= most) return day_ticks(from, to, spacing, language);
  for (const int spacing : {1, 2, 3, 6})
    if ((to - from) / (spacing * kMonth) <= most) return month_ticks(from, to, spacing, language);
  return month_ticks(from, to, 12 * std::max(1, static_cast<int>((to - from) / (12 * kMonth * most))),
                     language);
}

}  // namespace phalanx::report
