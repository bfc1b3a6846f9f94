// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "figures/plot/panel.h"
#include "figures/plot/ticks.h"
#include "phalanx/core/constants.h"
#include "phalanx/figures/human_names.h"

namespace phalanx {
namespace {

constexpr double kWidth = 180.0 * 72.0 / 25.4;  // [pt]
constexpr double kLeft = 52.0;
constexpr double kLegendWidth = 126.0;
constexpr double kTop = 68.0;
constexpr double kPanelHeight = 124.0;
constexpr double kPanelGap = 30.0;
constexpr double kBottom = 32.0;
constexpr std::size_t kMostAngles = 6;
constexpr double kLeastMove = 0.5 / kRadToDeg;  // joints that move less are at rest [rad]

using Value = std::function<double(const TraceTick&, std::size_t)>;

std::vector<double> values(const Trace& trace, std::size_t i, const Value& value) {
  std::vector<double> result(trace.size());
  std::transform(trace.begin(), trace.end(), result.begin(),
                 [&](const TraceTick& tick) { return value(tick, i); });
  return result;
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

Panel force_panel(const Trace& trace) {
  const Value raw = [](const TraceTick& tick, std::size_t i) { return tick.force_raw[i]; };
  const Value sent = [](const TraceTick& tick, std::size_t i) { return tick.force[i]; };
  std::size_t total = 0;
  const auto indices = most_telling(
      kSegments, kMostCurves, 0.0,
      [&](std::size_t i) {
        const double by_sent = largest_absolute(trace, i, sent);
        return by_sent > 0.0 ? by_sent : 1e-6 * largest_absolute(trace, i, raw);
      },
      total);
  Panel panel{.title = "Contact forces",
              .y_label = "force [N]",
              .solid_means = "sent",
              .dashed_means = "as the law gives it",
              .note = shown_note(indices.size(), total),
              .empty = "no segment touched",
              .curves = {},
              .clip_dashed = true};
  for (const std::size_t i : indices) {
    panel.curves.push_back(
        {human_segment_name(static_cast<int>(i)), values(trace, i, sent), values(trace, i, raw)});
  }
  return panel;
}

Panel torque_panel(const Trace& trace) {
  const Value torque = [](const TraceTick& tick, std::size_t i) { return tick.torque[i]; };
  std::size_t total = 0;
  const auto indices = most_telling(
      kJoints, kMostCurves, 1e-12, [&](std::size_t i) { return largest_absolute(trace, i, torque); }, total);
  Panel panel{.title = "Joint torques",
              .y_label = "torque [Nm]",
              .solid_means = "",
              .dashed_means = "",
              .note = shown_note(indices.size(), total),
              .empty = "no joint carried torque",
              .curves = {}};
  for (const std::size_t i : indices) {
    panel.curves.push_back({human_joint_name(static_cast<int>(i)), values(trace, i, torque), {}});
  }
  return panel;
}

Panel angle_panel(const Trace& trace) {
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
  Panel panel{.title = "Joint angles",
              .y_label = "angle [\u00B0]",
              .solid_means = "shown hand (GDP)",
              .dashed_means = "measured (HCP)",
              .note = shown_note(indices.size(), total),
              .empty = "no joint moved",
              .curves = {}};
  for (const std::size_t i : indices) {
    panel.curves.push_back(
        {human_joint_name(static_cast<int>(i)), values(trace, i, gdp), values(trace, i, hcp)});
  }
  return panel;
}

/// Cuts a text to at most `most` characters of UTF-8.
std::string shortened(const std::string& text, std::size_t most) {
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_character = (static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U;
    if (starts_character && ++characters > most) return text.substr(0, i) + "\u2026";
  }
  return text;
}

}  // namespace

std::string plot_svg(const Trace& trace, const PlotText& text) {
  if (trace.empty()) throw std::invalid_argument("plot: the run has no ticks");
  std::vector<double> time(trace.size());
  std::transform(trace.begin(), trace.end(), time.begin(), [](const TraceTick& tick) { return tick.time_s; });
  const double low = time.front();
  const double high = time.back() > low ? time.back() : low + 1.0;
  const auto time_ticks = nice_ticks(low, high, 8);

  const std::array<Panel, 3> panels = {force_panel(trace), torque_panel(trace), angle_panel(trace)};
  const double height = kTop + 3 * kPanelHeight + 2 * kPanelGap + kBottom;
  const double plot_width = kWidth - kLeft - kLegendWidth - 12.0;
  std::string svg = fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="180mm" height="{:.2f}mm" viewBox="0 0 {:.2f} {:.2f}" font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif" font-size="8">
<title>{}</title>
<rect width="100%" height="100%" fill="#FFF"/>
<text x="{:.2f}" y="17" font-size="10.5" font-weight="bold">{}</text>
<text x="{:.2f}" y="29" fill="#444">{}</text>
<text x="{:.2f}" y="40" fill="#444">{}</text>
)",
      height * 25.4 / 72.0, kWidth, height, xml_escaped(text.title), kLeft,
      xml_escaped(shortened(text.title, 70)), kLeft, xml_escaped(shortened(text.subtitle, 105)), kLeft,
      xml_escaped(shortened(text.parameters, 105)));
  double y = kTop;
  for (std::size_t i = 0; i < panels.size(); ++i, y += kPanelHeight + kPanelGap) {
    const PanelFrame frame{.x = kLeft,
                           .y = y,
                           .width = plot_width,
                           .height = kPanelHeight,
                           .legend_x = kLeft + plot_width + 12.0,
                           .time_low = low,
                           .time_high = high,
                           .time_ticks = time_ticks,
                           .time_labels = i + 1 == panels.size()};
    svg += draw_panel(panels[i], frame, time, fmt::format("panel{}", i));
  }
  svg += fmt::format(R"(<text x="{:.2f}" y="{:.2f}" text-anchor="middle">time [s]</text>
</svg>
)",
                     kLeft + plot_width / 2, height - 6);
  return svg;
}

}  // namespace phalanx
