// SPDX-License-Identifier: Apache-2.0
#include "figures/plot/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "figures/plot/polyline.h"
#include "figures/plot/ticks.h"

namespace phalanx {
namespace {

/// Okabe and Ito's palette, which colour-blind readers can distinguish. Its yellow is too pale for lines; a
/// grey replaces it.
constexpr std::array<const char*, kMostCurves> kCurveColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                                "#000000", "#E69F00", "#56B4E9", "#7F7F7F"};
/// Markers for readers of a grey copy: paths around the origin.
constexpr std::array<const char*, kMostCurves> kCurveMarkers = {
    "M-1.7,0a1.7,1.7 0 1,0 3.4,0a1.7,1.7 0 1,0 -3.4,0",
    "M-1.5,-1.5h3v3h-3z",
    "M0,-2L1.9,1.3H-1.9z",
    "M0,-2.1L2.1,0L0,2.1L-2.1,0z",
    "M0,2L1.9,-1.3H-1.9z",
    "M-2,0H2M0,-2V2",
    "M-1.5,-1.5L1.5,1.5M-1.5,1.5L1.5,-1.5",
    "M-1.9,-0.9h3.8v1.8h-3.8z"};
constexpr int kMarkersPerCurve = 6;

struct Range {
  double low = 0.0;
  double high = 0.0;
  void include(const std::vector<double>& values) {
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
};

class PanelDrawing {
 public:
  PanelDrawing(const Panel& panel, const PanelFrame& frame, const std::vector<double>& time)
      : panel_(panel), frame_(frame), time_(time) {
    Range range;
    for (const Curve& curve : panel.curves) range.include(curve.solid);
    Range dashed = range;
    for (const Curve& curve : panel.curves) dashed.include(curve.dashed);
    const double solid_extent = range.high - range.low;
    if (panel.clip_dashed && solid_extent > 0.0 && dashed.high > 2.5 * range.high) {
      off_scale_ = dashed.high;
      range.high *= 1.5;
    } else {
      range = dashed;
    }
    if (!(range.high > range.low)) range.high = range.low + 1.0;
    y_ticks_ = nice_ticks(range.low, range.high, 5);
  }

  std::string draw(const std::string& clip_id) {
    grid();
    add(R"svg(<clipPath id="{}"><rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}"/></clipPath>)svg",
        clip_id, frame_.x, frame_.y - 1, frame_.width, frame_.height + 2);
    add(R"svg(<g clip-path="url(#{})" fill="none" stroke-linejoin="round">)svg", clip_id);
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) line(panel_.curves[i].dashed, i, true);
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) line(panel_.curves[i].solid, i, false);
    for (std::size_t i = 0; i < panel_.curves.size(); ++i) markers(panel_.curves[i].solid, i);
    add("</g>");
    axes();
    if (panel_.curves.empty()) {
      add(R"svg(<text x="{:.2f}" y="{:.2f}" text-anchor="middle" fill="#666">{}</text>)svg",
          frame_.x + frame_.width / 2, frame_.y + frame_.height / 2, xml_escaped(panel_.empty));
    } else {
      legend();
    }
    return std::move(svg_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    svg_ += fmt::format(format, std::forward<Args>(args)...);
    svg_ += '\n';
  }

  [[nodiscard]] double px(double time) const {
    return frame_.x + frame_.width * (time - frame_.time_low) / (frame_.time_high - frame_.time_low);
  }
  [[nodiscard]] double py(double value) const {
    return frame_.y + frame_.height * (y_ticks_.back() - value) / (y_ticks_.back() - y_ticks_.front());
  }

