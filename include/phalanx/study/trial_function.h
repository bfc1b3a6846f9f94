// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Makes the trial function of `scene` (a name or a path) for a study. It keeps the last few set-ups.
[[nodiscard]] TrialFunction make_trial_function(const std::string& scene);

}  // namespace phalanx
