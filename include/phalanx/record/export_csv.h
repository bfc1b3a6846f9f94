// SPDX-License-Identifier: Apache-2.0
// A recording as tables of numbers, for other programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace phalanx {

/// The tables that a recording can be exported as.
struct ExportTable {
  const char* name;     ///< "steps": writes steps.csv
  const char* meaning;  ///< one line
};
[[nodiscard]] const std::vector<ExportTable>& export_tables();

/// Part of a recording to export.
struct ExportOptions {
  std::vector<std::string> tables;                      ///< names of export_tables(); empty: all
  double from = 0.0;                                    ///< since the beginning of the recording [s]
  double to = std::numeric_limits<double>::infinity();  ///< exclusive [s]
};

/// What was written.
struct ExportedFile {
  std::filesystem::path file;
  std::uint64_t rows = 0;
};

/// Writes CSV files, a table each, into a folder that does not exist yet. The first line of a file names each column with its
/// unit. Numbers are the shortest decimals that read back to the same bits.
/// @param on_progress  as replay()
/// @throws std::invalid_argument for an unknown table, a range without any time, or a folder that exists; std::runtime_error if
/// the recording is not whole or the disk refuses
std::vector<ExportedFile> export_csv(const std::filesystem::path& recording,
                                     const std::filesystem::path& folder, const ExportOptions& options,
                                     const std::function<void(double)>& on_progress = {});

}  // namespace phalanx
