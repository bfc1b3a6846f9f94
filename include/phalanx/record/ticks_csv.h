// SPDX-License-Identifier: Apache-2.0
// ticks.csv: one row a tick with everything that the step said, except the poses. Columns and units:
// docs/outputs.md.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/record/output_file.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// A segment's name in a column's: "index_finger_phalanx_distal". A reader that makes names of a programming
/// language from columns, such as numpy.genfromtxt(names=True), keeps it as it is.
[[nodiscard]] std::string segment_column(int segment);

/// The header line without its line feed: `tick,time_s`, 20 `<joint>_hcp_rad`, 20 `<joint>_gdp_rad`, 20
/// `<joint>_torque_nm`, then per segment `_contact _depth_m _force_raw_n _force_n _px_m _py_m _pz_m _nx _ny
/// _nz _slid_m`, in the order of joint_name() and segment_column().
[[nodiscard]] std::string ticks_csv_header();

/// Holds no clock time, so that equal motions give equal files, bit for bit.
/// Not real-time. @throws as OutputFile.
class TicksCsv {
 public:
  /// Writes the header.
  explicit TicksCsv(const std::filesystem::path& file);
  void write(const Snapshot& snapshot);
  /// Makes the file appear under its name.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

}  // namespace phalanx
