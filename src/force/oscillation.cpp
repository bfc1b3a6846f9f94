// SPDX-License-Identifier: Apache-2.0
#include "phalanx/force/oscillation.h"

#include <algorithm>
#include <cmath>

namespace phalanx {
namespace {

constexpr double kShortest = 4e-3;     // half-swing [s]
constexpr double kLongest = 0.26;      // half-swing [s]
constexpr double kThreeQuick = 0.24;   // three half-swings [s]
constexpr double kClearsAfter = 0.5;   // [s]
constexpr double kRamp = 0.2;          // [s]
constexpr double kHalvesEvery = 0.5;   // [s]
constexpr double kSmallest = 0x1p-10;  // least value of StiffnessFactor
constexpr double kGoesOn = 0.5;        // least size of the last half-swing over the first of the row
constexpr int kQuickLegs = 4;
constexpr int kLegs = 6;

}  // namespace

void OscillationObserver::forget_row(double force) noexcept {
  leg_ = Leg::kEither;
  legs_ = 0;
  low_ = force;
  high_ = force;
}

bool OscillationObserver::count(Leg leg, double force) noexcept {
  last_swing_ = high_ - low_;  // size of the leg that ends here
  (leg == Leg::kRising ? high_ : low_) = force;
  leg_ = leg;
  if (legs_ > 0 && since_ >= kShortest) {
    std::copy_backward(half_swing_.begin(), half_swing_.end() - 1, half_swing_.end());
    half_swing_[0] = since_;
    std::copy_backward(swing_.begin(), swing_.end() - 1, swing_.end());
    swing_[0] = last_swing_;
    legs_ = std::min(legs_ + 1, kLegs);
  } else {
    legs_ = 1;
  }
  since_ = 0.0;
  const bool quick = legs_ >= kQuickLegs && half_swing_[0] + half_swing_[1] + half_swing_[2] <= kThreeQuick &&
                     swing_[0] >= kGoesOn * swing_[2];
  const bool slow = legs_ >= kLegs && swing_[0] >= kGoesOn * swing_[4];
  if (!quick && !slow) return false;
  oscillating_ = true;
  double sum = 0.0;
  for (int i = 0; i < legs_ - 1; ++i) sum += half_swing_[static_cast<std::size_t>(i)];
  frequency_ = 0.5 * (legs_ - 1) / sum;
  return true;
}

bool OscillationObserver::watch(double force, double swing, double period) noexcept {
  const double now = std::isfinite(force) ? std::max(0.0, force) : 0.0;
  if (legs_ > 0 || oscillating_) since_ += period;
  if (legs_ > 0 && since_ > kLongest) forget_row(now);
  if (since_ > kClearsAfter) oscillating_ = false;

  if (leg_ != Leg::kFalling) high_ = std::max(high_, now);
  if (leg_ != Leg::kRising) low_ = std::min(low_, now);
  const bool falls = leg_ != Leg::kFalling && high_ - now > swing;
  const bool rises = leg_ != Leg::kRising && now - low_ > swing;
  if (!falls && !rises) {
    if (leg_ == Leg::kEither && now == 0.0) high_ = 0.0;  // no later fall can count from there
    return false;
  }
  return count(falls ? Leg::kFalling : Leg::kRising, now);
}

void StiffnessFactor::advance(bool swings, double period) noexcept {
  waiting_ = std::max(0.0, waiting_ - period);
  if (swings && waiting_ == 0.0 && target_ > kSmallest) {
    target_ *= 0.5;
    rate_ = (value_ - target_) / kRamp;
    waiting_ = kHalvesEvery;
  }
  value_ = std::max(target_, value_ - rate_ * period);
}

}  // namespace phalanx
