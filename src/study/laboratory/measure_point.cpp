// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/measure_point.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <vector>

#include "phalanx/study/laboratory/limit_search.h"

namespace phalanx {
namespace {

constexpr double kNotSet = PointResult::kNone;  // the scene's stiffness, the patient's press
constexpr double kLightPress = 2.0;             // [N]; k_eff is computed between these two presses
constexpr double kFirmPress = 4.0;

using Trials = std::vector<TrialResult>;  // the trials that ran, one a seed, in order

bool good(const TrialResult& trial) { return trial.valid && trial.stable; }

Verdict verdict_of(const Trials& trials) {
  const auto first = std::find_if_not(trials.begin(), trials.end(), good);
  if (first == trials.end()) return Verdict::kStable;
  return first->stable ? Verdict::kInvalid : Verdict::kUnstable;
}

double largest(const Trials& trials, double TrialResult::* member) {
  double result = trials.front().*member;
  for (const TrialResult& trial : trials) result = std::max(result, trial.*member);
  return result;
}

MeanAndLargest mean_and_largest(const Trials& trials, double TrialResult::* member) {
  double sum = 0.0;
  for (const TrialResult& trial : trials) sum += trial.*member;
  return {.mean = sum / static_cast<double>(trials.size()), .largest = largest(trials, member)};
}

/// The runs of one point.
class Runs {
 public:
  Runs(const Study& study, int index, const TrialFunction& trial)
      : study_(study), overrides_(point_overrides(study, study_point(study, index))), trial_(trial) {}

  /// Runs all seeds.
  Trials all(double stiffness, double press) {
    Trials trials;
    extend(trials, study_.seeds, stiffness, press);
    return trials;
  }

  /// Runs the seeds in their order, until it is known whether all are stable.
  Trials until_known(double stiffness) {
    Trials trials;
    while (static_cast<int>(trials.size()) < study_.seeds && verdict_of(trials) == Verdict::kStable)
      extend(trials, std::max(1, static_cast<int>(trials.size())), stiffness, kNotSet);
    return trials;
  }

  /// Runs one seed, 0 .. seeds - 1.
  TrialResult one(double stiffness, int seed) {
    TrialResult result =
        trial_(overrides_, stiffness, kNotSet, study_.first_seed + static_cast<std::uint64_t>(seed));
    count(result);
    return result;
  }

  void count_into(PointResult& result) const {
    result.trials = count_;
    result.invalid_trials = invalid_;
    result.why_invalid = why_invalid_;
  }

 private:
  /// Runs up to `more` further seeds in parallel.
  void extend(Trials& trials, int more, double stiffness, double press) {
    const int done = static_cast<int>(trials.size());
    const int end = std::min(study_.seeds, done + more);
    std::vector<std::exception_ptr> failed(static_cast<std::size_t>(end - done));
    trials.resize(static_cast<std::size_t>(end));
    const auto run = [&](int i) {
      try {
        trials[static_cast<std::size_t>(i)] =
            trial_(overrides_, stiffness, press, study_.first_seed + static_cast<std::uint64_t>(i));
      } catch (...) {
        failed[static_cast<std::size_t>(i - done)] = std::current_exception();
      }
    };
    // Isolated: a thread that waits for its seeds must not begin another point. This point would then have to
    // wait for that one.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(done, end, run); });
    for (const std::exception_ptr& error : failed) {
      if (error) std::rethrow_exception(error);
    }
    for (int i = done; i < end; ++i) count(trials[static_cast<std::size_t>(i)]);
  }

  void count(const TrialResult& trial) {
    ++count_;
    if (trial.valid) return;
    if (++invalid_ == 1) why_invalid_ = trial.why_invalid;
  }

