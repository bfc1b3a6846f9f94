// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/scored_steps.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace phalanx {
namespace {

std::string_view reason(ObservationFault fault) noexcept {
  switch (fault) {
    case ObservationFault::kNone:
      return "";
    case ObservationFault::kNoSample:
      return "the device sent no sample";
    case ObservationFault::kFault:
      return "the station was in a fault, or the device was lost";
    case ObservationFault::kGap:
      return "steps are missing before";
    case ObservationFault::kNotFinite:
      return "an angle, force or time was not a finite number";
  }
  return "the step has an unknown fault";
}

}  // namespace

std::string why_not_scored(std::span<const Observation> steps) {
  if (steps.size() < 2)
    return fmt::format("not scored: the trial has {} steps; two are needed at least", steps.size());
  double last = -1.0;
  bool first = true;
  for (const Observation& step : steps) {
    if (step.fault == ObservationFault::kGap)
      return fmt::format("not scored: steps are missing before {:.3f} s; repeat the trial", step.time);
    if (step.fault != ObservationFault::kNone)
      return fmt::format("not scored: {} at {:.3f} s; repeat the trial", reason(step.fault), step.time);
    if (!std::isfinite(step.time)) return "not scored: a time is not a finite number; repeat the trial";
    if (!first && step.time <= last)
      return fmt::format("not scored: time does not increase at {:.3f} s; repeat the trial", step.time);
    last = step.time;
    first = false;
  }
  if (last - steps.front().time > kLongestTrial)
    return fmt::format("not scored: the trial lasts {:.0f} s; {:.0f} s are allowed at most",
                       last - steps.front().time, kLongestTrial);
  return {};
}

}  // namespace phalanx
