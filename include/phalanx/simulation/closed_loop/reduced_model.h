// SPDX-License-Identifier: Apache-2.0
// The index finger on a wall as a model with one coordinate, on which the free parameter is fitted.
#pragma once

#include "phalanx/device/exoskeleton.h"
#include "phalanx/force/stabiliser.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/press_intent.h"

namespace phalanx {

/// Device and finger, reduced to the fingertip's motion along the press. The only joint has the way x into
/// the wall [m] as its coordinate, instead of an angle. The only motor has the lever arm -1.
struct ReducedModel {
  Exoskeleton exoskeleton;
  PatientParameters patient;
  double rate_hz = 200.0;   ///< rate of the host [Hz]
  double force_cap = 10.0;  ///< upper bound of the wall's force [N]
};

/// Makes the model with the values of the table in docs/device-file.md, "The shipped devices". `patient.bump`
/// is the table's 2 N; the fit replaces it.
[[nodiscard]] ReducedModel make_reduced_model();

/// Runs a press of one seed on a wall F = k x. The criterion is that of a trial on a scene.
/// @param stabiliser  of the method kSmoothing or kNone
/// @param stiffness   [N/m] > 0
/// Deterministic; safe from several threads. Not real-time.
[[nodiscard]] TrialResult run_reduced_trial(const ReducedModel& model, const StabiliserParameters& stabiliser,
                                            double stiffness, std::uint64_t seed);

}  // namespace phalanx
