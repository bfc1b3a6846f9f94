// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/sent_stiffness.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "phalanx/core/index.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

constexpr int kFewestSamples = 20;
constexpr double kTolerance = 0.1;       ///< of the commanded stiffness
constexpr double kMostOutside = 0.2;     ///< share of the samples
constexpr double kFullFactor = 0.99999;  ///< of the station's ramps

}  // namespace

SentStiffness::SentStiffness(double commanded, const std::array<bool, kDigits>& digits)
    : commanded_(commanded), digits_(digits) {}

void SentStiffness::add(const Observation& observation) {
  if (observation.fault != ObservationFault::kNone) fault_ = true;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!observation.touching[idx(digit)]) continue;
    const double sent = observation.sent_stiffness[idx(digit)];
    if (!std::isfinite(sent) || sent < 0.0) continue;
    if (!observation.torque_on || observation.factor < kFullFactor) ramped_ = true;
    sum_ += sent;
    ++count_;
    if (!(std::abs(sent - commanded_) <= kTolerance * commanded_)) ++outside_;
    if (!digits_[idx(digit)]) continue;
    ++own_;
    const double depth = observation.depth[idx(digit)];
    if (depth > deepest_) deepest_ = depth;
  }
}

double SentStiffness::mean() const noexcept {
  return count_ > 0 ? sum_ / count_ : std::numeric_limits<double>::quiet_NaN();
}

bool SentStiffness::differs() const noexcept { return outside_ > kMostOutside * count_; }

std::string SentStiffness::reason() const {
  if (fault_) return reason_text<Reason::kPressFault>();
  if (ramped_) return reason_text<Reason::kPressRamped>();
  if (own_ < kFewestSamples) {
    return reason_text<Reason::kPressTooShort>(own_, kFewestSamples);
  }
  if (differs()) {
    return reason_text<Reason::kPressTooFast>(100.0 * outside_ / count_);
  }
  return {};
}

}  // namespace phalanx
