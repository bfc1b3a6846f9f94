// SPDX-License-Identifier: Apache-2.0
// ticks.csv: one row a tick with all results of the step, except poses and contact points. docs/outputs.md describes
// columns and units.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/record/output_file.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// @returns a segment's name in a column's: "index_finger_phalanx_distal". A reader that turns columns into
/// names of a programming language, such as numpy.genfromtxt(names=True), leaves it unchanged.
[[nodiscard]] std::string segment_column(int segment);

/// @returns the header line without its line feed: `tick,time_s`, 20 `<joint>_hcp_rad`, 20 `<joint>_gdp_rad`,
/// 20 `<joint>_torque_nm`. Then per segment `_contact _depth_m _force_raw_n _force_n _px_m _py_m _pz_m _nx
/// _ny _nz _slid_m _force_tx_n _force_ty_n _force_tz_n _slip _slip_mm_per_s _spin_nm`, in the order of
/// joint_name() and segment_column().
[[nodiscard]] std::string ticks_csv_header();

/// File of the ticks. It holds no wall-clock time, so that equal motions give equal files, bit for bit. Not
/// real-time. @throws as OutputFile.
class TicksCsv {
 public:
  /// Writes the header.
  explicit TicksCsv(const std::filesystem::path& file);
  void write(const Snapshot& snapshot);
  /// Renames the file to its name.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace phalanx
