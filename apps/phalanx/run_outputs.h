// SPDX-License-Identifier: Apache-2.0
// The files of `phalanx simulate`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "phalanx/record/poses_csv.h"
#include "phalanx/record/summary.h"
#include "phalanx/record/ticks_csv.h"
#include "phalanx/step/haptic_step.h"
#include "phalanx/study/picture_moment.h"
#include "phalanx/study/plot.h"
#include "phalanx/study/trace.h"

namespace phalanx {

/// Where what goes; empty: not wanted.
struct OutputPlan {
  std::filesystem::path folder;
  bool poses = false;
  std::filesystem::path plot;
  std::filesystem::path picture;
  std::optional<std::uint64_t> picture_at = {};  ///< the tick that it shows; else as PictureMoment chooses
};

/// Takes every tick and writes what the plan asks for. summary.json is removed at the start and written last:
/// a folder that has one is complete.
class RunOutputs {
 public:
  /// @throws std::invalid_argument if a folder cannot be used; std::runtime_error if a file cannot be
  /// written.
  /// @param display  what the picture shows of the hand; not used without a picture
  /// @param ticks    how many will be added
  RunOutputs(OutputPlan plan, const HapticModel& model, SegmentMeshes display, std::uint64_t ticks);
  void add(const Snapshot& snapshot);
  /// @param text  the plot's heading
  void finish(const Summary& summary, const PlotText& text);
  [[nodiscard]] double picture_time() const noexcept { return moment_.snapshot().time_s; }  ///< [s]

 private:
  void write_meshes() const;

  OutputPlan plan_;
  const HapticModel& model_;
  SegmentMeshes display_;
  std::optional<TicksCsv> ticks_;
  std::optional<PosesCsv> poses_;
  Trace trace_;
  PictureMoment moment_;
};

}  // namespace phalanx
