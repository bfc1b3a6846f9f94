// SPDX-License-Identifier: Apache-2.0
// One trial of the closed loop: a seeded press, a bump, a window, a release.
#pragma once

#include <cstdint>
#include <functional>

#include "phalanx/simulation/closed_loop/stability_criterion.h"
#include "phalanx/simulation/simulated_exoskeleton.h"
#include "phalanx/simulation/trial_setup.h"

namespace phalanx {

/// Callback after each step of the host, at time t [s].
using TickObserver = std::function<void(double t, const Snapshot&, const SimulatedExoskeleton&)>;

/// Runs one trial.
/// @param stiffness  stiffness of the wall [N/m], finite and > 0; NaN: that of the set-up
/// @param press      intended force of each digit [N], finite and >= 0; NaN: the patient's
/// @param observer   called after each step of the host; may be empty
/// @throws std::invalid_argument if `stiffness` or `press` is out of its range, and as HapticState and
/// SimulatedExoskeleton; and what the observer throws
/// Equal arguments give equal bits; safe to call from several threads. Not real-time.
[[nodiscard]] TrialResult run_trial(const TrialSetup& setup, double stiffness, double press,
                                    std::uint64_t seed, const TickObserver& observer = {});

}  // namespace phalanx
