// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "phalanx/core/constants.h"
#include "phalanx/figures/chart.h"
#include "phalanx/figures/human_names.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostAngles = 6;
constexpr double kLeastMove = 0.5 / kRadToDeg;  // joints that move less are at rest [rad]

using Value = std::function<double(const TraceTick&, std::size_t)>;

std::vector<double> values(const Trace& trace, std::size_t i, const Value& value) {
  std::vector<double> result(trace.size());
  std::transform(trace.begin(), trace.end(), result.begin(),
                 [&](const TraceTick& tick) { return value(tick, i); });
  return result;
}

ChartSeries curve(const std::string& name, const Trace& trace, std::vector<double> solid,
                  std::vector<double> dashed) {
  return {.name = name,
          .x = values(trace, 0, [](const TraceTick& tick, std::size_t) { return tick.time_s; }),
          .y = std::move(solid),
          .low = {},
          .high = {},
          .companion = std::move(dashed)};
}

/// Selects indices below `count` whose importance is above `threshold`: the `most` largest ones,
/// in index order.
std::vector<std::size_t> most_telling(std::size_t count, std::size_t most, double threshold,
                                      const std::function<double(std::size_t)>& importance,
                                      std::size_t& total) {
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t i = 0; i < count; ++i) {
    if (const double value = importance(i); value > threshold) ranked.emplace_back(-value, i);
  }
  total = ranked.size();
  std::sort(ranked.begin(), ranked.end());
  if (ranked.size() > most) ranked.resize(most);
  std::vector<std::size_t> indices;
  for (const auto& [value, i] : ranked) indices.push_back(i);
  std::sort(indices.begin(), indices.end());
  return indices;
}

std::string shown_note(std::size_t shown, std::size_t total) {
  return shown < total ? fmt::format("{} of {} shown", shown, total) : "";
}

double largest_absolute(const Trace& trace, std::size_t i, const Value& value) {
  double largest = 0.0;
  for (const TraceTick& tick : trace) largest = std::max(largest, std::abs(value(tick, i)));
  return largest;
}

ChartPanel force_plot(const Trace& trace) {
  const Value raw = [](const TraceTick& tick, std::size_t i) { return tick.force_raw[i]; };
  const Value sent = [](const TraceTick& tick, std::size_t i) { return tick.force[i]; };
  std::size_t total = 0;
  const auto indices = most_telling(
      kSegments, kCurveColours, 0.0,
      [&](std::size_t i) {
        const double by_sent = largest_absolute(trace, i, sent);
        return by_sent > 0.0 ? by_sent : 1e-6 * largest_absolute(trace, i, raw);
      },
      total);
  ChartPanel panel{.title = "Contact forces",
                   .y_label = "force [N]",
                   .series = {},
                   .marks = {},
                   .solid_means = "sent",
                   .dashed_means = "as the law gives it",
                   .clip_companions = true,
                   .note = shown_note(indices.size(), total),
                   .empty = "no segment touched"};
  for (const std::size_t i : indices)
    panel.series.push_back(
        curve(human_segment_name(static_cast<int>(i)), trace, values(trace, i, sent), values(trace, i, raw)));
  return panel;
}

ChartPanel torque_plot(const Trace& trace) {
  const Value torque = [](const TraceTick& tick, std::size_t i) { return tick.torque[i]; };
  std::size_t total = 0;
  const auto indices = most_telling(
      kJoints, kCurveColours, 1e-12, [&](std::size_t i) { return largest_absolute(trace, i, torque); },
      total);
  ChartPanel panel{.title = "Joint torques",
                   .y_label = "torque [Nm]",
                   .series = {},
                   .marks = {},
                   .note = shown_note(indices.size(), total),
                   .empty = "no joint carried torque"};
  for (const std::size_t i : indices)
    panel.series.push_back(curve(human_joint_name(static_cast<int>(i)), trace, values(trace, i, torque), {}));
  return panel;
}

ChartPanel angle_plot(const Trace& trace) {
  const Value hcp = [](const TraceTick& tick, std::size_t i) { return kRadToDeg * tick.hcp_angle[i]; };
  const Value gdp = [](const TraceTick& tick, std::size_t i) { return kRadToDeg * tick.gdp_angle[i]; };
  std::size_t total = 0;
  const auto moved = [&](std::size_t i) {
    const auto [low, high] = std::minmax_element(
        trace.begin(), trace.end(),
        [i](const TraceTick& a, const TraceTick& b) { return a.hcp_angle[i] < b.hcp_angle[i]; });
    return high->hcp_angle[i] - low->hcp_angle[i];
  };
  const auto indices = most_telling(kJoints, kMostAngles, kLeastMove, moved, total);
  ChartPanel panel{.title = "Joint angles",
                   .y_label = "angle [\u00B0]",
                   .series = {},
                   .marks = {},
                   .solid_means = "shown hand (GDP)",
                   .dashed_means = "measured (HCP)",
                   .note = shown_note(indices.size(), total),
                   .empty = "no joint moved"};
  for (const std::size_t i : indices) {
    const bool completed = trace.back().angle_origin[i] == AngleOrigin::kCompleted;
    const std::string name = human_joint_name(static_cast<int>(i)) + (completed ? " (completed)" : "");
    panel.series.push_back(curve(name, trace, values(trace, i, gdp), values(trace, i, hcp)));
  }
  return panel;
}

}  // namespace

TraceTick trace_tick(const Snapshot& snapshot) {
  TraceTick tick{.time_s = snapshot.time_s,
                 .torque = snapshot.torque,
                 .hcp_angle = snapshot.hcp_angle,
                 .gdp_angle = snapshot.gdp_angle,
                 .angle_origin = snapshot.angle_origin};
  for (std::size_t s = 0; s < snapshot.segment.size(); ++s) {
    tick.force_raw[s] = snapshot.segment[s].force_raw;
    tick.force[s] = snapshot.segment[s].force;
  }
  return tick;
}

std::string plot_svg(const Trace& trace, const PlotText& text) {
  if (trace.empty()) throw std::invalid_argument("plot: the run has no ticks");
  return line_chart_svg({.title = text.title,
                         .subtitles = {text.subtitle, text.parameters},
                         .x_label = "time [s]",
                         .panels = {force_plot(trace), torque_plot(trace), angle_plot(trace)},
                         .windows = {},
                         .x_covers = {trace.front().time_s, trace.back().time_s}});
}

}  // namespace phalanx
