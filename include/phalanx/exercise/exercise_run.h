// SPDX-License-Identifier: Apache-2.0
// An exercise that is carried out: a state machine from observations and inputs to a view, a
// demand and a result.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// State of a run.
enum class ExercisePhase : std::uint8_t {
  kReady,   ///< waits for `begin`; no torque
  kWarmUp,  ///< free movement
  kRating,  ///< waits for `pain` and `fatigue`; no torque. It ends without them after kRatingWait
  kRest,    ///< the pause before a trial; ends when its time is over and the torque is fully on
  kTrial,   ///< observations are scored
  kAnswer,  ///< waits for `answer`
  kPaused,  ///< waits for `resume`; no torque
  kDone,    ///< no torque; result() is final
};
/// Returns "ready", "warm_up", "rating", "rest", "trial", "answer", "paused" or "done".
[[nodiscard]] std::string_view exercise_phase_name(ExercisePhase phase) noexcept;

/// Longest wait for the ratings of pain and fatigue, after which the run goes on without them [s].
inline constexpr double kRatingWait = 30.0;
/// Trials after which pain and fatigue are asked for again.
inline constexpr int kTrialsBetweenRatings = 20;
/// Least time for which an unseen object must be in contact with the hand before its answer is taken [s].
inline constexpr double kLeastContact = 1.0;

/// An input of a person.
struct ExerciseInput {
  enum class Kind : std::uint8_t {
    kBegin,
    kPause,  ///< the trial that runs is invalid and is repeated after `resume`
    kResume,
    kSkip,        ///< ends warm-up, rating or rest; a trial that runs is invalid and is not repeated
    kPain,        ///< value: 0 .. 10, whole
    kFatigue,     ///< value: 0 .. 10, whole
    kAnswer,      ///< value: number of the choice in ExerciseView::choices, from 1
    kAbort,       ///< ends the run; its result is interrupted
    kDifficulty,  ///< the therapist's override, from the next trial on; value: 0 .. 1; a training only
  };
  Kind kind = Kind::kBegin;
  double value = 0.0;
  [[nodiscard]] bool operator==(const ExerciseInput&) const = default;
};
/// Returns the name in files and at the terminal: "begin", "pause", "resume", "skip", "pain", "fatigue",
/// "answer", "abort" or "difficulty".
[[nodiscard]] std::string_view exercise_input_name(ExerciseInput::Kind kind) noexcept;
/// Reads "begin", "pain 3", "answer 2", ...
/// @throws ExerciseError naming the text and the known inputs, or the missing or superfluous number
[[nodiscard]] ExerciseInput parse_exercise_input(std::string_view text);
/// Writes an input as parse_exercise_input() reads it; numbers in their shortest form.
[[nodiscard]] std::string exercise_input_text(const ExerciseInput& input);

/// What the participant should do now. Digits and joints without a target have NaN.
struct ExerciseTarget {
  enum class Kind : std::uint8_t {
    kNone,
    kForce,    ///< `force` on each instructed digit, within `low` .. `high`
    kAngle,    ///< `angle` of joints
    kOpen,     ///< open the hand as far as possible
    kClose,    ///< close the hand as far as possible
    kSqueeze,  ///< press with the instructed digits as strongly and quickly as comfortable
    kTouch,    ///< the thumb's pad to the pad of the instructed finger
    kExplore,  ///< press slowly to `depth`, then let go
    kChoose,   ///< give an answer
  };
  Kind kind = Kind::kNone;
  std::array<bool, kDigits> digits = {};
  std::array<double, kDigits> force = {};  ///< [N]
  double low = 0.0;                        ///< kForce: ends of the band [N]
  double high = 0.0;
  double depth = 0.0;     ///< kExplore: end position in the sponge; it says nothing about the stiffness [m]
  int sponge = -1;        ///< kExplore: 0 or 1, the first or the second of the pair
  JointArray angle = {};  ///< kAngle, kOpen, kClose: [rad]
};

/// What participant and therapist see. It has no property of a hidden stimulus: no stiffness,
/// order or object.
struct ExerciseView {
  ExercisePhase phase = ExercisePhase::kReady;
  std::string instruction = {};  ///< one line for the participant
  std::string note = {};  ///< last event in words ("trial 3 is repeated: samples were missing"); empty: none
  int trial = 0;          ///< from 1; 0: none began
  int trials = 0;         ///< planned
  double progress = 0.0;  ///< of the phase, 0 .. 1
  double remaining_s = 0.0;  ///< of the phase [s]; 0: it does not end by time
  ExerciseTarget target = {};
  /// Sum or angle that the target refers to; none: the measure has no value to show [N] or [deg]
  std::optional<double> value = {};
  std::string value_unit = {};            ///< "N", "deg"; empty without a value
  std::vector<std::string> choices = {};  ///< the answers that are allowed now
  /// Rating that is asked for now: kPain or kFatigue; none: no rating
  std::optional<ExerciseInput::Kind> asks = {};
  bool hides_scene = false;  ///< hand, object and forces must not be shown or heard now
  int successes = 0;         ///< training: successful trials
  int counted = 0;           ///< training: valid trials
};

