// SPDX-License-Identifier: Apache-2.0
// The files of a station: its steps, and the last two seconds before a fault. docs/outputs.md
// describes the columns.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

#include "phalanx/record/output_file.h"
#include "phalanx/station/session_statistics.h"

namespace phalanx {

/// Writes the header line.
void write_step_header(OutputFile& file);
/// Writes one step as a line.
void write_step(OutputFile& file, const StepRecord& record);

/// Writes a fault report into a new folder below `folder`: report.json (fault, time, device, link),
/// samples.csv (raw counts) and steps.csv. The folder is named by `now` (local date and time) and the fault;
/// if it exists, -2, -3, ... is added. Not real-time.
/// @returns the folder. @throws std::runtime_error or std::invalid_argument as OutputFile.
std::filesystem::path write_fault_report(const std::filesystem::path& folder, const FaultReport& report,
                                         std::time_t now = std::time(nullptr));

/// Writes percentiles, overruns, link and grant of a whole session as JSON.
/// @param last  the last view. @param seconds  the session's length [s]
[[nodiscard]] std::string station_summary_json(const SessionStatistics& session, const StationView& last,
                                               const std::string& granted, double seconds);

}  // namespace phalanx
