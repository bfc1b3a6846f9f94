// SPDX-License-Identifier: Apache-2.0
// Columns of the table `observations`, which `phalanx session export` writes and tests/exercise/scores.py
// reads. docs/exercises.md ("The table of observations") lists them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "phalanx/exercise/observation.h"

namespace phalanx {

/// Columns with one name and unit: one, or one for each label.
struct ObservationColumn {
  std::string name;                      ///< "angle"
  std::string unit = {};                 ///< "rad"; empty: none
  std::vector<std::string> labels = {};  ///< "index_pip_flexion"; empty: a single column
};

/// Returns all columns in the order of append_observation(). Columns of the recording, such as the station's
/// number, precede them in a file.
[[nodiscard]] const std::vector<ObservationColumn>& observation_columns();

/// Appends the values of one step: flags as 0 or 1, ObservationFault and AngleOrigin as their numbers, NaN
/// where there is no number. Not real-time: it allocates.
void append_observation(const Observation& step, std::vector<double>& row);

}  // namespace phalanx
