// SPDX-License-Identifier: Apache-2.0
// Measuring the points of a study on all cores, in a way that a kill cannot hurt.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/study.h"
#include "phalanx/study/laboratory/trial.h"

namespace phalanx {

/// What a run depends on besides the study and the program: the journal of a study is good as long as it
/// stays the same.
struct StudyInputs {
  std::string text;                          ///< numbers, as text
  std::vector<std::filesystem::path> files;  ///< by name and content; folders do not count
};

/// Loads the scene with these overrides, so that what is wrong with them is known before anything runs (it
/// throws std::invalid_argument), and says what a run with them depends on.
using StudyCheck = std::function<StudyInputs(const Overrides& overrides)>;

/// The points with index % count == index - 1.
struct Shard {
  int index = 1;  ///< 1 .. count
  int count = 1;
};
/// "2/3". @throws std::invalid_argument if it is none.
[[nodiscard]] Shard parse_shard(const std::string& text);

struct StudyProgress {
  int done = 0;            ///< finished points of this shard, those of earlier runs too
  int total = 0;           ///< points of this shard
  int resumed = 0;         ///< of `done`, those that earlier runs finished
  double elapsed_s = 0.0;  ///< since this run began [s]
  /// At the pace of this run [s]; NaN as long as it has finished no point.
  double remaining_s = std::numeric_limits<double>::quiet_NaN();
};

struct StudyOptions {
  int jobs = 0;  ///< threads; 0: as many as there are cores
  Shard shard;
  bool restart = false;  ///< throws away what the journal holds
  std::string commit;    ///< of this program: results of another one are not mixed with it
  std::function<void(const StudyProgress&)>
      progress;  ///< called by one thread at a time, at the start and after each point
};

/// For StudyOptions::commit: the commit that this program was built from; if that does not say all (it was
/// built with changes, or outside git), with a fingerprint of the program itself.
[[nodiscard]] std::string program_version();

/// Checks every point. @returns the fingerprint of all that they depend on.
/// @throws SceneError naming the point and what `check` said.
[[nodiscard]] std::string check_study(const Study& study, const StudyCheck& check);

/// Measures what the journal in `out` does not hold yet ("points.jsonl", or "points.2-of-3.jsonl" of a
/// shard). A point that is finished is on the disk before the next begins in its thread; whenever the process
/// ends, by whatever means, the same call goes on where it stopped. The results are the same for any number
/// of threads, of shards and of interruptions. As long as points are left, outputs of an earlier run are
/// removed from `out`. If a trial throws, its point is left out, the others go on, and the end is an
/// exception.
/// @returns the results of this shard, by index.
/// @throws SceneError before anything runs if scene, device or patient of a point cannot be loaded;
/// std::invalid_argument if the journal belongs to
///         another study, another process writes it, or the folder cannot be used; std::runtime_error if a
///         point failed (naming the first) or the journal cannot be written.
[[nodiscard]] std::vector<PointResult> run_study(const Study& study, const StudyCheck& check,
                                                 const TrialFunction& trial, const std::filesystem::path& out,
                                                 const StudyOptions& options);

}  // namespace phalanx
