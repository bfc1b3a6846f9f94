// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/fit.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr auto kMiddleDigit = static_cast<std::size_t>(Digit::kMiddle);

/// Returns the D-H row of the segment's own bone.
const DhRow& row_of(const HandParameters& parameters, int segment) noexcept {
  return parameters.digits[idx(digit_of_segment(segment))].dh[idx(segment % kSegmentsPerDigit + 1)];
}

/// Returns the length from a distal segment's joint to its soft tip [m].
double length_with_tip(const SegmentShape& shape) noexcept { return shape.length + shape.radius_tip; }

void check(const std::optional<double>& value, std::string_view what) {
  if (!value || (std::isfinite(*value) && *value > 0.0)) return;
  std::ostringstream message;
  message << what << " is " << *value << " m; it must be finite and above 0";
  throw std::invalid_argument(message.str());
}

void check(const HandSize& size) {
  check(size.hand_length, "hand length");
  check(size.hand_breadth, "hand breadth");
  for (int s = 0; s < kSegments - 1; ++s) {
    check(size.segment[idx(s)].length, std::string(segment_name(s)) + ": length");
    check(size.segment[idx(s)].breadth, std::string(segment_name(s)) + ": breadth");
  }
}

/// Returns the ratio of the whole's stated size to the base's. Without it returns the ratio of the sums of
/// the parts' sizes, if all are stated; else nothing.
template <typename Stated, typename OfBase>
std::optional<double> common_ratio(const std::optional<double>& whole, double base_whole,
                                   const Stated& stated, const OfBase& of_base) {
  if (whole) return *whole / base_whole;
  double sum = 0.0;
  double base_sum = 0.0;
  for (int s = 0; s < kSegments - 1; ++s) {
    const std::optional<double>& value = stated(s);
    if (!value) return std::nullopt;
    sum += *value;
    base_sum += of_base(s);
  }
  return sum / base_sum;
}

/// Returns the ratio of the palm's length to the base's that a hand of this length needs.
double palm_ratio(const HandParameters& base, const HandSize& size, const HandFit& fit, double ratio) {
  bool stated = false;
  for (int k = 0; k < kSegmentsPerDigit; ++k)
    stated = stated || size.segment[idx(segment_index(static_cast<int>(kMiddleDigit), k))].length.has_value();
  if (!size.hand_length || !stated) return ratio;
  const DigitParameters& middle = base.digits[kMiddleDigit];
  const int first = segment_index(static_cast<int>(kMiddleDigit), 0);
  const double finger = fit.segment[idx(first)].length * (middle.dh[0].a + middle.dh[1].a) +
                        fit.segment[idx(first + 1)].length * middle.dh[2].a +
                        fit.segment[idx(first + 2)].length * length_with_tip(base.segments[idx(first + 2)]);
  if (!(middle.base.z() < 0.0)) {
    throw std::invalid_argument("hand '" + base.name +
                                "': the middle finger's base does not lie beyond the wrist (-z); correct it");
  }
  const double palm = *size.hand_length + middle.distal.normalized().z() * finger;
  if (!(palm > 0.0)) {
    throw std::invalid_argument(
        "the stated segments of the middle finger are longer than the hand; correct them or the hand length");
  }
  return palm / -middle.base.z();
}

void fit_breadths(HandFit& fit) {
  for (int digit = 0; digit < kDigits; ++digit) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      SegmentFit& own = fit.segment[idx(segment_index(digit, k))];
      const auto middle = [&](int i) { return fit.segment[idx(segment_index(digit, i))].breadth_middle; };
      own.breadth_base = k == 0 ? fit.palm_breadth : 0.5 * (middle(k - 1) + middle(k));
      own.breadth_end = k == kSegmentsPerDigit - 1 ? middle(k) : 0.5 * (middle(k) + middle(k + 1));
    }
  }
}

}  // namespace

double hand_length(const HandParameters& parameters) noexcept {
  const DigitParameters& middle = parameters.digits[kMiddleDigit];
  const SegmentShape& distal =
      parameters.segments[idx(segment_index(static_cast<int>(kMiddleDigit), kSegmentsPerDigit - 1))];
  const double finger = middle.dh[0].a + middle.dh[1].a + middle.dh[2].a + length_with_tip(distal);
  return -middle.base.z() - middle.distal.normalized().z() * finger;
}

