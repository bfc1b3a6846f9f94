// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "figures/chart/axis.h"
#include "figures/chart/column_names.h"
#include "figures/chart/svg.h"
#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

struct Look {
  CellVerdict verdict;
  const char* fill;
  const char* name;    // of the class in the SVG
  const char* legend;  // words of the legend
};
/// Dark, pale and hatched, so that they differ without colour, too. Cells that were not checked
/// show the background.
constexpr std::array<Look, 4> kLooks = {
    Look{CellVerdict::kStable, "#0072B2", "stable", "stable"},
    Look{CellVerdict::kSomeStable, "#A6CEE3", "some_stable", "some seeds stable"},
    Look{CellVerdict::kUnstable, "#F0B95B", "unstable", "unstable"},
    Look{CellVerdict::kInvalid, "url(#hatch)", "invalid", "invalid"}};
constexpr const char* kBackground = "#F1F1F1";
constexpr double kMapLeft = 36.0;
constexpr double kMapRight = 8.0;

class VerdictMapDrawing {
 public:
  explicit VerdictMapDrawing(const VerdictMap& map)
      : map_(map), width_(map.width_mm * kPointsPerMm), svg_(width_) {
    const double columns = std::max(1.0, static_cast<double>(map.columns.size()));
    const double rows = std::max(1.0, static_cast<double>(map.stiffness.size()));
    double widest = 30.0;
    for (const VerdictMap::Column& column : map.columns)
      widest = std::max(widest, text_width(column.name) + 2.0);
    cell_w_ = std::min(std::min(widest, 70.0), (width_ - kMapLeft - kMapRight) / columns);
    height_ = std::clamp(5.0 * rows, 40.0, 200.0);
    cell_h_ = height_ / rows;
  }

  std::string draw() {
    svg_.define_hatch();
    const double heading = svg_.heading(map_.title);
    top_ = legend(heading + 9) + 13;
    svg_.add(
        R"svg(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="{}" stroke="#000" stroke-width="0.6"/>)svg",
        kMapLeft, top_, cell_w_ * static_cast<double>(map_.columns.size()), height_, kBackground);
    for (const Look& look : kLooks) cells(look);
    for (std::size_t column = 0; column < map_.columns.size(); ++column) limit(column);
    axis();
    return svg_.document(column_names() + 6, map_.title);
  }

 private:
  [[nodiscard]] double px(std::size_t column) const {
    return kMapLeft + cell_w_ * static_cast<double>(column);
  }
  /// @returns the upper edge of the cell of grid point `row`, counted from the bottom.
  [[nodiscard]] double py(std::size_t row) const {
    return top_ + height_ - cell_h_ * static_cast<double>(row + 1);
  }

  [[nodiscard]] bool has(CellVerdict verdict) const {
    return std::any_of(map_.columns.begin(), map_.columns.end(), [verdict](const VerdictMap::Column& column) {
      return std::find(column.cell.begin(), column.cell.end(), verdict) != column.cell.end();
    });
  }

