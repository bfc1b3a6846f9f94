// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/anthropometry.h"

#include <algorithm>
#include <array>

#include "phalanx/core/constants.h"

namespace phalanx {
namespace {

// SOURCES (SD: standard deviation)
// [ANSUR] Gordon C. C. et al., "1988 Anthropometric Survey of U.S. Army Personnel: Methods and Summary
//         Statistics", Technical Report NATICK/TR-89/044, 1989. We did not have the report: means and SDs are
//         as commonly cited. Check: Pheasant, "Bodyspace", 1996 (its table rounds to 5 mm) gives British hand
//         breadths of 85, SD 5 (men) and 75, SD 4 (women), which are within the range.
// [BK]    Buryanov A., Kotiuk V., "Proportions of hand segments", Int. J. Morphol. 28(3), 2010, pp. 755-758:
//         bones on radiographs of 66 adults from 19 to 78 years. All 19 means and SDs were compared with a
//         second text that cites them to a tenth of a millimetre.
// [OWN]   Our own bounds without a published number; each states its reason.

constexpr std::array<Norm, 2> kHandLength = {
    {{"men", 193.8 * kMm, 9.8 * kMm}, {"women", 180.5 * kMm, 9.7 * kMm}}};
constexpr std::array<Norm, 2> kHandBreadth = {
    {{"men", 90.4 * kMm, 4.2 * kMm}, {"women", 79.4 * kMm, 3.8 * kMm}}};
constexpr std::string_view kAnsur = "Gordon et al. 1989, men and women";
constexpr std::string_view kBuryanov = "Buryanov & Kotiuk 2010";
constexpr std::string_view kOwn = "our own bounds, no published spread";

struct Millimetres {
  double mean;
  double sd;
};
// [BK] In the order of the segments. Thumb: metacarpal, proximal, distal. Fingers: proximal, middle, distal.
constexpr std::array<Millimetres, kSegments - 1> kSegmentLength = {{
    {46.22, 3.94},
    {31.57, 3.13},
    {21.67, 1.60},  // thumb
    {39.78, 4.94},
    {22.38, 2.51},
    {15.82, 2.26},  // index
    {44.63, 3.81},
    {26.33, 3.00},
    {17.40, 1.85},  // middle
    {41.37, 3.87},
    {25.65, 3.29},
    {17.30, 2.22},  // ring
    {32.74, 2.77},
    {18.11, 2.54},
    {15.96, 2.45},  // little
}};
constexpr std::array<Millimetres, kDigits> kMetacarpalLength = {
    {{46.22, 3.94}, {68.12, 6.27}, {64.60, 5.38}, {58.00, 5.06}, {53.69, 4.36}}};

struct Degrees {
  double min;
  double max;
};
// [OWN] Wide enough for hypermobile, contracted and deformed joints (swan neck, boutonniere, Z thumb). An
// angle beyond them has a wrong sign or unit. assets/hands/adult.toml holds typical ranges, from AAOS
// 1965 and Eaton.
constexpr std::array<Degrees, kJointsPerDigit> kThumbAngles = {
    {{-60, 80}, {-60, 80}, {-60, 100}, {-90, 110}}};
constexpr std::array<Degrees, kJointsPerDigit> kFingerAngles = {
    {{-90, 120}, {-50, 50}, {-45, 130}, {-45, 110}}};

PlausibleRange around(std::span<const Norm> norms, std::string_view source) noexcept {
  PlausibleRange range{norms.front().mean, norms.front().mean, source};
  for (const Norm& norm : norms) {
    range.min = std::min(range.min, norm.mean - kPlausibleDeviations * norm.sd);
    range.max = std::max(range.max, norm.mean + kPlausibleDeviations * norm.sd);
  }
  return range;
}

Norm in_metres(const Millimetres& length) noexcept { return {"adults", length.mean * kMm, length.sd * kMm}; }

}  // namespace

std::span<const Norm> hand_length_norms() noexcept { return kHandLength; }
std::span<const Norm> hand_breadth_norms() noexcept { return kHandBreadth; }

Norm segment_length_norm(int segment) noexcept {
  return in_metres(kSegmentLength[static_cast<std::size_t>(segment)]);
}

Norm metacarpal_length_norm(int digit) noexcept {
  return in_metres(kMetacarpalLength[static_cast<std::size_t>(digit)]);
}

PlausibleRange plausible_hand_length() noexcept { return around(kHandLength, kAnsur); }
PlausibleRange plausible_hand_breadth() noexcept { return around(kHandBreadth, kAnsur); }

PlausibleRange plausible_segment_length(int segment) noexcept {
  const Norm norm = segment_length_norm(segment);
  return around(std::span<const Norm>(&norm, 1), kBuryanov);
}

PlausibleRange plausible_palm_ratio() noexcept {
  const Norm norm = metacarpal_length_norm(static_cast<int>(Digit::kMiddle));
  const PlausibleRange range = around(std::span<const Norm>(&norm, 1), kBuryanov);
  return {range.min / norm.mean, range.max / norm.mean, kBuryanov};
}

// [OWN] From a child's finger to a swollen one.
PlausibleRange plausible_breadth_ratio() noexcept { return {0.6, 1.6, kOwn}; }

PlausibleRange plausible_angle(int joint) noexcept {
  const auto i = static_cast<std::size_t>(joint % kJointsPerDigit);
  const Degrees& range = digit_of_joint(joint) == 0 ? kThumbAngles[i] : kFingerAngles[i];
  return {range.min * kDeg, range.max * kDeg, kOwn};
}

}  // namespace phalanx