double hand_breadth(const HandParameters& parameters) noexcept { return parameters.palm.knuckle_breadth; }

double segment_length(const HandParameters& parameters, int segment) noexcept {
  return row_of(parameters, segment).a;
}

double segment_breadth(const HandParameters& parameters, int segment) noexcept {
  const SegmentShape& shape = parameters.segments[idx(segment)];
  return shape.radius_base + shape.radius_tip;
}

HandFit fit_hand(const HandParameters& base, const HandSize& size) {
  check(size);
  const auto stated_length = [&](int s) -> const std::optional<double>& {
    return size.segment[idx(s)].length;
  };
  const auto stated_breadth = [&](int s) -> const std::optional<double>& {
    return size.segment[idx(s)].breadth;
  };
  const auto lengths = common_ratio(size.hand_length, hand_length(base), stated_length,
                                    [&](int s) { return segment_length(base, s); });
  const auto breadths = common_ratio(size.hand_breadth, hand_breadth(base), stated_breadth,
                                     [&](int s) { return segment_breadth(base, s); });
  const double length_ratio = lengths ? *lengths : breadths.value_or(1.0);
  const double breadth_ratio = breadths.value_or(length_ratio);
  HandFit fit;
  fit.palm_breadth = breadth_ratio;
  for (int s = 0; s < kSegments - 1; ++s) {
    SegmentFit& own = fit.segment[idx(s)];
    own.length = stated_length(s) ? *stated_length(s) / segment_length(base, s) : length_ratio;
    own.breadth_middle = stated_breadth(s) ? *stated_breadth(s) / segment_breadth(base, s) : breadth_ratio;
  }
  fit.palm_length = palm_ratio(base, size, fit, length_ratio);
  fit_breadths(fit);
  return fit;
}

HandParameters fitted_parameters(const HandParameters& base, const HandFit& fit) {
  HandParameters hand = base;
  const Vec3 palm(fit.palm_breadth, fit.palm_breadth, fit.palm_length);
  for (int digit = 0; digit < kDigits; ++digit) {
    DigitParameters& parameters = hand.digits[idx(digit)];
    parameters.base = palm.cwiseProduct(parameters.base);
    parameters.metacarpal_base = palm.cwiseProduct(parameters.metacarpal_base);
    // The knuckle's way is across the palm and stays in proportion to its breadth.
    parameters.coupling.metacarpal_per_flexion *= fit.palm_breadth / fit.palm_length;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const double ratio = fit.segment[idx(segment_index(digit, segment_in_digit_of_joint(i)))].length;
      parameters.dh[idx(i)].a *= ratio;
      parameters.dh[idx(i)].d *= ratio;
    }
  }
  for (int s = 0; s < kSegments - 1; ++s) {
    SegmentShape& shape = hand.segments[idx(s)];
    const SegmentFit& own = fit.segment[idx(s)];
    const bool distal = s % kSegmentsPerDigit == kSegmentsPerDigit - 1;
    const double whole = own.length * length_with_tip(shape);
    const double breadth = own.breadth_middle * (shape.radius_base + shape.radius_tip);
    shape.radius_base *= own.breadth_base;
    shape.radius_tip *= own.breadth_end;
    // A profile states the breadth at the middle; a capsule has only radii at its ends.
    const double middle = breadth / (shape.radius_base + shape.radius_tip);
    shape.radius_base *= middle;
    shape.radius_tip *= middle;
    shape.length = distal ? whole - shape.radius_tip : own.length * shape.length;
    if (!(shape.length > std::abs(shape.radius_base - shape.radius_tip))) {
      throw std::invalid_argument(std::string(segment_name(s)) +
                                  " is too short for its breadth; correct its length or its breadth");
    }
  }
  hand.palm.length *= fit.palm_length;
  hand.palm.wrist_breadth *= fit.palm_breadth;
  hand.palm.wrist_thickness *= fit.palm_breadth;
  hand.palm.knuckle_breadth *= fit.palm_breadth;
  hand.palm.knuckle_thickness *= fit.palm_breadth;
  hand.palm.offset = palm.cwiseProduct(hand.palm.offset);
  return hand;
}

}  // namespace phalanx
