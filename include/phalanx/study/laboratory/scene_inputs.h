// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Checks a point by loading the study's scene, its device and its patient with the point's overrides. What
/// the point depends on: the numbers of device and patient, and the files of scene, hand, its collision
/// meshes, profile, motion, mapping and objects.
[[nodiscard]] StudyCheck scene_check(const Study& study);

}  // namespace phalanx
