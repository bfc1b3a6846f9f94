// SPDX-License-Identifier: Apache-2.0
// A study's points as a box of values with variants and axes as its edges, for tables and pictures.
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
  std::vector<double> numbers;     ///< empty if they are no numbers
  std::vector<std::size_t> order;  ///< indices as pictures show them: numbers rise
  int stride = 1;                  ///< how far apart two neighbours are in the points' order
  bool variants = false;

  /// Name i with what it is a value of: "delay 4.5 ms" where the label is "delay [ms]".
  [[nodiscard]] std::string choice(std::size_t i) const;
};

/// Points that share a choice in some dimensions.
struct Slice {
  int offset = 0;    ///< of the first one's index
  std::string text;  ///< the choice in words; empty if there was none
};

/// One of the results in the unit in which people read it.
struct Quantity {
  const char* name;
  const char* unit;
  double (*value)(const PointResult&);
  double (*largest)(const PointResult&);  ///< over the seeds, where `value` is a mean; nullptr: it is no mean
  double criterion;                       ///< what a stable run may reach; NaN: none

  [[nodiscard]] std::string label() const;  ///< with the unit
};

class StudyView {
 public:
  /// Both must outlive the view.
  /// @throws std::invalid_argument if a result's index is none of the study's points, or is there twice.
  StudyView(const Study& study, const std::vector<PointResult>& results);

  [[nodiscard]] const Study& study() const noexcept { return study_; }
  /// nullptr: the point is missing
  [[nodiscard]] const PointResult* result(int index) const;
  [[nodiscard]] const std::vector<Dimension>& dimensions() const noexcept { return dimensions_; }
  /// What tells the point from the others: "smoothing, delay 4.5 ms".
  [[nodiscard]] std::string name(int index) const;
  /// The numeric axis with the most values, the first of several; -1: there is none.
  [[nodiscard]] int main_axis() const;
  /// All choices in the dimensions that are not in `without`, in the points' order.
  [[nodiscard]] std::vector<Slice> slices(const std::vector<int>& without) const;
  /// k_lim first, if the study looks for it.
  [[nodiscard]] std::vector<Quantity> quantities() const;

 private:
  const Study& study_;
  std::map<int, const PointResult*> results_;
  std::vector<Dimension> dimensions_;
};

/// The one quantity that may be a lower bound (PointResult::at_least) or below the grid (0).
[[nodiscard]] inline bool is_k_lim(const Quantity& quantity) { return std::string(quantity.name) == "k_lim"; }

}  // namespace phalanx
