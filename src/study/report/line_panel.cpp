// SPDX-License-Identifier: Apache-2.0
#include "study/report/line_panel.h"

#include <algorithm>
#include <cmath>

#include "figures/plot/polyline.h"
#include "figures/plot/ticks.h"
#include "study/report/palette.h"

namespace phalanx {
namespace {

constexpr double kLine = 10.5;          // height of a legend line [pt]
constexpr double kLegendIndent = 23.0;  // room for a sample of the curve [pt]
constexpr double kLegendText = kLegendWidth - kLegendIndent - 2.0;
constexpr std::size_t kLongCurveMarkers = 6;

std::size_t shown(const ChartPanel& panel) { return std::min(panel.series.size(), kMostSeries); }

bool at_least(const ChartSeries& series, std::size_t i) {
  return !series.at_least.empty() && series.at_least[i];
}

bool has_at_least(const ChartPanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), [](const ChartSeries& series) {
    return std::find(series.at_least.begin(), series.at_least.end(), true) != series.at_least.end();
  });
}

/// Finds ranges [begin, end) without a gap.
std::vector<std::pair<std::size_t, std::size_t>> stretches(const ChartSeries& series) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
    if (!result.empty() && result.back().second == i) {
      ++result.back().second;
    } else {
      result.emplace_back(i, i + 1);
    }
  }
  return result;
}

class LinePanelDrawing {
 public:
  LinePanelDrawing(Svg& svg, const LineChart& chart, std::size_t index, const SharedAxis& axis, double top,
                   double height)
      : svg_(svg),
        chart_(chart),
        panel_(chart.panels[index]),
        index_(index),
        axis_(axis),
        top_(top),
        height_(height) {
    double low = HUGE_VAL;
    double high = -HUGE_VAL;
    const auto include = [&](double y) {
      if (!std::isfinite(y)) return;
      low = std::min(low, y);
      high = std::max(high, y);
    };
    for (std::size_t s = 0; s < shown(panel_); ++s) {
      for (const auto* part : {&panel_.series[s].y, &panel_.series[s].low, &panel_.series[s].high})
        std::for_each(part->begin(), part->end(), include);
    }
    for (const ChartMark& mark : panel_.marks) include(mark.y);
    empty_ = low > high;
    if (panel_.from_zero || empty_) include(0.0);
    if (!(high > low)) high = low + std::max(1e-12, low == 0.0 ? 1.0 : 0.1 * std::abs(low));
    if (has_at_least(panel_)) high += 0.12 * (high - low);  // room for the arrows
    ticks_ = nice_ticks(low, high, 5);
  }

