// SPDX-License-Identifier: Apache-2.0
#include "phalanx/exercise/scored_steps.h"

#include <cmath>

#include "phalanx/exercise/reasons.h"

namespace phalanx {
namespace {

std::string reason(ObservationFault fault) {
  switch (fault) {
    case ObservationFault::kNone:
      return {};
    case ObservationFault::kNoSample:
      return reason_text<Reason::kNoSample>();
    case ObservationFault::kFault:
      return reason_text<Reason::kStationFault>();
    case ObservationFault::kGap:
      return reason_text<Reason::kStepsMissingBeforeIt>();
    case ObservationFault::kNotFinite:
      return reason_text<Reason::kObservationNotFinite>();
  }
  return reason_text<Reason::kUnknownStepFault>();
}

}  // namespace

std::string why_not_scored(std::span<const Observation> steps) {
  if (steps.size() < 2) return reason_text<Reason::kTooFewSteps>(steps.size());
  double last = -1.0;
  bool first = true;
  for (const Observation& step : steps) {
    if (step.fault == ObservationFault::kGap) return reason_text<Reason::kStepsMissingBefore>(step.time);
    if (step.fault != ObservationFault::kNone)
      return reason_text<Reason::kStepFaultAt>(reason(step.fault), step.time);
    if (!std::isfinite(step.time)) return reason_text<Reason::kTimeNotFinite>();
    if (!first && step.time <= last) return reason_text<Reason::kTimeNotIncreasing>(step.time);
    last = step.time;
    first = false;
  }
  if (last - steps.front().time > kLongestTrial)
    return reason_text<Reason::kTrialTooLong>(last - steps.front().time, kLongestTrial);
  return {};
}

}  // namespace phalanx
