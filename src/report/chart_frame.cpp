// SPDX-License-Identifier: Apache-2.0
#include "report/chart_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/date_axis.h"

namespace phalanx::report {

void draw_value_ticks(Svg& svg, const ChartFrame& frame, const std::vector<double>& ticks,
                      const std::vector<std::string>& labels) {
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = frame.y(ticks[i]);
    if (y < frame.top - 0.5 || y > frame.bottom + 0.5) continue;
    svg.add(R"(<path d="M{:.1f},{:.1f}H{:.1f}" stroke="{}" stroke-width="0.5"/>)", frame.left, y, frame.right,
            kGridInk);
    svg.text(frame.left - 3.0, y + 2.4, labels[i], Anchor::kEnd,
             fmt::format(R"( font-size="7" fill="{}")", kLabelInk));
  }
}

void draw_date_ticks(Svg& svg, const ChartFrame& frame, ReportLanguage language) {
  constexpr double kLabelWidth = 27.0;  // [pt]
  svg.add(R"(<path d="M{:.1f},{:.1f}H{:.1f}" stroke="#9aa5ad" stroke-width="0.6"/>)", frame.left,
          frame.bottom, frame.right);
  const int most = std::max(2, static_cast<int>((frame.right - frame.left) / kLabelWidth));
  double free_from = frame.left - 14.0;
  for (const DateTick& tick : date_ticks(frame.span.from, frame.span.to, most, language)) {
    const double x = frame.x(tick.utc);
    svg.add(R"(<path d="M{:.1f},{:.1f}v2.5" stroke="#9aa5ad" stroke-width="0.6"/>)", x, frame.bottom);
    const double half = 0.45 * text_width(tick.label);
    if (x - half < free_from) continue;
    free_from = x + half + 3.0;
    svg.text(x, frame.bottom + 9.5, tick.label, Anchor::kMiddle,
             fmt::format(R"( font-size="7" fill="{}")", kLabelInk));
  }
}

void draw_line(Svg& svg, const std::vector<double>& xs, const std::vector<double>& ys, const char* colour) {
  std::string path;
  for (std::size_t i = 0; i < xs.size(); ++i)
    path.append(fmt::format("{}{:.1f},{:.1f}", i == 0 ? 'M' : 'L', xs[i], ys[i]));
  svg.add(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.1" stroke-linejoin="round"/>)", path,
          colour);
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks, ReportLanguage language) {
  const double spacing = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  std::vector<std::string> labels;
  for (const double tick : ticks) {
    labels.push_back(tick_label(tick, spacing));
    if (language == ReportLanguage::kGerman)
      std::replace(labels.back().begin(), labels.back().end(), '.', ',');
  }
  return labels;
}

std::string embedded_svg(const Svg& svg, double height, const std::string& title) {
  const std::string document = svg.document(height, title);
  return document.substr(document.find("<svg"));
}

}  // namespace phalanx::report
