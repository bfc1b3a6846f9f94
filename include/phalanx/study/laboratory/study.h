// SPDX-License-Identifier: Apache-2.0
// A study: its points, and the result of a finished point.
//
// The laboratory measures how the largest stable stiffness depends on parameters. study_file.h reads a study.
// run_study.h measures its points with trials of the closed loop, in the way that limit_search.h describes.
// outputs.h and report.h write the results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/simulation/closed_loop/stability_criterion.h"

namespace phalanx {

/// One value of an axis.
struct StudyValue {
  std::string toml;   ///< as written in a scene file: 0.34, or "light" with its quotes
  std::string shown;  ///< the same without quotes
  double number = std::numeric_limits<double>::quiet_NaN();  ///< in the key's unit; NaN if it is not a number
};

/// A scene key and its values in the study.
struct StudyAxis {
  std::string key;                 ///< "device.scale.sheath_friction"
  std::string label;               ///< for people; the key if the study file has none
  std::vector<StudyValue> values;  ///< at least one, all different

  /// @returns true if every value is a number: the axis can be drawn to scale.
  [[nodiscard]] bool numeric() const noexcept;
};

/// Values that belong together, under one name.
struct StudyVariant {
  std::string name;
  Overrides set;  ///< values as TOML
};

/// How the limit is searched, see limit_search.h.
enum class StiffnessSearch {
  kScan,   ///< search_limit() with all seeds; the largest stable stiffness is then measured in full
  kTrace,  ///< trace_limit(): fewer trials; no k_eff
};

/// The grid of wall stiffnesses in which the limit is searched: min, min + step, .. max.
struct StiffnessGrid {
  double min_n_per_mm = 0.1;                        ///< [N/mm] > 0
  double max_n_per_mm = 4.0;                        ///< [N/mm] >= min
  double step_n_per_mm = 0.1;                       ///< [N/mm] > 0; max - min is a whole number of steps
  StiffnessSearch search = StiffnessSearch::kScan;  ///< `stiffness.search` of the study file

  [[nodiscard]] int size() const noexcept;
  /// @returns grid point `index` [N/mm], rounded to 12 digits, so that 0.1 + 2 x 0.1 equals 0.3.
  [[nodiscard]] double n_per_mm(int index) const;
  /// @returns grid point `index` [N/m].
  [[nodiscard]] double at(int index) const;
};

/// Definition of a study, as its file states it.
struct Study {
  std::string name;              ///< name of the file, without .toml
  std::string title;             ///< description of the file, one line; may be empty
  std::string scene;             ///< as in the file: a name in scenes/, or a path relative to `folder`
  std::filesystem::path folder;  ///< folder of the study file; relative paths in it are relative to this
  int seeds = 20;
  std::uint64_t first_seed = 1;            ///< seeds are first_seed, first_seed + 1, ..
  std::optional<StiffnessGrid> stiffness;  ///< none: every point is measured only at the scene's stiffness
  Overrides set;                           ///< for all points; values as TOML
  std::vector<StudyVariant> variants;  ///< at least one; a study without variants has one with an empty name
  std::vector<StudyAxis> axes;         ///< may be empty

