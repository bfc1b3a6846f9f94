// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/press_intent.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "phalanx/core/random.h"

namespace phalanx {
namespace {

/// @returns the distance before the contact, along the press, within which no joint leaves its range [m].
double room_before(const DigitPress& press, const HandParameters& hand) {
  double room = PressIntent::kApproach;
  for (std::size_t j = 0; j < press.into.size(); ++j) {
    if (press.into[j] == 0.0) continue;
    const double limit = press.into[j] > 0.0 ? hand.min_angle[j] : hand.max_angle[j];
    room = std::min(room, std::max(0.0, (press.contact[j] - limit) / press.into[j]));
  }
  return room;
}

}  // namespace

PressIntent::PressIntent(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand,
                         double wall, double press, std::uint64_t seed, const TrialSchedule& schedule)
    : plan_(plan), patient_(patient), schedule_(schedule) {
  Random random(seed);
  for (std::size_t d = 0; d < digit_.size(); ++d) {
    if (!plan.digit[d]) continue;
    Digit& digit = digit_[d];
    digit.press = &*plan.digit[d];
    digit.approach = room_before(*digit.press, hand);
    digit.force = press * random.between(1.0 - patient.press_spread, 1.0 + patient.press_spread);
    digit.end = digit.force * (1.0 / digit.press->stiffness + 1.0 / wall);
    digit.speed = random.between(patient.approach_min, patient.approach_max);
    for (Wave& wave : digit.tremor) {
      wave.frequency = random.between(patient.tremor_min_hz, patient.tremor_max_hz);
      wave.phase = random.between(0.0, 2.0 * std::numbers::pi);
    }
  }
}

double PressIntent::way(const Digit& digit, double t) const noexcept {
  const double coming =
      std::min(digit.end, -digit.approach + digit.speed * std::max(0.0, t - schedule_.start));
  const double going = digit.end - schedule_.release_speed * (t - schedule_.release);
  double x = t < schedule_.release ? coming : std::max(-digit.approach, std::min(coming, going));
  for (const Wave& wave : digit.tremor) {
    x += patient_.tremor / static_cast<double>(kWaves) *
         std::sin(2.0 * std::numbers::pi * wave.frequency * t + wave.phase);
  }
  return x;
}

double PressIntent::arrival() const noexcept {
  double latest = schedule_.start;
  for (const Digit& digit : digit_) {
    if (digit.press != nullptr)
      latest = std::max(latest, schedule_.start + (digit.approach + digit.end) / digit.speed);
  }
  return latest;
}

JointArray PressIntent::angle(double t) const noexcept {
  JointArray out = plan_.open;
  for (std::size_t d = 0; d < digit_.size(); ++d) {
    const Digit& digit = digit_[d];
    if (digit.press == nullptr) continue;
    const double x = way(digit, t);
    for (std::size_t j = d * kJointsPerDigit; j < (d + 1) * kJointsPerDigit; ++j)
      out[j] = digit.press->contact[j] + digit.press->into[j] * x;
  }
  return out;
}

JointArray PressIntent::push(double t) const noexcept {
  JointArray out{};
  if (t < patient_.bump_start || t >= patient_.bump_start + patient_.bump_duration) return out;
  for (const Digit& digit : digit_) {
    if (digit.press == nullptr) continue;
    for (std::size_t j = 0; j < out.size(); ++j) out[j] -= digit.press->g[j] * patient_.bump;
  }
  return out;
}

}  // namespace phalanx
