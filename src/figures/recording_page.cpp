// SPDX-License-Identifier: Apache-2.0
#include "phalanx/figures/recording_page.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "figures/html.h"
#include "phalanx/core/index.h"
#include "phalanx/figures/chart.h"
#include "phalanx/hand/joints.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostNumbered = 30;
constexpr std::size_t kMostRows = 500;
constexpr std::size_t kLongText = 500;  ///< above which the data of an exercise are not shown [bytes]
constexpr double kLongestGap = 0.2;     ///< between two forces that are joined by a line [s]

std::string moment(double seconds) {
  const int whole = static_cast<int>(seconds);
  return fmt::format("{}:{:06.3f}", whole / 60, seconds - 60.0 * (whole / 60));
}

/// @returns the text of an event; data of an exercise are for programs
std::string shown_text(const RecordedEvent& event) {
  if (!event.code.starts_with("exercise_") || event.text.size() <= kLongText) return event.text;
  return fmt::format("{} bytes; `phalanx exercise results` shows what they hold", event.text.size());
}

LineChart chart_of(const RecordingContent& content) {
  LineChart chart;
  chart.x_label = "time [s]";
  ChartPanel& panel = chart.panels.emplace_back();
  panel.title = "Force of each digit";
  panel.y_label = "force [N]";
  panel.height = 200.0;
  panel.empty = "no force";
  for (int digit = 0; digit < kDigits; ++digit) {
    ChartSeries& series = panel.series.emplace_back();
    series.name = std::string(digit_name(digit));
    for (std::size_t i = 0; i < content.forces.size(); ++i) {
      const RecordedForce& force = content.forces[i];
      if (i > 0 && force.time - content.forces[i - 1].time > kLongestGap) {
        series.x.push_back(content.forces[i - 1].time);
        series.y.push_back(std::nan(""));
      }
      series.x.push_back(force.time);
      series.y.push_back(force.force[idx(digit)]);
    }
  }
  const double all = content.forces.empty() ? 1.0 : std::max(1.0, content.forces.back().time);
  for (std::size_t i = 0; i < std::min(kMostNumbered, content.events.size()); ++i) {
    const double at = content.events[i].time;
    chart.windows.push_back({.from = at, .to = at + 0.002 * all, .label = std::to_string(i + 1)});
  }
  return chart;
}

}  // namespace

std::string recording_page_html(const RecordingSummary& summary, const RecordingContent& content) {
  HtmlPage page("Recording " + summary.file.filename().string());
  page.paragraph(fmt::format("{:%Y-%m-%d %H:%M:%S} UTC, {}; scene {}, device {}; recorded by Phalanx {}.",
                             fmt::gmtime(static_cast<std::time_t>(summary.begin)), moment(summary.seconds),
                             summary.scene.empty() ? "unknown" : summary.scene,
                             summary.device.empty() ? "unknown" : summary.device,
                             summary.version.empty() ? "unknown" : summary.version));
  page.paragraph(fmt::format("{} steps, {} events, {} gaps.", summary.steps, summary.events, summary.gaps));
  page.figures({line_chart_svg(chart_of(content))},
               "Sum of the magnitudes of the forces on each digit, as asked of the motors, about 60 values a "
               "second. The "
               "numbers are those of the table below.");
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < std::min(kMostRows, content.events.size()); ++i) {
    const RecordedEvent& event = content.events[i];
    rows.push_back({std::to_string(i + 1), moment(event.time), event.code, event.who, shown_text(event)});
  }
  page.heading("Events");
  if (content.events.size() > kMostRows)
    page.paragraph(fmt::format("The first {} of {}.", kMostRows, content.events.size()));
  page.table({"no.", "time [min:s]", "what", "who", "text"}, rows);
  return page.document();
}

}  // namespace phalanx