  void draw() {
    windows();
    grid();
    for (std::size_t s = 0; s < shown(panel_); ++s) band(panel_.series[s], s);
    marks();
    for (std::size_t s = 0; s < shown(panel_); ++s) line(panel_.series[s], s);
    for (std::size_t s = 0; s < shown(panel_); ++s) markers(panel_.series[s], s);
    axes();
    if (empty_)
      svg_.text(axis_.left + axis_.width / 2, top_ + height_ / 2, "no value", Anchor::kMiddle,
                R"( fill="#666")");
    if (panel_.legend) legend();
  }

 private:
  [[nodiscard]] double py(double y) const {
    return top_ + height_ * (ticks_.back() - y) / (ticks_.back() - ticks_.front());
  }
  [[nodiscard]] bool first() const { return index_ == 0; }
  [[nodiscard]] bool last() const { return index_ + 1 == chart_.panels.size(); }

  void windows() {
    for (const ChartWindow& window : chart_.windows) {
      const double from = axis_.at(std::clamp(window.from, axis_.low, axis_.high));
      const double to = axis_.at(std::clamp(window.to, axis_.low, axis_.high));
      if (!(to > from)) continue;
      svg_.add(R"svg(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="#EFEDE4"/>)svg", from,
               top_, to - from, height_);
      // Above the frame, where no curve runs; the label of a narrow window extends past its edges.
      if (first())
        svg_.text((from + to) / 2, top_ - 3, cut_to(window.label, std::max(to - from, 70.0)), Anchor::kMiddle,
                  R"( font-size="7" fill="#6B6650")");
    }
  }

  void grid() {
    std::string path;
    for (const double tick : ticks_)
      path += fmt::format("M{:.2f},{:.2f}h{:.2f}", axis_.left, py(tick), axis_.width);
    for (const double tick : axis_.ticks)
      path += fmt::format("M{:.2f},{:.2f}v{:.2f}", axis_.at(tick), top_, height_);
    svg_.add(R"svg(<path d="{}" stroke="#DDD" stroke-width="0.5"/>)svg", path);
  }

  void band(const ChartSeries& series, std::size_t index) {
    for (const auto& [begin, end] : stretches(series)) {
      if (series.low.empty()) return;
      std::string edge;
      std::string back;
      for (std::size_t i = begin; i < end; ++i) {
        const double low = std::isfinite(series.low[i]) ? series.low[i] : series.y[i];
        const double high = std::isfinite(series.high[i]) ? series.high[i] : series.y[i];
        edge += fmt::format("{}{:.2f},{:.2f}", edge.empty() ? "M" : "L", axis_.at(series.x[i]), py(low));
        back.insert(0, fmt::format("L{:.2f},{:.2f}", axis_.at(series.x[i]), py(high)));
      }
      svg_.add(R"svg(<path class="band" d="{}{}z" fill="{}" fill-opacity="0.15"/>)svg", edge, back,
               curve_style(index).colour);
    }
  }

  void marks() {
    for (const ChartMark& mark : panel_.marks) {
      if (!std::isfinite(mark.y)) continue;
      svg_.add(
          R"svg(<path class="mark" d="M{:.2f},{:.2f}h{:.2f}" stroke="#333" stroke-width="0.8" stroke-dasharray="5 2 1 2"/>)svg",
          axis_.left, py(mark.y), axis_.width);
      // A white rim keeps the label readable if a curve passes behind it.
      const double y = py(mark.y) < top_ + 10 ? py(mark.y) + 8 : py(mark.y) - 2.5;
      svg_.text(
          axis_.left + axis_.width - 3, y, cut_to(mark.label, axis_.width / 2), Anchor::kEnd,
          R"( font-size="7.5" fill="#333" stroke="#FFF" stroke-width="2" stroke-opacity="0.8" paint-order="stroke")");
    }
  }

  void line(const ChartSeries& series, std::size_t index) {
    std::string path;
    const double columns = 2.0 * axis_.width;
    for (const auto& [begin, end] : stretches(series)) {
      const auto from = static_cast<std::ptrdiff_t>(begin);
      const std::vector<double> values(series.y.begin() + from,
                                       series.y.begin() + static_cast<std::ptrdiff_t>(end));
      const double share = static_cast<double>(values.size()) / static_cast<double>(series.x.size());
      bool pen_down = false;
      for (const std::size_t i : thinned(values, static_cast<std::size_t>(std::ceil(columns * share)))) {
        path += fmt::format("{}{:.2f},{:.2f}", pen_down ? "L" : "M", axis_.at(series.x[begin + i]),
                            py(values[i]));
        pen_down = true;
      }
    }
    if (path.empty()) return;
    const CurveStyle style = curve_style(index);
    svg_.add(
        R"svg(<path class="curve" d="{}" fill="none" stroke="{}" stroke-width="1.1" stroke-linejoin="round" stroke-dasharray="{}"/>)svg",
        path, style.colour, series.dashed ? "3 1.6" : style.dashes);
  }

  void markers(const ChartSeries& series, std::size_t index) {
    const bool all = series.x.size() <= kMarkedPoints;
    for (const auto& [begin, end] : stretches(series)) {
      if (all || end - begin == 1) {
        for (std::size_t i = begin; i < end; ++i) marker(series, i, index);
      }
    }
    arrows(series, index);
    if (all) return;
    // Spread along the curve, at other places for each curve.
    const double stagger = (static_cast<double>(index) + 0.5) / static_cast<double>(shown(panel_));
    for (std::size_t m = 0; m < kLongCurveMarkers; ++m) {
      const double share = (static_cast<double>(m) + stagger) / static_cast<double>(kLongCurveMarkers);
      const auto i = static_cast<std::size_t>(share * static_cast<double>(series.x.size() - 1));
      if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) marker(series, i, index);
    }
  }

  /// Draws arrows; an arrow that would touch the last one is left out.
  void arrows(const ChartSeries& series, std::size_t index) {
    constexpr double kApart = 8.0;
    double last = -kApart;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!at_least(series, i) || !std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      if (axis_.at(series.x[i]) - last < kApart) continue;
      last = axis_.at(series.x[i]);
      arrow(last, py(series.y[i]), index);
    }
  }

  void marker(const ChartSeries& series, std::size_t i, std::size_t index) {
    marker(axis_.at(series.x[i]), py(series.y[i]), index);
  }
  void marker(double x, double y, std::size_t index) {
    const CurveStyle style = curve_style(index);
    svg_.add(
        R"svg(<path class="marker" transform="translate({:.2f},{:.2f})" d="{}" fill="#FFF" stroke="{}" stroke-width="0.9"/>)svg",
        x, y, style.marker, style.colour);
  }
  void arrow(double x, double y, std::size_t index) {
    svg_.add(
        R"svg(<path class="at-least" d="M{:.2f},{:.2f}v-9m-2.2,3.2l2.2,-3.2l2.2,3.2" fill="none" stroke="{}" stroke-width="1"/>)svg",
        x, y - 2.5, index < kMostSeries ? curve_style(index).colour : "#555");
  }

  void axes() {
    const double bottom = top_ + height_;
    svg_.add(R"svg(<path d="M{:.2f},{:.2f}V{:.2f}H{:.2f}" fill="none" stroke="#000" stroke-width="0.7"/>)svg",
             axis_.left, top_, bottom, axis_.left + axis_.width);
    if (ticks_.front() < 0.0 && ticks_.back() > 0.0)
      svg_.add(R"svg(<path d="M{:.2f},{:.2f}h{:.2f}" stroke="#888" stroke-width="0.6"/>)svg", axis_.left,
               py(0.0), axis_.width);
    std::string strokes;
    for (const double tick : ticks_) {
      strokes += fmt::format("M{:.2f},{:.2f}h-3", axis_.left, py(tick));
      svg_.text(axis_.left - 5, py(tick) + 2.8, tick_label(tick, ticks_[1] - ticks_[0]), Anchor::kEnd);
    }
    for (const double tick : axis_.ticks) {
      strokes += fmt::format("M{:.2f},{:.2f}v3", axis_.at(tick), bottom);
      if (last())
        svg_.text(axis_.at(tick), bottom + 12, tick_label(tick, axis_.ticks[1] - axis_.ticks[0]),
                  Anchor::kMiddle);
    }
    svg_.add(R"svg(<path d="{}" stroke="#000" stroke-width="0.7"/>)svg", strokes);
    const double above = first() && !chart_.windows.empty() ? 13.0 : 5.0;
    svg_.text(axis_.left, top_ - above, cut_to(panel_.title, axis_.width), Anchor::kStart,
              R"( font-weight="bold")");
    svg_.text_upwards(axis_.left - 34, top_ + height_ / 2, cut_to(panel_.y_label, height_ + 20));
  }

  void legend() {
    const double x = axis_.left + axis_.width + kLegendGap;
    double y = top_ + 3;
    const auto words = [&](const std::string& text, double indent, const char* fill) {
      for (const std::string& part : wrapped(text, kLegendText, 2)) {
        svg_.text(x + indent, y + 2.8, part, Anchor::kStart, fmt::format(R"( fill="{}")", fill));
        y += kLine;
      }
    };
    for (std::size_t s = 0; s < shown(panel_); ++s) {
      if (panel_.series[s].name.empty()) continue;
      const CurveStyle style = curve_style(s);
      svg_.add(R"svg(<path d="M{:.2f},{:.2f}h18" stroke="{}" stroke-width="1.1" stroke-dasharray="{}"/>)svg",
               x, y, style.colour, panel_.series[s].dashed ? "3 1.6" : style.dashes);
      marker(x + 9, y, s);
      words(panel_.series[s].name, kLegendIndent, "#000");
    }
    if (has_at_least(panel_)) {
      arrow(x + 9, y + 7, kMostSeries);
      words("at least", kLegendIndent, "#555");
    }
    if (shown(panel_) < panel_.series.size())
      words(fmt::format("{} of {} curves shown", shown(panel_), panel_.series.size()), 0, "#555");
  }

  Svg& svg_;
  const LineChart& chart_;
  const ChartPanel& panel_;
  std::size_t index_;
  const SharedAxis& axis_;
  double top_, height_;
  std::vector<double> ticks_;
  bool empty_ = false;
};

}  // namespace

double legend_height(const ChartPanel& panel) {
  if (!panel.legend) return 0.0;
  std::size_t lines = (has_at_least(panel) ? 1U : 0U) + (panel.series.size() > kMostSeries ? 1U : 0U);
  for (std::size_t s = 0; s < shown(panel); ++s) {
    if (!panel.series[s].name.empty()) lines += wrapped(panel.series[s].name, kLegendText, 2).size();
  }
  return kLine * static_cast<double>(lines);
}

void draw_line_panel(Svg& svg, const LineChart& chart, std::size_t index, const SharedAxis& axis, double top,
                     double height) {
  LinePanelDrawing(svg, chart, index, axis, top, height).draw();
}

}  // namespace phalanx
