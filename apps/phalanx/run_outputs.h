// SPDX-License-Identifier: Apache-2.0
// The files of `phalanx simulate`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "phalanx/figures/picture.h"
#include "phalanx/figures/picture_moment.h"
#include "phalanx/figures/plot.h"
#include "phalanx/record/contacts_csv.h"
#include "phalanx/record/poses_csv.h"
#include "phalanx/record/summary.h"
#include "phalanx/record/ticks_csv.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Paths of the outputs; empty: not wanted.
struct OutputPlan {
  std::filesystem::path folder;
  bool poses = false;
  bool contacts = false;
  std::filesystem::path plot;
  std::filesystem::path picture;
  std::optional<std::uint64_t> picture_at = {};  ///< tick of the picture; none: PictureMoment chooses
};

/// Writer of all planned files, tick by tick. summary.json is removed at the start and written last: a folder
/// with a summary.json is complete.
class RunOutputs {
 public:
  /// Opens the files.
  /// @param margin  of the scene [m]
  /// @param drawn  the hand in the picture; unused without a picture
  /// @param ticks  number of ticks that will be added
  /// @throws std::invalid_argument if a folder cannot be used; std::runtime_error if a file
  /// cannot be written.
  RunOutputs(OutputPlan plan, const HapticModel& model, double margin, DrawnHand drawn, std::uint64_t ticks);
  void add(const Snapshot& snapshot);
  /// Writes the remaining files. @param text  the plot's heading
  void finish(const Summary& summary, const PlotText& text);
  [[nodiscard]] double picture_time() const noexcept { return moment_.snapshot().time_s; }  ///< [s]

 private:
  void write_meshes() const;

  OutputPlan plan_;
  const HapticModel& model_;
  DrawnHand drawn_;
  std::optional<TicksCsv> ticks_;
  std::optional<PosesCsv> poses_;
  std::optional<ContactsCsv> contacts_;
  Trace trace_;
  PictureMoment moment_;
};

}  // namespace phalanx
