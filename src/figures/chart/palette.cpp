// SPDX-License-Identifier: Apache-2.0
#include "figures/chart/palette.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "phalanx/figures/chart.h"

namespace phalanx {
namespace {

/// Okabe and Ito's palette. Its yellow is too pale for lines; a grey replaces it.
constexpr std::array<const char*, kCurveColours> kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                             "#000000", "#E69F00", "#56B4E9", "#7F7F7F"};
constexpr std::array<const char*, kCurveColours> kMarkers = {
    "M-1.9,0a1.9,1.9 0 1,0 3.8,0a1.9,1.9 0 1,0 -3.8,0",
    "M-1.7,-1.7h3.4v3.4h-3.4z",
    "M0,-2.2L2.1,1.5H-2.1z",
    "M0,-2.3L2.3,0L0,2.3L-2.3,0z",
    "M0,2.2L2.1,-1.5H-2.1z",
    "M-2.2,0H2.2M0,-2.2V2.2",
    "M-1.7,-1.7L1.7,1.7M-1.7,1.7L1.7,-1.7",
    "M-2.1,-1h4.2v2h-4.2z"};
constexpr std::array<const char*, 3> kDashes = {"none", "4 2", "1.2 1.8"};

using Rgb = std::array<double, 3>;

/// Converts L*a*b* to XYZ, one coordinate relative to white. CIE 15.
double lab_inverse(double f) { return f > 6.0 / 29.0 ? f * f * f : 3.0 * 36.0 / 841.0 * (f - 4.0 / 29.0); }

/// Converts polar L*a*b*, white D65, to sRGB (IEC 61966-2-1). The result may lie outside [0, 1].
Rgb srgb(double lightness, double chroma, double hue) {
  const double f = (lightness + 16.0) / 116.0;
  const double x = 0.95047 * lab_inverse(f + chroma * std::cos(hue) / 500.0);
  const double y = lab_inverse(f);
  const double z = 1.08883 * lab_inverse(f - chroma * std::sin(hue) / 200.0);
  const Rgb linear = {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                      0.0557 * x - 0.2040 * y + 1.0570 * z};
  Rgb result;
  std::transform(linear.begin(), linear.end(), result.begin(), [](double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
  });
  return result;
}

bool can_be_shown(const Rgb& colour) {
  return std::all_of(colour.begin(), colour.end(), [](double c) { return c >= 0.0 && c <= 1.0; });
}

}  // namespace

CurveStyle curve_style(std::size_t index) noexcept {
  return {kColours[index % kColours.size()], kMarkers[index % kMarkers.size()],
          kDashes[index / kColours.size() % kDashes.size()]};
}

ScaleColour scale_colour(double share) {
  constexpr double kRadian = std::numbers::pi / 180.0;
  const double t = std::clamp(share, 0.0, 1.0);
  const double lightness = 20.0 + 70.0 * t;
  const double hue = kRadian * (300.0 - 200.0 * t);  // violet blue, teal, green, yellow
  // Teal, in the middle, cannot be vivid on a screen. The colours beside it are muted too, so that
  // none is conspicuous.
  double chroma = 38.0 + 38.0 * (2.0 * t - 1.0) * (2.0 * t - 1.0);
  while (!can_be_shown(srgb(lightness, chroma, hue))) chroma -= 0.5;  // always possible for grey
  const Rgb colour = srgb(lightness, chroma, hue);
  const auto byte = [](double c) { return static_cast<int>(std::lround(255.0 * c)); };
  return {fmt::format("#{:02X}{:02X}{:02X}", byte(colour[0]), byte(colour[1]), byte(colour[2])),
          lightness < 50.0 ? "#FFF" : "#000"};
}

}  // namespace phalanx