  /// @returns true if the limit is traced, so that k_eff is not measured.
  [[nodiscard]] bool traces() const noexcept {
    return stiffness && stiffness->search == StiffnessSearch::kTrace;
  }
  /// @returns true if the study file names variants.
  [[nodiscard]] bool has_variants() const noexcept;
};

/// One point of a study: a variant and a value of each axis.
struct StudyPoint {
  int index = 0;           ///< position in the order; the variant changes slowest, the last axis fastest
  int variant = 0;         ///< in Study::variants
  std::vector<int> value;  ///< for each axis, in StudyAxis::values
};

/// @returns the number of variants times the product of the axes' numbers of values.
[[nodiscard]] int point_count(const Study& study);
/// @returns the point of an index.  @pre 0 <= index < point_count(study)
[[nodiscard]] StudyPoint study_point(const Study& study, int index);
/// @returns the point's overrides of the scene: the common ones, then the variant's, then the axes'. Paths of
/// files in them are absolute, against the study's folder.
[[nodiscard]] Overrides point_overrides(const Study& study, const StudyPoint& point);
/// Describes a point for messages and legends: "smoothing +-0.1, sheath friction 0.34"; "the scene as it is"
/// if nothing varies.
[[nodiscard]] std::string point_text(const Study& study, const StudyPoint& point);

/// Verdict of the seeds on one stiffness. An invalid trial never counts for stability.
enum class Verdict {
  kStable,    ///< every seed that ran is stable and valid
  kUnstable,  ///< the first seed that is not stable and valid is unstable
  kInvalid,   ///< the first seed that is not stable and valid is stable but invalid: it proves nothing
};
[[nodiscard]] const char* verdict_name(Verdict verdict) noexcept;  ///< "stable", "unstable", "invalid"

/// One stiffness that was tried. In a scan the seeds run in their order, until the verdict is known; in a
/// trace those that the search asks for.
struct StiffnessVerdict {
  double n_per_mm = 0.0;  ///< [N/mm]; NaN: the scene's own
  Verdict verdict = Verdict::kUnstable;
  int seeds_run = 0;
  double force_swing = 0.0;     ///< largest over the seeds that ran [N]
  double position_swing = 0.0;  ///< largest over the seeds that ran [m]
};

/// Mean and largest value over the seeds.
struct MeanAndLargest {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
};

/// Result of a finished point. NaN marks a missing value: k_lim in a study without a grid, and all results at
/// the limit if no stiffness of the grid is stable.
struct PointResult {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  int index = 0;  ///< StudyPoint::index
  /// The largest stable stiffness of the grid that has only stable ones below it, among those that were
  /// checked (limit_search.h) [N/m]. 0: not even the smallest is stable; the limit is below the grid.
  double k_lim = kNone;
  bool at_least = false;  ///< k_lim is the grid's largest: the limit may be higher
  /// Scan: a stiffness above the first unstable one was stable, see `checked`. Trace: a seed was stable above
  /// a stiffness at which it was unstable.
  bool non_monotone = false;
  bool ends_in_invalid =
      false;            ///< the next stiffness above k_lim is invalid, not unstable: the limit may be higher
  bool stable = false;  ///< every seed is stable and valid at `measured_at`

  double measured_at =
      kNone;  ///< stiffness of the results below [N/m]: k_lim; NaN: the scene's own, or nothing is measured
  double k_eff =
      kNone;  ///< rendered stiffness (F(4 N) - F(2 N)) / (x(4 N) - x(2 N)), mean over the seeds [N/m]
  int k_eff_seeds = 0;  ///< number of seeds in that mean: both presses stable and valid, and x increases
  double peak_depth = kNone;      ///< largest over the seeds [m]
  double force_swing = kNone;     ///< peak to peak, largest over the seeds [N]
  double position_swing = kNone;  ///< peak to peak, largest over the seeds [m]
  MeanAndLargest ghost_s;         ///< [s]
  MeanAndLargest ghost_energy;    ///< [J]

  int trials = 0;                         ///< closed-loop runs in all
  int invalid_trials = 0;                 ///< number of invalid ones among them
  std::string why_invalid;                ///< reason of the first invalid one; empty: none
  std::vector<StiffnessVerdict> checked;  ///< by increasing stiffness
};

/// Function that runs the closed loop once.
/// @param overrides  of the scene, in order (those of a StudyPoint, see point_overrides())
/// @param stiffness  stiffness of the wall [N/m]; NaN: the scene's
/// @param press      force that the finger presses with [N]; NaN: the patient's
/// @param seed       of all random numbers in the run
/// It must be safe to call from several threads at once. Equal arguments must give equal results, independent
/// of earlier calls. It may throw: the point is then not finished (see run_study()). Not real-time.
using TrialFunction = std::function<TrialResult(const Overrides& overrides, double stiffness, double press,
                                                std::uint64_t seed)>;

}  // namespace phalanx
