// SPDX-License-Identifier: Apache-2.0
// Everything that is measured at one point of a study.
#pragma once

#include "phalanx/study/laboratory/study.h"
#include "phalanx/study/laboratory/trial.h"

namespace phalanx {

/// Searches the limit (if the study has a grid) and measures there, or at the scene's stiffness. The seeds of
/// one stiffness run side by side on the threads of the calling oneTBB arena, in batches of 1, 1, 2, 4, 8 ..
/// seeds, and stop after the batch in which one is not stable: what is run, and so the result, does not
/// depend on the number of threads.
/// @throws what the first seed in order throws that does. Not real-time.
[[nodiscard]] PointResult measure_point(const Study& study, int index, const TrialFunction& trial);

}  // namespace phalanx
