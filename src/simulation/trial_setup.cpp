// SPDX-License-Identifier: Apache-2.0
#include "phalanx/simulation/trial_setup.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

/// Refuses a bump that reaches into the window. @throws std::invalid_argument
void refuse_bump_in_window(const PatientParameters& patient, const TrialSchedule& schedule) {
  const double end = patient.bump_start + patient.bump_duration;
  if (patient.bump == 0.0 || end <= schedule.window_begin) return;
  throw std::invalid_argument(
      fmt::format("patient: the bump from {} to {} s reaches into the window from {} s on in which a trial "
                  "is judged; let "
                  "it end before",
                  patient.bump_start, end, schedule.window_begin));
}

}  // namespace

TrialSetup make_trial_setup(HapticModel model, const HapticParameters& parameters,
                            const Exoskeleton& exoskeleton, const PatientParameters& patient,
                            const Motion& motion) {
  const TrialSchedule schedule;
  refuse_bump_in_window(patient, schedule);
  PressPlan plan = plan_press(model, parameters, motion, exoskeleton, patient);
  return {.model = std::move(model),
          .parameters = parameters,
          .exoskeleton = exoskeleton,
          .patient = patient,
          .plan = std::move(plan),
          .schedule = schedule};
}

}  // namespace phalanx
