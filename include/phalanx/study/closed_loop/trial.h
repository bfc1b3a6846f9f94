// SPDX-License-Identifier: Apache-2.0
// One trial of the closed loop on a scene: a seeded press, a bump, a window, a release.
#pragma once

#include <functional>
#include <memory>

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/patient.h"
#include "phalanx/device/plant.h"
#include "phalanx/device/press_intent.h"
#include "phalanx/device/press_plan.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"
#include "phalanx/study/closed_loop/stability_criterion.h"

namespace phalanx {

class SimulatedExoskeleton;

/// Everything of a trial that does not depend on its seed. Constant: any number of threads may run trials on
/// it.
struct TrialSetup {
  HapticModel model;
  Exoskeleton exoskeleton;
  PatientParameters patient;
  PressPlan plan;
  TrialSchedule schedule;
  double step = Plant::kDefaultStep;  ///< of the integration [s]
};

/// @throws SceneError or std::invalid_argument if scene, device or patient cannot be loaded or nothing is
/// met. Set-up only.
[[nodiscard]] std::shared_ptr<const TrialSetup> make_trial_setup(const SceneDescription& scene);

using TickObserver = std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>;

/// @param stiffness  of the wall [N/m]; NaN: the scene's
/// @param press      force each digit is meant to reach [N]; NaN: the patient's
/// @param observer   after each step of the host; may be empty
/// Same arguments, same bits; safe to call from several threads. Not real-time.
[[nodiscard]] TrialResult run_trial(const TrialSetup& setup, double stiffness, double press,
                                    std::uint64_t seed, const TickObserver& observer = {});

/// Trials of `scene` (a name or a path) for a study. Set-ups are kept for the overrides used last.
[[nodiscard]] TrialFunction make_trial_function(const std::string& scene);

}  // namespace phalanx
