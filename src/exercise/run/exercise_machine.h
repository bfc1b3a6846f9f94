// SPDX-License-Identifier: Apache-2.0
// State of an ExerciseRun.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exercise/run/exercise_stimuli.h"
#include "exercise/run/exercise_trial.h"
#include "phalanx/exercise/exercise_run.h"
#include "phalanx/exercise/reasons.h"

namespace phalanx {

/// Largest time between two observations that counts as active time; a longer one is a gap [s].
inline constexpr double kLongestStep = 1.0;
/// Largest deviation of the station's stiffness from the demanded one at which a sponge is presented [-].
inline constexpr double kStiffnessReached = 0.005;

/// Time for which a participant holds the end position of a sponge before the trial's part ends [s].
inline constexpr double kHoldAtEnd = 0.5;

/// The state machine of ExerciseRun, whose header describes it.
struct ExerciseRun::Impl {
  Impl(ExerciseDescription of, PersonLimits limits, std::uint64_t seed);

  ExerciseDescription exercise;
  PersonLimits person;
  ExerciseView view;
  ExerciseDemand demand;

  void step(Observation observation);
  [[nodiscard]] std::string input(const ExerciseInput& input);
  [[nodiscard]] ExerciseResult result() const;

 private:
  // Time.
  [[nodiscard]] double advance(Observation& observation);
  [[nodiscard]] double minutes() const noexcept { return active_s_ / 60.0; }
  // Phases.
  void enter(ExercisePhase phase);
  void step_phase(const Observation& observation);
  void step_rest(const Observation& observation);
  void step_rating();
  void end_rating();
  /// Turns the torque on for a hidden stimulus that is set, or off again if a sponge is touched
  /// before its trial.
  void arm(const Observation& observation);
  void step_trial(const Observation& observation);
  void go_on();
  void begin_trial(const Observation& observation);
  void end_part();
  void end_trial(const std::string& invalid, bool repeat);
  void add_trial(ExerciseTrial trial);
  void pause(std::string note);
  /// Asks for the last ratings, and then finishes.
  void close(std::string reason);
  void finish(std::string reason, bool interrupted);
  /// @returns true if every planned trial is valid, or the last stimulus was answered
  [[nodiscard]] bool complete() const;
  [[nodiscard]] bool in_trial() const noexcept;
  [[nodiscard]] bool watch_torque(const Observation& observation);
  [[nodiscard]] bool watch_dose();
  /// @returns why a trial cannot begin yet, for people; empty: it can
  [[nodiscard]] std::string why_waiting(const Observation& observation) const;
  /// @returns the first digit that touches a sponge; none: no digit does
  [[nodiscard]] static std::optional<int> touching(const Observation& observation);
  [[nodiscard]] bool torque_wanted() const noexcept;
  void judge(ExerciseTrial& trial) const;
  // Inputs.
  [[nodiscard]] std::string begin();
  [[nodiscard]] std::string skip();
  [[nodiscard]] std::string resume();
  [[nodiscard]] std::string rate(const ExerciseInput& input);
  [[nodiscard]] std::string answer(double value);
  [[nodiscard]] std::string override_difficulty(double value);
  // View.
  void show(const Observation* observation);
  void show_target(double t);
  [[nodiscard]] std::string instruction() const;
  [[nodiscard]] bool active() const noexcept;

  std::optional<ExerciseStimuli> stimuli_;
  int planned_ = 0;
  double difficulty_ = 0.0;
  TrialPlan plan_;
  int next_ = 0;                   ///< index of the trial that is done or comes next
  int repeated_ = 0;               ///< trials that were repeated
  int part_ = 0;                   ///< of the stimuli
  double trial_begin_ = 0.0;       ///< time of the trial's first observation, of the first part [s]
  std::optional<double> reached_;  ///< time at which the end position was reached [s]
  std::vector<Observation> steps_;
  std::vector<ExerciseTrial> trials_;
  std::vector<ExerciseRating> ratings_;

  bool any_step_ = false;
  double time_ = 0.0;  ///< of the last observation [s]
  double active_s_ = 0.0;
  double phase_s_ = 0.0;      ///< active time in the phase [s]
  bool torque_seen_ = false;  ///< the torque was on since it is demanded
  bool armed_ = false;        ///< the stimulus was set while the torque was off, and the torque may be on
  double contact_s_ = 0.0;    ///< time in contact with the object of this trial [s]
  bool pain_rated_ = false;   ///< in this rating
  bool fatigue_rated_ = false;
  int rated_at_ = 0;                    ///< trials before the newest rating
  std::optional<std::string> closing_;  ///< why it ends after the last ratings
  int repetitions_ = 0;
  int successes_ = 0;
  int counted_ = 0;
  bool interrupted_ = true;
  std::string ended_ = reason_text<Reason::kNotEnded>();
};

}  // namespace phalanx
