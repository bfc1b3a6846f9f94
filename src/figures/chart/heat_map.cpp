// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "figures/chart/axis.h"
#include "figures/chart/column_names.h"
#include "figures/chart/palette.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

constexpr double kScaleWidth = 10.0;  // width of the colour scale [pt]
constexpr double kScaleRoom = 58.0;   // with its numbers and words
constexpr double kLeastScaleHeight = 70.0;
constexpr double kLetter = 8.5;  // height of a line of text [pt]

class HeatMapDrawing {
 public:
  explicit HeatMapDrawing(const HeatMap& map) : map_(map), width_(map.width_mm * kPointsPerMm), svg_(width_) {
    Range values;
    values.include(map.value);
    empty_ = values.empty();
    const Range drawn = values.for_axis();
    scale_.low = map.low.value_or(drawn.low);
    scale_.high = std::max(scale_.low, map.high.value_or(drawn.high));
    scale_ = scale_.for_axis();
    const double columns = std::max(1.0, static_cast<double>(map.columns.size()));
    const double rows = std::max(1.0, static_cast<double>(map.rows.size()));
    const double most = std::clamp(text_width(map.columns) + 2.0, 46.0, 80.0);
    const double room = width_ - 8.0 - (map.y_label.empty() ? 0.0 : 14.0) - kScaleRoom - 16.0;
    // The rows' names may have what the widest cells leave.
    row_room_ = std::min(text_width(map.rows), std::max(0.3 * width_, room - most * columns));
    left_ = 8.0 + row_room_ + (map.y_label.empty() ? 0.0 : 14.0);
    cell_w_ = std::min(most, (room - row_room_) / columns);
    // The cells have room for the number if the map then still fits on a page.
    cell_h_ = std::clamp(400.0 / rows, 1.5, 17.0);
  }

  std::string draw() {
    svg_.define_hatch();
    top_ = svg_.heading(map_.title) + 6.0;
    cells();
    numbers();
    row_names();
    const double below = column_names();
    colour_scale();
    const double hatch_end = hatch_legend();
    return svg_.document(std::max(below, hatch_end) + 6.0, map_.title);
  }

 private:
  [[nodiscard]] double px(std::size_t column) const { return left_ + cell_w_ * static_cast<double>(column); }
  [[nodiscard]] double py(std::size_t row) const { return top_ + cell_h_ * static_cast<double>(row); }
  [[nodiscard]] double bottom() const { return py(map_.rows.size()); }
  [[nodiscard]] double share(double value) const { return (value - scale_.low) / (scale_.high - scale_.low); }
  [[nodiscard]] double value(std::size_t row, std::size_t column) const {
    return map_.value[row * map_.columns.size() + column];
  }
  [[nodiscard]] bool at_least(std::size_t row, std::size_t column) const {
    return !map_.at_least.empty() && map_.at_least[row * map_.columns.size() + column];
  }
  [[nodiscard]] std::string cell_text(std::size_t row, std::size_t column) const {
    const double number = value(row, column);
    if (!std::isfinite(number)) return {};
    return (at_least(row, column) ? "\u2265" : "") + number_text(number);
  }

  void cells() {
    svg_.add(R"svg(<g shape-rendering="crispEdges">)svg");  // no pale gaps between cells
    for (std::size_t row = 0; row < map_.rows.size(); ++row) {
      for (std::size_t column = 0; column < map_.columns.size(); ++column) {
        const double number = value(row, column);
        svg_.add(R"svg(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>)svg",
                 px(column), py(row), cell_w_, cell_h_,
                 std::isfinite(number) ? scale_colour(share(number)).fill : "url(#hatch)");
      }
    }
    svg_.add("</g>");
    svg_.add(
        R"svg(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="none" stroke="#000" stroke-width="0.6"/>)svg",
        left_, top_, px(map_.columns.size()) - left_, bottom() - top_);
  }