  void grid() {
    add(R"svg(<g stroke="#E4E4E4" stroke-width="0.5">)svg");
    for (const double tick : y_ticks_) {
      add(R"svg(<path d="M{:.2f},{:.2f}h{:.2f}"/>)svg", frame_.x, py(tick), frame_.width);
    }
    for (const double tick : frame_.time_ticks) {
      if (tick <= frame_.time_high)
        add(R"svg(<path d="M{:.2f},{:.2f}v{:.2f}"/>)svg", px(tick), frame_.y, frame_.height);
    }
    add("</g>");
  }

  void line(const std::vector<double>& values, std::size_t index, bool dashed) {
    if (values.empty()) return;
    std::string points;
    bool pen_down = false;
    for (const std::size_t i : thinned(values, static_cast<std::size_t>(2.0 * frame_.width))) {
      if (!std::isfinite(values[i])) {
        pen_down = false;
        continue;
      }
      // A number far outside the frame would only be long; just outside is enough.
      const double y = std::clamp(py(values[i]), frame_.y - frame_.height, frame_.y + 2.0 * frame_.height);
      points += fmt::format("{}{:.2f},{:.2f}", pen_down ? "L" : "M", px(time_[i]), y);
      pen_down = true;
    }
    if (dashed) {
      add(R"svg(<path class="dashed" d="{}" stroke="{}" stroke-width="0.7" stroke-dasharray="3 1.6" stroke-opacity="0.85"/>)svg",
          points, kCurveColours[index]);
    } else {
      add(R"svg(<path class="solid" d="{}" stroke="{}" stroke-width="1.25"/>)svg", points,
          kCurveColours[index]);
    }
  }

  void markers(const std::vector<double>& values, std::size_t index) {
    const double stagger = (static_cast<double>(index) + 0.5) / static_cast<double>(panel_.curves.size());
    for (int m = 0; m < kMarkersPerCurve; ++m) {
      const double share = (m + stagger) / kMarkersPerCurve;
      const auto i =
          std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
      if (std::isfinite(values[i]) && values[i] != 0.0) marker(px(time_[i]), py(values[i]), index);
    }
  }

  void marker(double x, double y, std::size_t index) {
    add(R"svg(<path transform="translate({:.2f},{:.2f})" d="{}" fill="#FFF" stroke="{}" stroke-width="0.9"/>)svg",
        x, y, kCurveMarkers[index], kCurveColours[index]);
  }

  void axes() {
    const double bottom = frame_.y + frame_.height;
    add(R"svg(<path d="M{:.2f},{:.2f}V{:.2f}H{:.2f}" fill="none" stroke="#000" stroke-width="0.7"/>)svg",
        frame_.x, frame_.y, bottom, frame_.x + frame_.width);
    if (y_ticks_.front() < 0.0 && y_ticks_.back() > 0.0) {
      add(R"svg(<path d="M{:.2f},{:.2f}h{:.2f}" stroke="#888" stroke-width="0.6"/>)svg", frame_.x, py(0.0),
          frame_.width);
    }
    const double y_spacing = y_ticks_[1] - y_ticks_[0];
    for (const double tick : y_ticks_) {
      add(R"svg(<path d="M{0:.2f},{1:.2f}h-3" stroke="#000" stroke-width="0.7"/><text x="{2:.2f}" y="{3:.2f}" text-anchor="end">{4}</text>)svg",
          frame_.x, py(tick), frame_.x - 5, py(tick) + 2.8, tick_label(tick, y_spacing));
    }
    for (const double tick : frame_.time_ticks) {
      if (tick > frame_.time_high * (1 + 1e-9)) continue;
      add(R"svg(<path d="M{:.2f},{:.2f}v3" stroke="#000" stroke-width="0.7"/>)svg", px(tick), bottom);
      if (!frame_.time_labels) continue;
      add(R"svg(<text x="{:.2f}" y="{:.2f}" text-anchor="middle">{}</text>)svg", px(tick), bottom + 12,
          tick_label(tick, frame_.time_ticks[1] - frame_.time_ticks[0]));
    }
    add(R"svg(<text x="{:.2f}" y="{:.2f}" font-size="9" font-weight="bold">{}</text>)svg", frame_.x,
        frame_.y - 6, xml_escaped(panel_.title));
    add(R"svg(<text transform="translate({:.2f},{:.2f}) rotate(-90)" text-anchor="middle">{}</text>)svg",
        frame_.x - 38, frame_.y + frame_.height / 2, xml_escaped(panel_.y_label));
  }

  void legend() {
    constexpr double kLine = 11.5;
    double y = frame_.y + 3;
    const double x = frame_.legend_x;
    const auto words = [&](const std::string& text, const char* fill, double indent) {
      add(R"svg(<text x="{:.2f}" y="{:.2f}" fill="{}">{}</text>)svg", x + indent, y + 2.8, fill,
          xml_escaped(text));
    };
    for (std::size_t i = 0; i < panel_.curves.size(); ++i, y += kLine) {
      add(R"svg(<path d="M{:.2f},{:.2f}h18" stroke="{}" stroke-width="1.25"/>)svg", x, y, kCurveColours[i]);
      marker(x + 9, y, i);
      words(panel_.curves[i].label, "#000", 23);
    }
    y += 1.5;
    if (!panel_.dashed_means.empty()) {
      add(R"svg(<path d="M{:.2f},{:.2f}h18" stroke="#555" stroke-width="1.25"/>)svg", x, y);
      words(panel_.solid_means, "#555", 23);
      y += kLine;
      add(R"svg(<path d="M{:.2f},{:.2f}h18" stroke="#555" stroke-width="0.7" stroke-dasharray="3 1.6"/>)svg",
          x, y);
      words(panel_.dashed_means, "#555", 23);
      y += kLine;
    }
    if (off_scale_ > 0.0) {
      words(fmt::format("dashed up to {:.3g}, off scale", off_scale_), "#555", 0);
      y += kLine;
    }
    if (!panel_.note.empty()) words(panel_.note, "#555", 0);
  }

  const Panel& panel_;
  const PanelFrame& frame_;
  const std::vector<double>& time_;
  std::vector<double> y_ticks_;
  double off_scale_ = 0.0;
  std::string svg_;
};

}  // namespace

std::string draw_panel(const Panel& panel, const PanelFrame& frame, const std::vector<double>& time,
                       const std::string& clip_id) {
  return PanelDrawing(panel, frame, time).draw(clip_id);
}

std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

}  // namespace phalanx
