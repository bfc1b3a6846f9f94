// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/line_panel.h"

#include <algorithm>
#include <cmath>

#include "figures/chart/axis.h"
#include "figures/chart/palette.h"
#include "figures/chart/polyline.h"

namespace phalanx {
namespace {

constexpr double kLine = 10.5;          // height of a legend line [pt]
constexpr double kLegendIndent = 23.0;  // room for a sample of the curve [pt]
constexpr std::size_t kLongCurveMarkers = 6;
constexpr const char* kCompanionDashes = "3 1.6";

/// Breaks a text of the legend that begins `indent` from its left edge.
std::vector<std::string> legend_lines(const std::string& text, double indent) {
  return wrapped(text, kLegendWidth - indent - 2.0, 2);
}

std::size_t shown(const ChartPanel& panel) { return std::min(panel.series.size(), kMostSeries); }

bool at_least(const ChartSeries& series, std::size_t i) {
  return !series.at_least.empty() && series.at_least[i];
}

bool has_at_least(const ChartPanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(), [](const ChartSeries& series) {
    return std::find(series.at_least.begin(), series.at_least.end(), true) != series.at_least.end();
  });
}

bool has_companions(const ChartPanel& panel) {
  return std::any_of(panel.series.begin(), panel.series.end(),
                     [](const ChartSeries& series) { return !series.companion.empty(); });
}

/// Finds ranges [begin, end) without a gap.
std::vector<std::pair<std::size_t, std::size_t>> stretches(const std::vector<double>& x,
                                                           const std::vector<double>& y) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    if (!result.empty() && result.back().second == i) {
      ++result.back().second;
    } else {
      result.emplace_back(i, i + 1);
    }
  }
  return result;
}

/// The y axis of a panel.
struct PanelScale {
  Range range;             ///< of the axis
  bool empty = false;      ///< no value is finite
  double off_scale = 0.0;  ///< how high the companions reach if they are cut; 0: they are not
};

PanelScale scale_of(const ChartPanel& panel) {
  Range curves;
  for (std::size_t s = 0; s < shown(panel); ++s) {
    for (const auto* part : {&panel.series[s].y, &panel.series[s].low, &panel.series[s].high})
      curves.include(*part);
  }
  for (const ChartMark& mark : panel.marks) curves.include(mark.y);
  Range all = curves;
  for (std::size_t s = 0; s < shown(panel); ++s) all.include(panel.series[s].companion);
  PanelScale scale{.range = all, .empty = all.empty()};
  if (panel.clip_companions && curves.high > 0.0 && all.high > 2.5 * curves.high) {
    scale.off_scale = all.high;
    scale.range.high = 1.5 * curves.high;
  }
  if (panel.from_zero) scale.range.include(0.0);
  scale.range = scale.range.for_axis();
  if (has_at_least(panel)) scale.range.high += 0.12 * (scale.range.high - scale.range.low);  // arrows
  return scale;
}

