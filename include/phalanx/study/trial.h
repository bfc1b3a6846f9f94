// SPDX-License-Identifier: Apache-2.0
// One trial of the closed loop on a scene: a seeded press, a bump, a window, a release.
#pragma once

#include <functional>
#include <memory>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/scene/scene.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/plant.h"
#include "phalanx/simulation/press_intent.h"
#include "phalanx/simulation/press_plan.h"
#include "phalanx/step/haptic_step.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

class SimulatedExoskeleton;

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

/// Makes the set-up of a scene.
/// @throws SceneError or std::invalid_argument if scene, device or patient cannot be loaded, or no digit
/// meets the object. Set-up only.
[[nodiscard]] std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene);

/// Callback after each step of the host, at time t [s].
using TickObserver = std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>;

/// Runs one trial.
/// @param stiffness  stiffness of the wall [N/m]; NaN: the scene's
/// @param press      intended force of each digit [N]; NaN: the patient's
/// @param observer   called after each step of the host; may be empty
/// Equal arguments give equal bits; safe to call from several threads. Not real-time.
[[nodiscard]] TrialResult run_trial(const TrialSetup& setup, double stiffness, double press,
                                    std::uint64_t seed, const TickObserver& observer = {});

/// Makes the trial function of `scene` (a name or a path) for a study. It keeps the last few set-ups.
[[nodiscard]] TrialFunction make_trial_function(const std::string& scene);

}  // namespace phalanx
