// SPDX-License-Identifier: Apache-2.0
// Charts of a study: curves, heat maps, bars and stability maps, as its dimensions require.
#pragma once

#include <string>
#include <vector>

#include "figures/html.h"
#include "study/report/study_view.h"

namespace phalanx {

/// Adds the chapters with charts of the results, and states in words what was left out.
void add_result_pictures(HtmlPage& page, const StudyView& view);

/// Adds a map for each slice along the main axis (or, without one, the last dimension). It shows the
/// stiffnesses that were tried, with their verdicts. Without a stiffness grid, it adds nothing.
void add_verdict_maps(HtmlPage& page, const StudyView& view);

}  // namespace phalanx