  void numbers() {
    double widest_number = 0.0;
    for (std::size_t row = 0; row < map_.rows.size(); ++row) {
      for (std::size_t column = 0; column < map_.columns.size(); ++column)
        widest_number = std::max(widest_number, text_width(cell_text(row, column)));
    }
    // Numbers in all cells or in none: with some numbers only, the others would seem to be missing.
    if (cell_h_ < kLetter + 1.0 || cell_w_ < widest_number) return;
    for (std::size_t row = 0; row < map_.rows.size(); ++row) {
      for (std::size_t column = 0; column < map_.columns.size(); ++column) {
        const double number = value(row, column);
        if (!std::isfinite(number)) continue;
        svg_.text(px(column) + cell_w_ / 2, py(row) + cell_h_ / 2 + 2.8, cell_text(row, column),
                  Anchor::kMiddle, fmt::format(R"( fill="{}")", scale_colour(share(number)).text));
      }
    }
  }

  void row_names() {
    const auto every = static_cast<std::size_t>(std::ceil(kLetter / cell_h_));
    for (std::size_t row = 0; row < map_.rows.size(); row += every)
      svg_.text(left_ - 4, py(row) + cell_h_ / 2 + 2.8, cut_to(map_.rows[row], row_room_ + 1), Anchor::kEnd);
    if (!map_.y_label.empty())
      svg_.text_upwards(10, (top_ + bottom()) / 2, cut_to(map_.y_label, std::max(60.0, bottom() - top_)));
  }

  /// @returns the lower end of the names
  double column_names() {
    const double middle = (left_ + px(map_.columns.size())) / 2;
    const double y = draw_column_names(svg_, map_.columns, left_, cell_w_, bottom());
    if (map_.x_label.empty()) return y;
    svg_.text(middle, y + 12, cut_to(map_.x_label, std::max(90.0, px(map_.columns.size()) - left_)),
              Anchor::kMiddle);
    return y + 14;
  }

  void colour_scale() {
    const double x = px(map_.columns.size()) + 12;
    const double height = scale_height();
    constexpr int kSteps = 24;
    for (int i = 0; i < kSteps; ++i) {
      // A little overlap, so that no gap is visible between two steps.
      svg_.add(
          R"svg(<rect class="scale" x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}"/>)svg", x,
          top_ + height * (kSteps - 1 - i) / kSteps, kScaleWidth, height / kSteps + (i > 0 ? 0.4 : 0.0),
          scale_colour((i + 0.5) / kSteps).fill);
    }
    if (!empty_) {
      const std::vector<double> ticks = nice_ticks(scale_.low, scale_.high, 5);
      for (const double tick : ticks) {
        if (share(tick) < -1e-9 || share(tick) > 1 + 1e-9) continue;
        svg_.text(x + kScaleWidth + 3, top_ + height * (1 - share(tick)) + 2.8,
                  tick_label(tick, ticks[1] - ticks[0]));
      }
    }
    svg_.text_upwards(x + kScaleWidth + 33, top_ + height / 2,
                      cut_to(map_.quantity, std::max(height, 110.0)));
  }

  double hatch_legend() {
    const bool holes =
        std::any_of(map_.value.begin(), map_.value.end(), [](double v) { return !std::isfinite(v); });
    double y = top_ + scale_height();
    if (!holes) return y;
    const double x = px(map_.columns.size()) + 12;
    y += 8;
    svg_.add(
        R"svg(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="9" fill="url(#hatch)" stroke="#777" stroke-width="0.4"/>)svg",
        x, y, kScaleWidth);
    svg_.text(x + kScaleWidth + 3, y + 7.3, "no value");
    return y + 9;
  }

  [[nodiscard]] double scale_height() const { return std::clamp(bottom() - top_, kLeastScaleHeight, 160.0); }

  const HeatMap& map_;
  double width_;
  Svg svg_;
  bool empty_ = false;
  Range scale_;
  double row_room_ = 0.0, left_ = 0.0, top_ = 0.0, cell_w_ = 0.0, cell_h_ = 0.0;
};

}  // namespace

std::string heat_map_svg(const HeatMap& map) {
  const std::size_t size = map.rows.size() * map.columns.size();
  if (map.value.size() != size || (!map.at_least.empty() && map.at_least.size() != size))
    throw std::invalid_argument(fmt::format(
        "heat map '{}': {} values and {} marks for {} rows x {} columns; give rows x columns of each "
        "(marks may be empty)",
        map.title, map.value.size(), map.at_least.size(), map.rows.size(), map.columns.size()));
  return HeatMapDrawing(map).draw();
}

}  // namespace phalanx
