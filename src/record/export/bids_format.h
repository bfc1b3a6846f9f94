// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/hand/angle_origin.h"
#include "record/export/export_table.h"

namespace phalanx {

/// What a data set states besides its tables.
struct BidsLabels {
  std::string subject;  ///< letters and digits
  std::string task;     ///< letters and digits
  std::string device;
  std::string serial;
  double rate_hz = 0.0;  ///< of the device
  AngleOrigins origin{};
  double from = 0.0;  ///< where the export begins: latencies and onsets count from there [s]
};

/// @returns the tables that become recordings of motion
[[nodiscard]] const std::vector<ExportPart>& bids_parts();

/// Writes the tables `angles` and `hand` as two tracking systems of the modality motion of the Brain Imaging Data Structure,
/// and `events`: https://bids-specification.readthedocs.io. Angles are in degrees, as its channel type JNTANG asks.
/// @param folder  exists, and is empty
/// @throws std::invalid_argument for a label with other characters than letters and digits
[[nodiscard]] std::unique_ptr<TableFormat> bids_format(const std::filesystem::path& folder,
                                                       const ExportOrigin& origin, const BidsLabels& labels);

/// @returns the letters and digits of a text, for a label; "recording" if there are none
[[nodiscard]] std::string bids_label(const std::string& text);

}  // namespace phalanx
