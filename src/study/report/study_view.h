// SPDX-License-Identifier: Apache-2.0
// A study's points as an array whose dimensions are variants and axes, for tables and charts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// The variants, or an axis, if there is more than one of them.
struct Dimension {
  std::string label;
  std::vector<std::string> names;
  std::vector<double> numbers;     ///< empty if they are not numbers
  std::vector<std::size_t> order;  ///< indices in the order of charts: numbers increase
  int stride = 1;                  ///< distance of two neighbours in the points' order
  bool variants = false;

  /// @returns name i with its quantity: "delay 4.5 ms" for the label "delay [ms]".
  [[nodiscard]] std::string choice(std::size_t i) const;
};

/// Points that share a choice in some dimensions.
struct Slice {
  int offset = 0;    ///< index of the first point
  std::string text;  ///< the choice in words; empty: none
};

/// One of the results, in a unit for readers.
struct Quantity {
  const char* name;
  const char* unit;
  double (*value)(const PointResult&);
  double (*largest)(const PointResult&);  ///< over the seeds, if `value` is a mean; nullptr: it is not
  double criterion;                       ///< bound for a stable run; NaN: none

  [[nodiscard]] std::string label() const;  ///< name with the unit
};

/// Access to a study's results by dimension.
class StudyView {
 public:
  /// Makes the view. Both arguments must outlive it.
  /// @throws std::invalid_argument if a result's index is not one of the study's points, or occurs twice.
  StudyView(const Study& study, const std::vector<PointResult>& results);

  [[nodiscard]] const Study& study() const noexcept { return study_; }
  /// @returns the result of a point; nullptr: the point is missing.
  [[nodiscard]] const PointResult* result(int index) const;
  [[nodiscard]] const std::vector<Dimension>& dimensions() const noexcept { return dimensions_; }
  /// @returns what distinguishes the point from the others: "smoothing, delay 4.5 ms".
  [[nodiscard]] std::string name(int index) const;
  /// @returns the numeric axis with the most values, the first of several; -1: there is none.
  [[nodiscard]] int main_axis() const;
  /// @returns all choices in the dimensions that are not in `without`, in the points' order.
  [[nodiscard]] std::vector<Slice> slices(const std::vector<int>& without) const;
  /// @returns the quantities; k_lim is first, if the study searches it.
  [[nodiscard]] std::vector<Quantity> quantities() const;

 private:
  const Study& study_;
  std::map<int, const PointResult*> results_;
  std::vector<Dimension> dimensions_;
};

/// @returns true for k_lim. It alone may be a lower bound (PointResult::at_least) or below the grid (0).
[[nodiscard]] inline bool is_k_lim(const Quantity& quantity) { return std::string(quantity.name) == "k_lim"; }

}  // namespace phalanx
