// SPDX-License-Identifier: Apache-2.0
// Which pictures a study gets: curves, heat maps, bars and stability maps, as its dimensions ask for.
#pragma once

#include <string>
#include <vector>

#include "study/report/html.h"
#include "study/report/study_view.h"

namespace phalanx {

/// Adds the chapters with pictures of the results, and says in words what was left out.
void add_result_pictures(HtmlPage& page, const StudyView& view);

/// Adds a map for each slice along the main axis (or, without one, the last dimension): which stiffness was
/// tried and what came of it. Nothing if the study has no stiffness grid.
void add_verdict_maps(HtmlPage& page, const StudyView& view);

}  // namespace phalanx
