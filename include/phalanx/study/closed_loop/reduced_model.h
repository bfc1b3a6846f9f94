// SPDX-License-Identifier: Apache-2.0
// The index finger on a wall as one coordinate: what the free parameter is fitted on.
#pragma once

#include "phalanx/device/exoskeleton.h"
#include "phalanx/device/patient.h"
#include "phalanx/device/press_intent.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/study/laboratory/trial.h"

namespace phalanx {

/// Device and finger as felt at the fingertip along the press: one joint whose coordinate is the way x into
/// the wall [m] instead of an angle, one motor with the lever arm -1.
struct ReducedModel {
  Exoskeleton exoskeleton;
  PatientParameters patient;
  double rate_hz = 200.0;   ///< of the host [Hz]
  double force_cap = 10.0;  ///< on the wall's force [N]
};

/// The numbers of the table in docs/device-file.md, "The shipped devices". `patient.bump` is the table's 2 N;
/// the fit replaces it.
[[nodiscard]] ReducedModel make_reduced_model();

/// A press of one seed on a wall F = k x with S2's smoothing, judged by the same criterion as a trial on a
/// scene.
/// @param stiffness  [N/m] > 0
/// Deterministic; safe from several threads. Not real-time.
[[nodiscard]] TrialResult run_reduced_trial(const ReducedModel& model, const SmoothingParameters& smoothing,
                                            double stiffness, std::uint64_t seed);

}  // namespace phalanx