  const Study& study_;
  Overrides overrides_;
  const TrialFunction& trial_;
  int count_ = 0;
  int invalid_ = 0;
  std::string why_invalid_;
};

StiffnessVerdict summed_up(const Trials& trials, double n_per_mm) {
  return {.n_per_mm = n_per_mm,
          .verdict = verdict_of(trials),
          .seeds_run = static_cast<int>(trials.size()),
          .force_swing = largest(trials, &TrialResult::force_swing),
          .position_swing = largest(trials, &TrialResult::position_swing)};
}

void measure_k_eff(Runs& runs, double stiffness, PointResult& result) {
  const Trials light = runs.all(stiffness, kLightPress);
  const Trials firm = runs.all(stiffness, kFirmPress);
  double sum = 0.0;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double deeper = firm[i].mean_depth - light[i].mean_depth;
    if (!good(light[i]) || !good(firm[i]) || !(deeper > 0.0)) continue;
    sum += (firm[i].mean_force - light[i].mean_force) / deeper;
    ++result.k_eff_seeds;
  }
  if (result.k_eff_seeds > 0) result.k_eff = sum / result.k_eff_seeds;
}

/// Sets the point's results at one stiffness, without k_eff.
/// @param trials  all seeds at `stiffness`
void set_results_at(double stiffness, const Trials& trials, PointResult& result) {
  result.measured_at = stiffness;
  result.stable = verdict_of(trials) == Verdict::kStable;
  result.peak_depth = largest(trials, &TrialResult::peak_depth);
  result.force_swing = largest(trials, &TrialResult::force_swing);
  result.position_swing = largest(trials, &TrialResult::position_swing);
  result.ghost_s = mean_and_largest(trials, &TrialResult::ghost_s);
  result.ghost_energy = mean_and_largest(trials, &TrialResult::ghost_energy);
}

void measure_at_limit(const StiffnessGrid& grid, Runs& runs, PointResult& result) {
  std::map<int, Trials> tried;
  const LimitSearch search = search_limit(grid.size(), [&](int index) {
    const Trials& trials = tried[index] = runs.until_known(grid.at(index));
    return verdict_of(trials) == Verdict::kStable;
  });
  for (const auto& [index, trials] : tried) result.checked.push_back(summed_up(trials, grid.n_per_mm(index)));
  result.k_lim = search.limit < 0 ? 0.0 : grid.at(search.limit);
  result.at_least = search.at_least;
  result.non_monotone = search.non_monotone;
  result.ends_in_invalid = !search.at_least && verdict_of(tried.at(search.limit + 1)) == Verdict::kInvalid;
  if (search.limit < 0) return;
  set_results_at(result.k_lim, tried.at(search.limit), result);
  measure_k_eff(runs, result.k_lim, result);
}

void trace_limit_of_point(const StiffnessGrid& grid, int seeds, Runs& runs, PointResult& result) {
  std::map<int, std::map<int, TrialResult>> tried;  // by grid point, then seed
  const TracedLimit trace = trace_limit(grid.size(), seeds, [&](int index, int seed) {
    return good(tried[index][seed] = runs.one(grid.at(index), seed));
  });
  const auto trials_at = [&tried](int index) {
    Trials trials;
    for (const auto& [seed, trial] : tried.at(index)) trials.push_back(trial);
    return trials;
  };
  for (const auto& [index, by_seed] : tried)
    result.checked.push_back(summed_up(trials_at(index), grid.n_per_mm(index)));
  result.k_lim = trace.limit < 0 ? 0.0 : grid.at(trace.limit);
  result.at_least = trace.at_least;
  result.non_monotone = trace.non_monotone;
  result.ends_in_invalid = !trace.at_least && verdict_of(trials_at(trace.limit + 1)) == Verdict::kInvalid;
  if (trace.limit >= 0) set_results_at(result.k_lim, trials_at(trace.limit), result);
}

void measure_at_scenes_stiffness(Runs& runs, PointResult& result) {
  const Trials trials = runs.all(kNotSet, kNotSet);
  result.checked = {summed_up(trials, kNotSet)};
  set_results_at(kNotSet, trials, result);
  measure_k_eff(runs, kNotSet, result);
}

}  // namespace

PointResult measure_point(const Study& study, int index, const TrialFunction& trial) {
  PointResult result;
  result.index = index;
  Runs runs(study, index, trial);
  if (study.traces()) {
    trace_limit_of_point(*study.stiffness, study.seeds, runs, result);
  } else if (study.stiffness) {
    measure_at_limit(*study.stiffness, runs, result);
  } else {
    measure_at_scenes_stiffness(runs, result);
  }
  runs.count_into(result);
  return result;
}

}  // namespace phalanx
