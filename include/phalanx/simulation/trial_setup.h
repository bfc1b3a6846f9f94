// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/motion.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/plant.h"
#include "phalanx/simulation/press_intent.h"
#include "phalanx/simulation/press_plan.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// All parts of a trial that do not depend on its seed. Constant: any number of threads may run trials on it.
struct TrialSetup {
  HapticModel model;
  HapticParameters parameters;
  Exoskeleton exoskeleton;
  PatientParameters patient;
  PressPlan plan;
  TrialSchedule schedule;
  double step = Plant::kDefaultStep;  ///< integration step [s]
};

/// Makes the set-up, and plans the press where `motion` first meets the object: plan_press().
/// @throws std::invalid_argument as plan_press(), or if the patient's bump reaches into the schedule's window.
/// Set-up only.
[[nodiscard]] TrialSetup make_trial_setup(HapticModel model, const HapticParameters& parameters,
                                          const Exoskeleton& exoskeleton, const PatientParameters& patient,
                                          const Motion& motion);

}  // namespace phalanx