/// @returns the last lines of the legend, without a sample.
std::vector<std::string> legend_notes(const ChartPanel& panel) {
  std::vector<std::string> notes;
  if (const double top = scale_of(panel).off_scale; top > 0.0)
    notes.push_back(fmt::format("dashed up to {}, off scale", number_text(top)));
  if (shown(panel) < panel.series.size())
    notes.push_back(fmt::format("{} of {} curves shown", shown(panel), panel.series.size()));
  if (!panel.note.empty()) notes.push_back(panel.note);
  return notes;
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
        height_(height),
        scale_(scale_of(panel_)) {
    ticks_ = nice_ticks(scale_.range.low, scale_.range.high, 5);
  }

  void draw() {
    windows();
    grid();
    for (std::size_t s = 0; s < shown(panel_); ++s) band(panel_.series[s], s);
    marks();
    companions();
    for (std::size_t s = 0; s < shown(panel_); ++s) line(panel_.series[s], s);
    for (std::size_t s = 0; s < shown(panel_); ++s) markers(panel_.series[s], s);
    axes();
    if (scale_.empty)
      svg_.text(axis_.left + axis_.width / 2, top_ + height_ / 2, panel_.empty, Anchor::kMiddle,
                R"( fill="#666")");
    if (panel_.legend) legend();
  }

 private:
  [[nodiscard]] double py(double y) const {
    return top_ + height_ * (ticks_.back() - drawable(y)) / (ticks_.back() - ticks_.front());
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
    for (const auto& [begin, end] : stretches(series.x, series.y)) {
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

  /// @returns the path through the points, thinned, with gaps. A point far outside the frame is moved nearer:
  /// only the direction to it is visible.
  [[nodiscard]] std::string path(const std::vector<double>& x, const std::vector<double>& y) const {
    std::string result;
    const double columns = 2.0 * axis_.width;
    for (const auto& [begin, end] : stretches(x, y)) {
      const std::vector<double> values(y.begin() + static_cast<std::ptrdiff_t>(begin),
                                       y.begin() + static_cast<std::ptrdiff_t>(end));
      const double share = static_cast<double>(values.size()) / static_cast<double>(x.size());
      bool pen_down = false;
      for (const std::size_t i : thinned(values, static_cast<std::size_t>(std::ceil(columns * share)))) {
        result += fmt::format("{}{:.2f},{:.2f}", pen_down ? "L" : "M", axis_.at(x[begin + i]),
                              std::clamp(py(values[i]), top_ - height_, top_ + 2.0 * height_));
        pen_down = true;
      }
    }
    return result;
  }

  /// Draws the companions below all curves, cut at the frame if they reach beyond it.
  void companions() {
    if (!has_companions(panel_)) return;
    const bool cut = scale_.off_scale > 0.0;
    if (cut) {
      // A viewport cuts without an id, which would have to be unique on a page with several charts.
      svg_.add(
          R"svg(<svg x="{0:.2f}" y="{1:.2f}" width="{2:.2f}" height="{3:.2f}" viewBox="{0:.2f} {1:.2f} {2:.2f} {3:.2f}" overflow="hidden">)svg",
          axis_.left, top_ - 1, axis_.width, height_ + 2);
    }
    for (std::size_t s = 0; s < shown(panel_); ++s) {
      const ChartSeries& series = panel_.series[s];
      if (series.companion.empty()) continue;
      const std::string points = path(series.x, series.companion);
      if (points.empty()) continue;
      svg_.add(
          R"svg(<path class="companion" d="{}" fill="none" stroke="{}" stroke-width="0.7" stroke-linejoin="round" stroke-dasharray="{}" stroke-opacity="0.85"/>)svg",
          points, curve_style(s).colour, kCompanionDashes);
    }
    if (cut) svg_.add("</svg>");
  }

  void line(const ChartSeries& series, std::size_t index) {
    const std::string points = path(series.x, series.y);
    if (points.empty()) return;
    const CurveStyle style = curve_style(index);
    svg_.add(
        R"svg(<path class="curve" d="{}" fill="none" stroke="{}" stroke-width="1.1" stroke-linejoin="round" stroke-dasharray="{}"/>)svg",
        points, style.colour, style.dashes);
  }

  void markers(const ChartSeries& series, std::size_t index) {
    const bool all = series.x.size() <= kMarkedPoints;
    for (const auto& [begin, end] : stretches(series.x, series.y)) {
      if (all || end - begin == 1) {
        for (std::size_t i = begin; i < end; ++i) marker(series, i, index);
      }
    }
    arrows(series, index);
    if (all) return;
    // Spread along the curve, at other places for each curve. At 0, where many curves lie, none is drawn.
    const double stagger = (static_cast<double>(index) + 0.5) / static_cast<double>(shown(panel_));
    for (std::size_t m = 0; m < kLongCurveMarkers; ++m) {
      const double share = (static_cast<double>(m) + stagger) / static_cast<double>(kLongCurveMarkers);
      const auto i = static_cast<std::size_t>(share * static_cast<double>(series.x.size() - 1));
      if (std::isfinite(series.x[i]) && std::isfinite(series.y[i]) && series.y[i] != 0.0)
        marker(series, i, index);
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
      for (const std::string& part : legend_lines(text, indent)) {
        svg_.text(x + indent, y + 2.8, part, Anchor::kStart, fmt::format(R"( fill="{}")", fill));
        y += kLine;
      }
    };
    const auto sample = [&](const char* colour, double stroke, const char* dashes) {
      svg_.add(R"svg(<path d="M{:.2f},{:.2f}h18" stroke="{}" stroke-width="{}" stroke-dasharray="{}"/>)svg",
               x, y, colour, stroke, dashes);
    };
    for (std::size_t s = 0; s < shown(panel_); ++s) {
      if (panel_.series[s].name.empty()) continue;
      const CurveStyle style = curve_style(s);
      sample(style.colour, 1.1, style.dashes);
      marker(x + 9, y, s);
      words(panel_.series[s].name, kLegendIndent, "#000");
    }
    if (has_at_least(panel_)) {
      arrow(x + 9, y + 7, kMostSeries);
      words("at least", kLegendIndent, "#555");
    }
    if (has_companions(panel_)) {
      sample("#555", 1.1, "none");
      words(panel_.solid_means, kLegendIndent, "#555");
      sample("#555", 0.7, kCompanionDashes);
      words(panel_.dashed_means, kLegendIndent, "#555");
    }
    for (const std::string& note : legend_notes(panel_)) words(note, 0.0, "#555");
  }

  Svg& svg_;
  const LineChart& chart_;
  const ChartPanel& panel_;
  std::size_t index_;
  const SharedAxis& axis_;
  double top_, height_;
  PanelScale scale_;
  std::vector<double> ticks_;
};

}  // namespace

double legend_height(const ChartPanel& panel) {
  if (!panel.legend) return 0.0;
  std::size_t lines = has_at_least(panel) ? 1U : 0U;
  const auto add = [&](const std::string& text, double indent = kLegendIndent) {
    lines += legend_lines(text, indent).size();
  };
  for (std::size_t s = 0; s < shown(panel); ++s) {
    if (!panel.series[s].name.empty()) add(panel.series[s].name);
  }
  if (has_companions(panel)) {
    add(panel.solid_means);
    add(panel.dashed_means);
  }
  for (const std::string& note : legend_notes(panel)) add(note, 0.0);
  return kLine * static_cast<double>(lines);
}

void draw_line_panel(Svg& svg, const LineChart& chart, std::size_t index, const SharedAxis& axis, double top,
                     double height) {
  LinePanelDrawing(svg, chart, index, axis, top, height).draw();
}

}  // namespace phalanx