  /// @returns where its last line stands.
  double legend(double y) {
    double x = 4.0;
    const auto make_room = [&](const std::string& name) {
      if (x + 12 + text_width(name) <= width_) return;
      x = 4.0;
      y += 11;
    };
    const auto entry = [&](const char* fill, const std::string& name) {
      make_room(name);
      svg_.add(
          R"svg(<rect x="{:.2f}" y="{:.2f}" width="9" height="7" fill="{}" stroke="#777" stroke-width="0.4"/>)svg",
          x, y - 6, fill);
      svg_.text(x + 12, y, name);
      x += 17 + text_width(name);
    };
    for (const Look& look : kLooks)
      if (look.verdict != CellVerdict::kSomeStable || has(look.verdict)) entry(look.fill, look.legend);
    entry(kBackground, "not checked");
    make_room("k_lim");
    svg_.add(R"svg(<path d="M{:.2f},{:.2f}h9" stroke="#000" stroke-width="1.8"/>)svg", x, y - 2.5);
    svg_.text(x + 12, y, "k_lim");
    return y;
  }

  /// Draws all cells of a verdict as one path.
  void cells(const Look& look) {
    std::string path;
    const double gap = cell_h_ > 3.0 ? 0.5 : 0.0;
    for (std::size_t column = 0; column < map_.columns.size(); ++column) {
      const std::vector<CellVerdict>& cell = map_.columns[column].cell;
      for (std::size_t row = 0; row < cell.size(); ++row) {
        if (cell[row] != look.verdict) continue;
        path += fmt::format("M{:.1f},{:.2f}h{:.1f}v{:.2f}h-{:.1f}z", px(column) + 0.3, py(row) + gap / 2,
                            cell_w_ - 0.6, cell_h_ - gap, cell_w_ - 0.6);
      }
    }
    if (!path.empty()) svg_.add(R"svg(<path class="{}" d="{}" fill="{}"/>)svg", look.name, path, look.fill);
  }

  /// Marks k_lim above its cell; if the limit is below the grid, on the lower edge.
  void limit(std::size_t column) {
    const double k_lim = map_.columns[column].k_lim;
    if (!std::isfinite(k_lim) || map_.stiffness.empty()) return;
    const auto above = static_cast<std::size_t>(
        std::upper_bound(map_.stiffness.begin(), map_.stiffness.end(), k_lim * (1 + 1e-9)) -
        map_.stiffness.begin());
    const double y = top_ + height_ - cell_h_ * static_cast<double>(above);
    svg_.add(R"svg(<path class="limit" d="M{:.2f},{:.2f}h{:.2f}" stroke="#000" stroke-width="1.8"/>)svg",
             px(column), y, cell_w_);
    const std::string number =
        (map_.columns[column].at_least ? "\u2265" : "") + (k_lim > 0.0 ? number_text(k_lim) : "<");
    if (text_width(number) > cell_w_ + 2) return;
    // Unstable cells would hide text on the grey above the limit: a rim separates it.
    svg_.text(px(column) + cell_w_ / 2, y - (above == map_.stiffness.size() ? -9 : 3), number,
              Anchor::kMiddle,
              R"( stroke="#FFF" stroke-width="2.2" paint-order="stroke" font-weight="bold")");
  }

  void axis() {
    if (map_.stiffness.empty()) return;
    const double low = map_.stiffness.front();
    const double high = map_.stiffness.back();
    const double spacing = map_.stiffness.size() > 1 ? map_.stiffness[1] - low : 1.0;
    const auto label = [&](double k, double step) {
      const double row = (k - low) / spacing;
      const double y = top_ + height_ - cell_h_ * (row + 0.5);
      svg_.add(R"svg(<path d="M{:.2f},{:.2f}h-3" stroke="#000" stroke-width="0.6"/>)svg", kMapLeft, y);
      svg_.text(kMapLeft - 5, y + 2.8, tick_label(k, step), Anchor::kEnd);
    };
    if (map_.stiffness.size() == 1) {
      label(low, low > 0.0 ? low / 10 : 1.0);
    } else {
      const std::vector<double> ticks =
          nice_ticks(low, high, static_cast<int>(std::clamp(height_ / 22, 2.0, 8.0)));
      for (const double tick : ticks) {
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) label(tick, ticks[1] - ticks[0]);
      }
    }
    svg_.text_upwards(10, top_ + height_ / 2, "stiffness [N/mm]");
  }

  double column_names() {
    std::vector<std::string> names;
    for (const VerdictMap::Column& column : map_.columns) names.push_back(column.name);
    const double y = draw_column_names(svg_, names, kMapLeft, cell_w_, top_ + height_);
    const double middle = (kMapLeft + px(map_.columns.size())) / 2;
    if (map_.x_label.empty()) return y;
    // Under few columns the label may be wider than the columns: it then begins at their left edge.
    const bool wide = text_width(map_.x_label) > 2 * (middle - 4);
    svg_.text(wide ? 4 : middle, y + 12, cut_to(map_.x_label, width_ - 8),
              wide ? Anchor::kStart : Anchor::kMiddle);
    return y + 14;
  }

  const VerdictMap& map_;
  double width_;
  Svg svg_;
  double cell_w_ = 0.0, cell_h_ = 0.0, height_ = 0.0, top_ = 0.0;
};

}  // namespace

std::string verdict_map_svg(const VerdictMap& map) {
  for (const VerdictMap::Column& column : map.columns) {
    if (column.cell.size() != map.stiffness.size())
      throw std::invalid_argument(fmt::format("verdict map '{}': column '{}' has {} cells; the grid has {}",
                                              map.title, column.name, column.cell.size(),
                                              map.stiffness.size()));
  }
  return VerdictMapDrawing(map).draw();
}

}  // namespace phalanx
