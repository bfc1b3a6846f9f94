// SPDX-License-Identifier: Apache-2.0
// What a station writes down: its steps, and the last two seconds before a fault. docs/outputs.md has the
// columns.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

#include "phalanx/record/output_file.h"
#include "phalanx/station/session_statistics.h"

namespace phalanx {

/// Header line and one line a step.
void write_step_header(OutputFile& file);
void write_step(OutputFile& file, const StepRecord& record);

/// report.json (what, where, when, device, link), samples.csv (raw counts) and steps.csv in a new folder
/// below `folder`, named by `now` (local date and time) and the fault; where that is taken, with -2, -3, ...
/// @returns the folder. @throws std::runtime_error or std::invalid_argument as OutputFile. Not real-time.
std::filesystem::path write_fault_report(const std::filesystem::path& folder, const FaultReport& report,
                                         std::time_t now = std::time(nullptr));

/// Percentiles, overruns, link and grant of a whole session as JSON.
/// @param last  how it ended. @param seconds  its length [s]
[[nodiscard]] std::string station_summary_json(const SessionStatistics& session, const StationView& last,
                                               const std::string& granted, double seconds);

}  // namespace phalanx
