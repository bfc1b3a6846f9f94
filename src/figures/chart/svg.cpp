// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/svg.h"

#include <algorithm>
#include <cmath>

#include "phalanx/core/xml_text.h"

namespace phalanx {
namespace {

/// Mean width of a character of Helvetica or DejaVu Sans in texts of this program, as a multiple
/// of the height.
constexpr double kCharacter = 0.54 * 8.0;

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

/// @returns the first `count` characters.
std::string first_characters(const std::string& text, std::size_t count) {
  std::size_t seen = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (starts_character(text[i]) && ++seen > count) return text.substr(0, i);
  }
  return text;
}

const char* name(Anchor anchor) {
  switch (anchor) {
    case Anchor::kStart:
      return "start";
    case Anchor::kMiddle:
      return "middle";
    case Anchor::kEnd:
      return "end";
  }
  return "";
}

}  // namespace

double text_width(const std::string& text) { return kCharacter * static_cast<double>(characters(text)); }

double text_width(const std::vector<std::string>& texts) {
  double widest = 0.0;
  for (const std::string& text : texts) widest = std::max(widest, text_width(text));
  return widest;
}

std::string cut_to(const std::string& text, double width) {
  const auto most = static_cast<std::size_t>(std::max(1.0, width / kCharacter));
  return characters(text) <= most ? text : first_characters(text, most - 1) + "\u2026";
}

std::vector<std::string> wrapped(const std::string& text, double width, std::size_t most) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (lines.size() + 1 < most && text_width(rest) > width) {
    std::string line = first_characters(rest, static_cast<std::size_t>(std::max(1.0, width / kCharacter)));
    if (const std::size_t space = line.rfind(' '); space != std::string::npos && space > 0)
      line.resize(space);
    rest.erase(0, line.size());
    rest.erase(0, std::min(rest.find_first_not_of(' '), rest.size()));
    lines.push_back(std::move(line));
  }
  lines.push_back(cut_to(rest, width));
  return lines;
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::abs(value);
  std::string number =
      size >= 999.5 && size < 1e6 ? fmt::format("{:.0f}", size) : fmt::format("{:.3g}", size);
  return value < 0.0 ? "\u2212" + number : number;
}

void Svg::text(double x, double y, const std::string& text, Anchor anchor, const std::string& more) {
  add(R"svg(<text x="{:.2f}" y="{:.2f}" text-anchor="{}"{}>{}</text>)svg", x, y, name(anchor), more,
      xml_escaped(text));
}

void Svg::text_upwards(double x, double y, const std::string& text, Anchor anchor) {
  add(R"svg(<text transform="translate({:.2f},{:.2f}) rotate(-90)" text-anchor="{}">{}</text>)svg", x, y,
      name(anchor), xml_escaped(text));
}

double Svg::heading(const std::string& title, const std::vector<std::string>& subtitles) {
  double y = 0.0;
  if (!title.empty()) {
    y += 15.0;
    text(4.0, y, cut_to(title, (width_ - 8.0) / 1.3), Anchor::kStart,
         R"( font-size="10" font-weight="bold")");
  }
  for (const std::string& subtitle : subtitles) {
    if (subtitle.empty()) continue;
    y += 12.0;
    text(4.0, y, cut_to(subtitle, width_ - 8.0), Anchor::kStart, R"( fill="#444")");
  }
  return y > 0.0 ? y + 7.0 : 0.0;
}

void Svg::define_hatch() {
  add("{}",
      R"svg(<defs><pattern id="hatch" width="4" height="4" patternUnits="userSpaceOnUse"><rect width="4" height="4" fill="#FFF"/><path d="M-1,1L1,-1M0,4L4,0M3,5L5,3" stroke="#777" stroke-width="0.6"/></pattern></defs>)svg");
}

std::string Svg::document(double height, const std::string& title) const {
  return fmt::format(
      R"svg(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="{:.2f}mm" height="{:.2f}mm" viewBox="0 0 {:.2f} {:.2f}" font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif" font-size="8">
<title>{}</title>
<rect width="100%" height="100%" fill="#FFF"/>
{}</svg>
)svg",
      width_ / kPointsPerMm, height / kPointsPerMm, width_, height, xml_escaped(title), body_);
}

}  // namespace phalanx