/// What the station should do now. It never exceeds LoweredLimits, PersonLimits or the scene.
struct ExerciseDemand {
  std::optional<int> object = {};  ///< index in ExerciseDescription::objects; a change needs zero torque
  std::optional<double> stiffness = {};  ///< of the force law [N/m]; none: the scene's
  bool torque = false;                   ///< false: the station stops, with its own ramp
  [[nodiscard]] bool operator==(const ExerciseDemand&) const = default;
};

/// A self-rating.
struct ExerciseRating {
  double time = 0.0;  ///< of the observation before it [s]
  ExerciseInput::Kind kind = ExerciseInput::Kind::kPain;
  int value = 0;  ///< 0 .. 10
};

/// One trial that ran.
struct ExerciseTrial {
  int number = 0;      ///< of the plan, from 1; a repeated trial has the number of the first attempt
  double begin = 0.0;  ///< time of its first observation [s]
  double end = 0.0;    ///< time of its last observation [s]
  std::optional<double> difficulty = {};  ///< training only
  std::string condition = {};             ///< "thumb to ring", "pair 3", "ball"; empty: none
  /// Conditions that the scores refer to: force [N] or flexion [rad], half width of the band as a share of it
  /// [-], frequency [Hz]
  std::optional<double> target = {};
  std::optional<double> tolerance = {};
  std::optional<double> rate_hz = {};
  std::vector<Score> scores = {};
  std::string invalid = {};          ///< why the trial does not count; empty: it counts
  std::optional<bool> success = {};  ///< training: of a valid trial
};

/// Verdict of kEntryCheck.
struct EntryVerdict {
  bool suitable = false;
  double flexion = 0.0;  ///< least of the instructed digits [rad]
  double release = 0.0;  ///< least of the instructed digits [rad]
  std::string text =
      {};  ///< "suitable", or "not suitable on this device (it resists, it does not assist): ..."
};

/// What a run has measured.
struct ExerciseResult {
  std::string name = {};
  ExerciseKind kind = ExerciseKind::kAssessment;
  ExerciseMeasure measure = ExerciseMeasure::kRangeOfMotion;
  std::vector<ExerciseTrial> trials = {};
  /// Of the whole exercise: means of the valid trials by name; kFeelAndFind, kObjectInHand: of all answers
  std::vector<Score> scores = {};
  /// It ended before its last trial. A training that the day's dose ended is not interrupted; an
  /// assessment is, unless every planned trial is valid, or for kFeelAndFind and kObjectInHand the last
  /// stimulus was answered
  bool interrupted = false;
  std::string ended = {};                 ///< why it ended, in words
  double seconds = 0.0;                   ///< active: without the time before `begin` and the pauses [s]
  int repetitions = 0;                    ///< trials that ran
  int successes = 0;                      ///< training
  int counted = 0;                        ///< training: valid trials
  std::optional<double> difficulty = {};  ///< training: of the last trial, or of the session's begin
  std::vector<ExerciseRating> ratings = {};
  std::optional<EntryVerdict> entry = {};  ///< kEntryCheck
};

/// @returns the result as canonical JSON: fixed order of keys, numbers in the shortest form that reads back
/// the same. Equal results make equal bytes.
[[nodiscard]] std::string exercise_result_text(const ExerciseResult& result);

/// An exercise that is carried out. It knows no clock, thread, network or device: equal observations and
/// inputs in equal order make equal views, demands and results. A trial is scored at its end.
///
/// Order: ready; after `begin` the warm-up; then for each trial a rest, the trial, and for some measures an
/// answer; done. Pain and fatigue are asked for after the warm-up, after each kTrialsBetweenRatings trials,
/// and at the end. Of a hidden stimulus nothing is felt outside of its trial: the torque is off before it and
/// while an answer is awaited. A trial with a fault, a gap or torque that was not fully on is invalid and is
/// repeated. No more trials are repeated than were planned. A pain or fatigue at its limit, and the day's
/// dose, end the run. Not real-time: allocates, and scores at the end of a trial.
class ExerciseRun {
 public:
  /// @throws ExerciseError as check_exercise() and check_person()
  ExerciseRun(ExerciseDescription exercise, PersonLimits person, std::uint64_t seed);
  ~ExerciseRun();
  ExerciseRun(ExerciseRun&&) noexcept;
  ExerciseRun& operator=(ExerciseRun&&) noexcept;
  ExerciseRun(const ExerciseRun&) = delete;
  ExerciseRun& operator=(const ExerciseRun&) = delete;

  /// Takes the next observation. A time that does not rise is treated as a gap.
  void step(const Observation& observation);
  /// Takes an input, which acts at once, at the time of the last observation.
  /// @returns why it is refused in this phase, in words; empty: it was taken
  [[nodiscard]] std::string input(const ExerciseInput& input);

  [[nodiscard]] const ExerciseView& view() const noexcept;
  [[nodiscard]] const ExerciseDemand& demand() const noexcept;
  [[nodiscard]] bool done() const noexcept;
  /// @returns what was measured so far; before done(), an interrupted result
  [[nodiscard]] ExerciseResult result() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// @returns the limits with own force and own range from the result of an assessment that measures them
/// (kOwnForce, kRangeOfMotion); of another result, and of invalid scores, nothing is taken
[[nodiscard]] PersonLimits with_measured(PersonLimits person, const ExerciseResult& result);

}  // namespace phalanx
