// SPDX-License-Identifier: Apache-2.0
// A simulated patient of a training's sessions: success by ability and difficulty, learning, good and bad
// days, missed sessions. Its model differs from that of next_difficulty(): a normal ogive, learning that
// levels off, and lapses of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "phalanx/core/random.h"
#include "phalanx/exercise/training.h"

namespace phalanx {

/// Simulated patient, drawn by a seed.
class SimulatedLearner {
 public:
  explicit SimulatedLearner(std::uint64_t seed) : random_(seed) {
    ability_ = random_.between(-0.1, 0.8);
    gain_ = random_.between(0.0, 0.5);
    time_ = random_.between(2.0, 8.0);
    width_ = 0.05 * std::pow(8.0, random_.uniform());
    day_ = random_.between(0.0, 0.4) * width_;
    lapse_ = random_.between(0.0, 0.06);
    const double kind = random_.uniform();
    if (kind < 0.15) gain_ = 0.0;                     // does not learn
    if (kind >= 0.15 && kind < 0.2) ability_ = -0.6;  // too weak for the easiest trial
    if (kind >= 0.2 && kind < 0.25) ability_ = 1.3;   // too able for the hardest trial
    if (kind >= 0.25 && kind < 0.4)
      sessions_ = 1 + static_cast<int>(random_.between(0.0, 9.0));  // drops out after 1 to 9
  }

  /// @returns true if the patient comes to another session
  [[nodiscard]] bool comes() const { return session_ < sessions_; }

  /// Does a session.
  [[nodiscard]] TrainingSession session(double difficulty, int trials) {
    const double today = ability_ + gain_ * (1.0 - std::exp(-session_ / time_)) + day_ * random_.normal();
    truth_ = (1.0 - lapse_) * 0.5 * std::erfc(-(today - difficulty) / (width_ * std::sqrt(2.0)));
    TrainingSession done = {.difficulty = difficulty, .successes = 0, .counted = trials};
    for (int i = 0; i < trials; ++i)
      if (random_.uniform() < truth_) ++done.successes;
    ++session_;
    return done;
  }

  /// @returns the probability of success in the last session
  [[nodiscard]] double truth() const noexcept { return truth_; }

 private:
  Random random_;
  double ability_ = 0.0;  ///< before the first session
  double gain_ = 0.0;     ///< of ability, in the end
  double time_ = 1.0;     ///< in which 63 % of it are gained [sessions]
  double width_ = 0.1;    ///< of the ogive
  double day_ = 0.0;      ///< standard deviation of ability from day to day
  double lapse_ = 0.0;    ///< share of trials that fail at any difficulty
  int sessions_ = 1000;
  int session_ = 0;
  double truth_ = 0.0;
};

/// How a population of simulated patients fared.
struct LearnerCount {
  int patients = 0;
  int dropped_out = 0;      ///< fewer than kSessionsToJudge sessions
  int in_range = 0;         ///< true mean success of the judged sessions within the margin
  int missed = 0;           ///< the others that came to all sessions
  int observed_missed = 0;  ///< observed share of the judged sessions beyond the margin
  int silent = 0;           ///< missed or dropped out, not reported
  int silent_observed = 0;  ///< observed_missed, not reported
  int silent_far = 0;       ///< missed by more than 0.03 beyond the margin, not reported
  int alarms = 0;           ///< in range, yet reported
};

/// Lets patients of the seeds first .. first + patients - 1 do ten sessions each.
inline LearnerCount count_learners(std::uint64_t first, int patients, int trials,
                                   const Difficulty& difficulty) {
  LearnerCount count;
  const double target = difficulty.target_success;
  for (int i = 0; i < patients; ++i) {
    SimulatedLearner learner(first + static_cast<std::uint64_t>(i));
    std::vector<TrainingSession> history;
    double truth = 0.0;
    for (int s = 0; s < kSessionsToJudge && learner.comes(); ++s) {
      history.push_back(learner.session(next_difficulty(history, difficulty), trials));
      if (s >= kSessionsToJudge - kJudgedSessions) truth += learner.truth() / kJudgedSessions;
    }
    const SuccessReport report = success_report(history, target);
    ++count.patients;
    if (history.size() < static_cast<std::size_t>(kSessionsToJudge)) {
      ++count.dropped_out;
      if (!report.reported()) ++count.silent;
      continue;
    }
    const double off = std::abs(truth - target);
    const bool missed = off > kSuccessMargin;
    const bool observed = std::abs(report.share - target) > kSuccessMargin + 1e-9;
    if (missed)
      ++count.missed;
    else
      ++count.in_range;
    if (observed) ++count.observed_missed;
    if (missed && !report.reported()) ++count.silent;
    if (off > kSuccessMargin + 0.03 && !report.reported()) ++count.silent_far;
    if (observed && !report.reported()) ++count.silent_observed;
    if (!missed && report.reported()) ++count.alarms;
  }
  return count;
}

}  // namespace phalanx
