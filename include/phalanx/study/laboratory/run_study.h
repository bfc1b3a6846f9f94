// SPDX-License-Identifier: Apache-2.0
// Measuring the points of a study on all cores. The run can be ended at any time and continued later.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Inputs of a run besides the study and the program. A journal stays valid as long as they stay the same. A run ends
/// if one of their files changes.
struct StudyInputs {
  std::string text;                           ///< numbers, as text
  std::vector<std::filesystem::path> files;   ///< compared by name and content, without their folders
  std::vector<std::filesystem::path> read{};  ///< files that `text` comes from
};

/// Function that checks overrides by loading the scene with them, before anything runs. It throws
/// std::invalid_argument if they are wrong, and returns the inputs of a run with them. Several threads may call it.
using StudyCheck = std::function<StudyInputs(const Overrides& overrides)>;

/// Part of a study: the points with index % count == index of the shard - 1.
struct Shard {
  int index = 1;  ///< 1 .. count
  int count = 1;
};
/// Parses "2/3".
/// @throws std::invalid_argument if the text has another form.
[[nodiscard]] Shard parse_shard(const std::string& text);

/// Progress of a run.
struct StudyProgress {
  int done = 0;            ///< finished points of this shard, also of earlier runs
  int total = 0;           ///< points of this shard
  int resumed = 0;         ///< those of `done` that earlier runs finished
  double elapsed_s = 0.0;  ///< since this run began [s]
  /// Estimate from the pace of this run [s]; NaN until it has finished a point.
  double remaining_s = std::numeric_limits<double>::quiet_NaN();
  bool in_queue = false;  ///< run_on_queue(); the following members are of a queue alone
  int workers = 0;        ///< workers that were seen within the lease
  int quarantined = 0;    ///< points that were given up
  /// Pace of the last minute [1/s]; NaN if no point was finished in it.
  double points_per_s = std::numeric_limits<double>::quiet_NaN();
};

/// Options of a run.
struct StudyOptions {
  int jobs = 0;  ///< threads; 0: as many as there are cores
  Shard shard;
  bool restart = false;  ///< discards the journal's content
  std::string commit;    ///< commit of this program; results of other commits are not mixed in
  std::function<void(const StudyProgress&)>
      progress;  ///< called by one thread at a time, at the start and after each point
};

/// @returns the value for StudyOptions::commit: the commit that this program was built from. If it was built
/// with changes or outside git, a fingerprint of the program is added.
[[nodiscard]] std::string program_version();

/// Checks every point. @returns the fingerprint of all inputs
/// @param jobs  most threads that call `check`, at most one a core; 0: one a core. They have ended when this returns.
/// @throws what `check` throws for the first point for which it throws: SceneError naming the point and the reason
/// for a std::invalid_argument; std::runtime_error naming a file that changes meanwhile
[[nodiscard]] std::string check_study(const Study& study, const StudyCheck& check, int jobs = 0);

/// Measures the points that the journal in `out` does not have yet ("points.jsonl", or "points.2-of-3.jsonl"
/// of a shard). A finished point is on the disk before its thread begins the next. If the process is ended,
/// the same call continues where it stopped. The results are the same for any number of threads, shards and
/// interruptions. While points are left, outputs of an earlier run are removed from `out`. If a trial throws,
/// its point is left out and the others continue; the run then ends with an exception.
/// @returns the results of this shard, by index
/// @throws SceneError before anything runs if scene, device or patient of a point cannot be loaded
/// @throws std::invalid_argument if the journal belongs to another study or was measured with mathematical functions
/// that round differently, another process writes it, or the folder cannot be used
/// @throws std::runtime_error if a point failed (naming the first), a file of the inputs was changed since the call
/// began (the points that were measured since are not kept), or the journal cannot be written
[[nodiscard]] std::vector<PointResult> run_study(const Study& study, const StudyCheck& check,
                                                 const TrialFunction& trial, const std::filesystem::path& out,
                                                 const StudyOptions& options);

}  // namespace phalanx
