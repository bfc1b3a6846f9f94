// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "phalanx/record/recordings.h"

namespace phalanx {

/// Draws a recording as an HTML page with one figure: the forces of the digits over time with numbered events, and the
/// events as a table. Of more than 30 events the figure numbers the first 30; the table has all, up to 500. Not real-time.
[[nodiscard]] std::string recording_page_html(const RecordingSummary& summary,
                                              const RecordingContent& content);

}  // namespace phalanx
