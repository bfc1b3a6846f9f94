// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/trends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "registry/field_checks.h"

namespace phalanx {
namespace {

/// Sorts a few elements; equal ones keep their order.
template <typename Element, typename Less>
void sort_stably(std::vector<Element>& all, const Less& less) {
  for (auto next = all.begin(); next != all.end(); ++next)
    std::rotate(std::upper_bound(all.begin(), next, *next, less), next, std::next(next));
}

std::string day_of(double utc) { return registry::utc_text(utc).substr(0, 10); }

std::vector<std::string> fields_of(const ResultConditions& c) {
  return {c.device, c.serial, c.calibration_method, c.contact_mode, c.stabiliser, c.rendering, c.protocol};
}

/// @returns the names of the conditions that differ
std::string differing(const ResultConditions& a, const ResultConditions& b) {
  static constexpr const char* kNames[] = {
      "device",     "serial number",     "calibration method",   "contact mode",
      "stabiliser", "rendering version", "assessment's protocol"};
  const std::vector<std::string> of_a = fields_of(a);
  const std::vector<std::string> of_b = fields_of(b);
  std::string out;
  for (std::size_t i = 0; i < of_a.size(); ++i)
    if (of_a[i] != of_b[i]) out += fmt::format("{}{}", out.empty() ? "" : ", ", kNames[i]);
  return out;
}

std::string change_text(const Trend& trend) {
  const TrendPoint& first = trend.points.front();
  const TrendPoint& last = trend.points.back();
  return fmt::format("{:+.4g} {} from {} to {}", last.value - first.value, trend.unit, day_of(first.date),
                     day_of(last.date));
}

/// Verdict of a score: no smallest real difference is published for a score of this device.
void judge_score(Trend& trend) {
  trend.verdict = trend.points.size() < 2
                      ? "change not proven: one value only"
                      : fmt::format("change not proven: {}; no smallest real difference is published for it",
                                    change_text(trend));
}

void judge_test(Trend& trend, const TestKindInfo& kind, TestSide side) {
  const double difference =
      side == TestSide::kMoreAffected ? kind.difference_more_affected : kind.difference_less_affected;
  if (!std::isfinite(difference)) return judge_score(trend);
  trend.smallest_real_difference = difference;
  if (trend.points.size() < 2) {
    trend.verdict = "change not proven: one value only";
    return;
  }
  const double change = trend.points.back().value - trend.points.front().value;
  const std::string source =
      fmt::format("smallest real difference {} {}, Chen et al. 2009", difference, trend.unit);
  // Values are entered as decimals: 25.5 - 20 must count as 5.5.
  trend.proven = std::abs(change) >= difference - 1e-9 * std::max(1.0, difference);
  if (!trend.proven)
    trend.verdict = fmt::format("change not proven: {} is within the {}", change_text(trend), source);
  else
    trend.verdict = fmt::format("{}: {}; {}", (change > 0.0) == kind.larger_is_better ? "improved" : "worse",
                                change_text(trend), source);
}

void add_scores(std::span<const ResultRow> results, std::vector<Trend>& out) {
  using Group = std::tuple<std::string, std::string, ScoreOrigin, std::vector<std::string>>;
  std::map<Group, Trend> groups;
  for (const ResultRow& row : results) {
    if (!row.assessment || !row.valid || row.interrupted) continue;
    for (const Score& score : row.scores) {
      if (!score.valid() || !std::isfinite(score.value)) continue;
      const std::string name = fmt::format("{}/{}", row.exercise, score.name);
      Trend& trend = groups[{name, score.unit, score.origin, fields_of(row.conditions)}];
      trend.name = name;
      trend.title = fmt::format("{}: {}", row.exercise, score.name);
      trend.unit = score.unit;
      trend.origin = score.origin;
      trend.conditions = row.conditions;
      trend.points.push_back({.date = row.date, .value = score.value, .recording = row.recording});
    }
  }
  for (auto& [group, trend] : groups) out.push_back(std::move(trend));
}

void add_tests(std::span<const EnteredTest> tests, std::vector<Trend>& out) {
  for (const TestKindInfo& kind : test_kinds())
    for (const TestSide side : {TestSide::kMoreAffected, TestSide::kLessAffected}) {
      Trend trend;
      for (const EnteredTest& test : tests)
        if (test.kind == kind.kind && test.side == side)
          trend.points.push_back(
              {.date = registry::utc_of_day(test.date), .value = test.value, .recording = {}});
      if (trend.points.empty()) continue;
      trend.name = fmt::format("{}/{}", kind.name, test_side_name(side));
      trend.title = fmt::format("{}, {} side", kind.title,
                                side == TestSide::kMoreAffected ? "more affected" : "less affected");
      trend.unit = kind.unit;
      out.push_back(std::move(trend));
    }
}

}  // namespace

std::vector<Trend> make_trends(std::span<const ResultRow> results, std::span<const EnteredTest> tests) {
  std::vector<Trend> out;
  add_scores(results, out);
  const std::size_t scores = out.size();
  add_tests(tests, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    Trend& trend = out[i];
    sort_stably(trend.points, [](const TrendPoint& a, const TrendPoint& b) { return a.date < b.date; });
    if (i < scores) {
      judge_score(trend);
      continue;
    }
    const std::string_view name(trend.name);
    const std::size_t slash = name.find('/');
    judge_test(trend, test_kind(name.substr(0, slash)),
               name.substr(slash + 1) == "more_affected" ? TestSide::kMoreAffected : TestSide::kLessAffected);
  }
  sort_stably(out, [](const Trend& a, const Trend& b) {
    return std::make_tuple(std::string_view(a.name), a.points.front().date) <
           std::make_tuple(std::string_view(b.name), b.points.front().date);
  });
  for (std::size_t i = 1; i < out.size(); ++i)
    if (out[i].name == out[i - 1].name && !(out[i].conditions == out[i - 1].conditions))
      out[i].verdict += fmt::format("; not joined with the earlier values: another {}",
                                    differing(out[i - 1].conditions, out[i].conditions));
  return out;
}

}  // namespace phalanx
