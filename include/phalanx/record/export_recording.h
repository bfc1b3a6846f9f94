// SPDX-License-Identifier: Apache-2.0
// A recording in the file formats of other programs. docs/recording.md describes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/record/recording_keys.h"

namespace phalanx {

/// File formats of export_recording().
enum class ExportFormat {
  kCsv,     ///< a folder with a CSV file for each table
  kHdf5,    ///< one file, a group for each table
  kMatlab,  ///< one .mat file of version 7, a struct for each table
  kRos2,    ///< a folder: a ROS 2 bag with an MCAP file
  kBids,    ///< a folder: a data set of the Brain Imaging Data Structure with the modality motion
};

/// Name of a format, as it is typed.
struct ExportFormatName {
  ExportFormat format;
  const char* name;     ///< "csv"
  const char* ending;   ///< of the target: ".h5"; empty: a folder
  const char* meaning;  ///< one line
};
[[nodiscard]] const std::vector<ExportFormatName>& export_formats();
/// @throws std::invalid_argument for an unknown name; what() states those that are known
[[nodiscard]] const ExportFormatName& export_format(std::string_view name);

/// Part of an export that can be chosen: a table, a topic of a bag, a recording of a data set.
struct ExportPart {
  std::string name;
  std::string meaning;  ///< one line
};
/// @returns the parts of a format
[[nodiscard]] std::vector<ExportPart> export_parts(ExportFormat format);

/// What of a recording to export.
struct ExportOptions {
  ExportFormat format = ExportFormat::kCsv;
  std::vector<std::string> parts;  ///< names of export_parts(); empty: all
  /// Columns of tables, for kCsv, kHdf5 and kMatlab: "torque" is all joints', "torque_nm_index_pip_flexion" is one, as in the
  /// head of a CSV file. A table keeps its time, station and tick; tables without any of the columns are left out. Empty:
  /// all.
  std::vector<std::string> columns;
  double from = 0.0;                                    ///< since the beginning of the recording [s]
  double to = std::numeric_limits<double>::infinity();  ///< exclusive [s]
  std::string subject = "01";  ///< label of the person, for kBids: letters and digits
  std::string task;  ///< label of the task, for kBids: letters and digits; empty: the name of the scene
};

/// What was written.
struct ExportedPart {
  std::filesystem::path file;
  std::string part;
  std::uint64_t rows = 0;  ///< or messages
};

/// Writes a recording in another format. Numbers have double precision: in CSV files, the shortest decimals that read back to the
/// same bits; in BIDS tables, six decimals. If it fails, nothing is left of the target.
/// @param target  a folder or file (ExportFormatName::ending) that does not exist yet
/// @param on_progress  as replay()
/// @param keys  of encrypted recordings; may be empty. What is written is not encrypted
/// @throws std::invalid_argument for an unknown part or column, a range without any time, a target that exists, or a table that
/// is too large for the format; std::runtime_error if the recording is not whole or the disk refuses. what() names the remedy.
/// Not real-time.
std::vector<ExportedPart> export_recording(const std::filesystem::path& recording,
                                           const std::filesystem::path& target, const ExportOptions& options,
                                           const std::function<void(double)>& on_progress = {},
                                           const FindRecordingKey& keys = {});

}  // namespace phalanx
