// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures/chart/axis.h"
#include "figures/chart/palette.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

constexpr double kBarsWidth = 180.0 * kPointsPerMm;
constexpr double kRow = 14.0;
constexpr double kNumberRoom = 32.0;

void check(const BarChart& chart) {
  for (const BarChart::Quantity& quantity : chart.quantities) {
    const std::size_t size = chart.names.size();
    if (quantity.value.size() != size || (!quantity.at_least.empty() && quantity.at_least.size() != size))
      throw std::invalid_argument(fmt::format("bar chart: '{}' has {} values for {} names; give one for each",
                                              quantity.label, quantity.value.size(), size));
  }
}

/// @returns the range from 0 to the largest value.
Range bar_range(const std::vector<double>& values) {
  Range range{.low = 0.0, .high = 0.0};
  for (const double value : values) range.include(std::max(0.0, value));
  return range.for_axis();
}

void draw_quantity(Svg& svg, const BarChart::Quantity& quantity, double x, double width, double top) {
  const std::vector<std::string> label = wrapped(quantity.label, width, 2);
  for (std::size_t i = 0; i < label.size(); ++i) {
    svg.text(x, top - 6 - 10 * static_cast<double>(label.size() - 1 - i), label[i], Anchor::kStart,
             R"( font-weight="bold")");
  }
  const double height = kRow * static_cast<double>(quantity.value.size());
  const double per_unit = (width - kNumberRoom) / bar_range(quantity.value).high;
  for (std::size_t i = 0; i < quantity.value.size(); ++i) {
    const double y = top + kRow * static_cast<double>(i);
    const double value = quantity.value[i];
    const double length = std::isfinite(value) ? std::max(0.0, value * per_unit) : 0.0;
    if (length > 0.0)
      svg.add(R"svg(<rect class="bar" x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>)svg",
              x, y + 2, length, kRow - 4, curve_style(0).colour);
    const bool at_least = !quantity.at_least.empty() && quantity.at_least[i];
    svg.text(x + length + 3, y + kRow / 2 + 2.8, (at_least ? "\u2265" : "") + number_text(value));
  }
  svg.add(R"svg(<path d="M{:.2f},{:.2f}v{:.2f}" stroke="#000" stroke-width="0.7"/>)svg", x, top, height);
}

}  // namespace

std::string bar_chart_svg(const BarChart& chart) {
  check(chart);
  Svg svg(kBarsWidth);
  const double top = svg.heading(chart.title) + 28;
  const double names = std::min(text_width(chart.names), 0.3 * kBarsWidth);
  for (std::size_t i = 0; i < chart.names.size(); ++i) {
    const double y = top + kRow * static_cast<double>(i);
    if (i % 2 == 0)
      svg.add(R"svg(<rect x="4" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="#F5F5F5"/>)svg", y,
              kBarsWidth - 8, kRow);
    svg.text(8 + names, y + kRow / 2 + 2.8, cut_to(chart.names[i], names + 1), Anchor::kEnd);
  }
  const double left = names + 14;
  const double width = (kBarsWidth - 4 - left) / std::max(1.0, static_cast<double>(chart.quantities.size()));
  for (std::size_t i = 0; i < chart.quantities.size(); ++i)
    draw_quantity(svg, chart.quantities[i], left + width * static_cast<double>(i), width - 8, top);
  return svg.document(top + kRow * static_cast<double>(chart.names.size()) + 6, chart.title);
}

}  // namespace phalanx
