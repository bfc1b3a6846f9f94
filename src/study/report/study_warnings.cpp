// SPDX-License-Identifier: Apache-2.0
#include "study/report/study_warnings.h"

#include <fmt/format.h>

#include <map>

namespace phalanx {
namespace {

constexpr std::size_t kMostNamed = 8;

/// Points that have a warning in common.
class Named {
 public:
  explicit Named(const StudyView& view) : view_(view) {}

  void add(int index) {
    if (++count_ <= kMostNamed) text_ += (text_.empty() ? "" : "; ") + view_.name(index);
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  /// @returns the points in words: "3 points (light; heavy; frictionless)".
  [[nodiscard]] std::string text() const {
    return fmt::format("{} {} ({}{})", count_, count_ == 1 ? "point" : "points", text_,
                       count_ > kMostNamed ? fmt::format("; and {} more", count_ - kMostNamed) : "");
  }

 private:
  const StudyView& view_;
  std::string text_;
  std::size_t count_ = 0;
};

struct Invalid {
  explicit Invalid(const StudyView& view) : at(view) {}
  Named at;
  long long invalid = 0;
  long long trials = 0;
};

void add_invalid(const StudyView& view, std::vector<std::string>& warnings) {
  std::map<std::string, Invalid> by_reason;  // by the reason of a point's first invalid run
  for (int i = 0; i < point_count(view.study()); ++i) {
    const PointResult* result = view.result(i);
    if (result == nullptr || result->invalid_trials == 0) continue;
    Invalid& invalid = by_reason.try_emplace(result->why_invalid, view).first->second;
    invalid.at.add(i);
    invalid.invalid += result->invalid_trials;
    invalid.trials += result->trials;
  }
  for (const auto& [reason, invalid] : by_reason)
    warnings.push_back(fmt::format(
        "{} of {} runs were invalid and count as not stable, at {}. Why the first one at each "
        "point was: {}.",
        invalid.invalid, invalid.trials, invalid.at.text(), reason.empty() ? "no reason was given" : reason));
}

}  // namespace

std::vector<std::string> study_warnings(const StudyView& view) {
  const Study& study = view.study();
  Named missing(view);
  Named below(view);
  Named nothing_known(view);
  Named at_least(view);
  Named ends_in_invalid(view);
  Named not_stable(view);
  for (int i = 0; i < point_count(study); ++i) {
    const PointResult* result = view.result(i);
    if (result == nullptr) {
      missing.add(i);
      continue;
    }
    if (result->k_lim == 0.0) (result->ends_in_invalid ? nothing_known : below).add(i);
    if (result->at_least) at_least.add(i);
    if (result->ends_in_invalid && result->k_lim != 0.0) ends_in_invalid.add(i);
    if (!study.stiffness && !result->stable) not_stable.add(i);
  }
  std::vector<std::string> warnings;
  const auto add = [&](const Named& named, const std::string& what) {
    if (named.count() > 0) warnings.push_back(fmt::format("{}: {}.", what, named.text()));
  };
  add(missing, fmt::format("Not finished, of {} points", point_count(study)));
  if (study.stiffness) {
    add(below,
        fmt::format(
            "Not even the smallest stiffness, {:.12g} N/mm, is stable; the limit is below it and shown as 0",
            study.stiffness->min_n_per_mm));
    add(nothing_known, fmt::format("Already at the smallest stiffness, {:.12g} N/mm, a run is invalid; "
                                   "nothing is known of the limit, "
                                   "which is shown as 0",
                                   study.stiffness->min_n_per_mm));
    add(at_least, fmt::format("Stable up to the end of the grid, {:.12g} N/mm; the limit may be higher",
                              study.stiffness->max_n_per_mm));
  }
  add(ends_in_invalid,
      "What ends the search is an invalid run, not an unstable one; the limit may be higher");
  add(not_stable, "Not stable at the stiffness of the scene");
  add_invalid(view, warnings);
  return warnings;
}

}  // namespace phalanx
