// SPDX-License-Identifier: Apache-2.0
// Measuring one point of a study.
#pragma once

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Searches the limit (if the study has a grid) and measures there, or at the scene's stiffness. The seeds of
/// one stiffness run in parallel on the threads of the calling oneTBB arena, in batches of 1, 1, 2, 4, 8 ..
/// seeds. They stop after the batch in which a seed is not stable. The trials that run, and so the result,
/// therefore do not depend on the number of threads. Not real-time.
/// @throws the exception of the first seed, in order, that throws
[[nodiscard]] PointResult measure_point(const Study& study, int index, const TrialFunction& trial);

}  // namespace phalanx
