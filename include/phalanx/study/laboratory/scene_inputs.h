// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "phalanx/study/laboratory/run_study.h"
#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Makes a check that loads the study's scene, its device and its patient with a point's overrides. Its
/// inputs are the parameters of device and patient, and the files of scene, hand, collision meshes, profile,
/// motion, mapping and objects.
[[nodiscard]] StudyCheck scene_check(const Study& study);

}  // namespace phalanx
