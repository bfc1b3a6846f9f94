// SPDX-License-Identifier: Apache-2.0
// A study: which points are measured, and what is known of a point when it is finished.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// One value of an axis.
struct StudyValue {
  std::string toml;   ///< as it would stand in a scene file: 0.34, "light" with its quotes
  std::string shown;  ///< the same without quotes
  double number = std::numeric_limits<double>::quiet_NaN();  ///< in the key's unit; NaN if it is no number
};

/// A scene key and the values that it takes, one after the other.
struct StudyAxis {
  std::string key;                 ///< "device.scale.sheath_friction"
  std::string label;               ///< for people; the key if the study file gives none
  std::vector<StudyValue> values;  ///< at least one, no two alike

  /// Every value is a number: the axis can be drawn to scale.
  [[nodiscard]] bool numeric() const noexcept;
};

/// Values that belong together, under one name.
struct StudyVariant {
  std::string name;
  Overrides set;  ///< values as TOML
};

/// The wall stiffnesses among which the limit is looked for: min, min + step, .. max.
struct StiffnessGrid {
  double min_n_per_mm = 0.1;   ///< [N/mm] > 0
  double max_n_per_mm = 4.0;   ///< [N/mm] >= min
  double step_n_per_mm = 0.1;  ///< [N/mm] > 0; max - min is a whole number of steps

  [[nodiscard]] int size() const noexcept;
  /// Grid point `index` in N/mm, in at most 12 digits, so that 0.1 + 2 x 0.1 is the number that 0.3 is.
  [[nodiscard]] double n_per_mm(int index) const;
  /// The same [N/m]
  [[nodiscard]] double at(int index) const;
};

struct Study {
  std::string name;              ///< of the file, without .toml
  std::string title;             ///< the file's description, one line; may be empty
  std::string scene;             ///< as the file says it: a name in scenes/, or a path relative to `folder`
  std::filesystem::path folder;  ///< the study file's; relative paths in it are relative to this
  int seeds = 20;
  std::uint64_t first_seed = 1;  ///< seeds are first_seed, first_seed + 1, ..
  std::optional<StiffnessGrid>
      stiffness;                       ///< without: every point is measured at the scene's stiffness alone
  Overrides set;                       ///< of all points; values as TOML
  std::vector<StudyVariant> variants;  ///< at least one; a study without any has one with an empty name
  std::vector<StudyAxis> axes;         ///< may be empty

  /// Whether the study file names variants.
  [[nodiscard]] bool has_variants() const noexcept;
};

/// One point of a study: a variant and a value of each axis.
struct StudyPoint {
  int index = 0;           ///< the variant counts slowest, the last axis fastest
  int variant = 0;         ///< in Study::variants
  std::vector<int> value;  ///< for each axis, in StudyAxis::values
};

/// Number of variants x the product of the axes' numbers of values.
[[nodiscard]] int point_count(const Study& study);
/// @pre 0 <= index < point_count(study)
[[nodiscard]] StudyPoint study_point(const Study& study, int index);
/// What the point changes in the scene: what is common to all, then the variant's, then the axes'. Paths of
/// files in them are made absolute against the study's folder.
[[nodiscard]] Overrides point_overrides(const Study& study, const StudyPoint& point);
/// "smoothing +-0.1, sheath friction 0.34", for messages and legends; "the scene as it is" if nothing varies.
[[nodiscard]] std::string point_text(const Study& study, const StudyPoint& point);

/// What the seeds said of one stiffness. An invalid trial never counts for stability.
enum class Verdict {
  kStable,    ///< every seed is stable and valid
  kUnstable,  ///< the first seed that is not so is unstable
  kInvalid,   ///< the first seed that is not so is stable but invalid: it proves nothing
};
[[nodiscard]] const char* verdict_name(Verdict verdict) noexcept;  ///< "stable", "unstable", "invalid"

/// One stiffness that was tried. The seeds are run in their order and no further than is needed to know.
struct StiffnessVerdict {
  double n_per_mm = 0.0;  ///< [N/mm]; NaN: the scene's own
  Verdict verdict = Verdict::kUnstable;
  int seeds_run = 0;
  double force_swing = 0.0;     ///< largest over the seeds that ran [N]
  double position_swing = 0.0;  ///< largest over the seeds that ran [m]
};

/// Over the seeds.
struct MeanAndLargest {
  double mean = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
};

/// A finished point. NaN stands for what there is not: k_lim in a study without a grid, and everything that
/// is measured at the limit if no stiffness of the grid is stable.
struct PointResult {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  int index = 0;  ///< StudyPoint::index
  /// The largest stiffness of the grid that is stable and has, of those that were checked, only stable ones
  /// below it (search_limit()) [N/m]. 0: not even the smallest is stable, the limit is below the grid.
  double k_lim = kNone;
  bool at_least = false;      ///< k_lim is the grid's largest: the limit may be higher
  bool non_monotone = false;  ///< something above the first unstable stiffness was stable: see `checked`
  bool ends_in_invalid =
      false;  ///< the next stiffness above k_lim is not unstable but invalid: the limit may be higher
  bool stable = false;  ///< every seed is stable and valid at the stiffness that is measured at

  double measured_at =
      kNone;  ///< stiffness of what follows [N/m]: k_lim; NaN: the scene's own, or nothing is measured
  double k_eff =
      kNone;  ///< rendered stiffness (F(4 N) - F(2 N)) / (x(4 N) - x(2 N)), mean over the seeds [N/m]
  int k_eff_seeds = 0;  ///< how many seeds it is the mean of: both presses stable and valid, and x grows
  double peak_depth = kNone;      ///< largest over the seeds [m]
  double force_swing = kNone;     ///< peak to peak, largest over the seeds [N]
  double position_swing = kNone;  ///< peak to peak, largest over the seeds [m]
  MeanAndLargest ghost_s;         ///< [s]
  MeanAndLargest ghost_energy;    ///< [J]

  int trials = 0;                         ///< closed-loop runs in all
  int invalid_trials = 0;                 ///< of them
  std::string why_invalid;                ///< of the first one; empty if there is none
  std::vector<StiffnessVerdict> checked;  ///< by rising stiffness
};

}  // namespace phalanx
