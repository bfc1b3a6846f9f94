// SPDX-License-Identifier: Apache-2.0
// An exercise as its file describes it, in SI units, and the limits of the person who does it.
// docs/exercises.md explains both; scene/exercise_file.h reads and writes the files, exercise_run.h
// carries an exercise out.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/core/number_range.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Error of an exercise or of a prescription. what() names the key, the value and the remedy.
class ExerciseError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Purpose of an exercise.
enum class ExerciseKind : std::uint8_t {
  kTraining,    ///< adapts its difficulty from session to session; makes no trend
  kAssessment,  ///< has fixed conditions and never adapts; only assessments make trends
};

/// Quantity that an exercise measures. It decides what a trial is and which scores
/// it has (docs/exercises.md).
enum class ExerciseMeasure : std::uint8_t {
  kRangeOfMotion,      ///< smallest and largest angle of each joint
  kTotalActiveMotion,  ///< TAM of each digit
  kPressAndHold,       ///< a constant target force
  kForceTracking,      ///< a target force that moves as a sine
  kSqueezeRelease,     ///< a quick squeeze, and a quick release
  kPinch,              ///< an object held between the thumb and other digits
  kOpposition,         ///< the thumb's pad to each fingertip in turn
  kIndependence,       ///< one digit moves, the others rest
  kSmoothness,         ///< movements to and fro between two angles
  kFeelAndFind,        ///< which of two sponges is softer
  kObjectInHand,       ///< which object is in the hand, unseen
  kOwnForce,           ///< the person's own maximal force
  kEntryCheck,         ///< the least active flexion and release that the device needs
};
inline constexpr int kExerciseMeasures = 13;

/// Returns the name in files: "training" or "assessment".
[[nodiscard]] std::string_view exercise_kind_name(ExerciseKind kind) noexcept;
/// Returns the name in files: "range_of_motion", ...
[[nodiscard]] std::string_view exercise_measure_name(ExerciseMeasure measure) noexcept;
/// Returns the measure of this name, if there is one.
[[nodiscard]] std::optional<ExerciseMeasure> find_exercise_measure(std::string_view name) noexcept;
/// @returns true if a trial's target is a share of the person's own maximal force
[[nodiscard]] bool needs_own_force(ExerciseMeasure measure) noexcept;
/// @returns true if a trial's target is a share of the person's own range of motion
[[nodiscard]] bool needs_own_range(ExerciseMeasure measure) noexcept;
/// @returns true if forces are needed: a device that only measures angles cannot do it, and torque is on
/// in its trials
[[nodiscard]] bool needs_torque(ExerciseMeasure measure) noexcept;
/// @returns true if a trial instructs one digit, so that each instructed digit has `trials` trials of its own
[[nodiscard]] bool digits_in_turn(ExerciseMeasure measure) noexcept;
/// @returns true if a participant answers by a number: kFeelAndFind, kObjectInHand
[[nodiscard]] bool has_answers(ExerciseMeasure measure) noexcept;

/// Value of a parameter at difficulty 0 (easy) and 1 (hard); between them it is linear.
struct DifficultySpan {
  double easy = 0.0;
  double hard = 0.0;
  [[nodiscard]] double at(double difficulty) const noexcept { return easy + difficulty * (hard - easy); }
  [[nodiscard]] bool operator==(const DifficultySpan&) const = default;
};

/// How a training adapts. An assessment has none.
struct Difficulty {
  double start = 0.3;           ///< difficulty of the first session, 0 .. 1 [-]
  double target_success = 0.7;  ///< share of successful trials that it steers to, 0.5 .. 0.9 [-]
  std::optional<DifficultySpan> target = {};     ///< replaces ExerciseDescription::target [-]
  std::optional<DifficultySpan> tolerance = {};  ///< replaces ExerciseDescription::tolerance [-]
  std::optional<DifficultySpan> rate_hz = {};    ///< replaces ExerciseDescription::rate_hz [Hz]
  std::optional<DifficultySpan> success = {};    ///< replaces SuccessRule::bound, in the score's unit
  [[nodiscard]] bool operator==(const Difficulty&) const = default;
};

/// Rule by which a trial of a training is successful: a score at or above its bound (or at or below it).
struct SuccessRule {
  std::string score = {};  ///< Score::name of a trial
  double bound = 0.0;      ///< in the score's unit
  bool at_most = false;    ///< true: the score must not exceed the bound
  [[nodiscard]] bool operator==(const SuccessRule&) const = default;
};

/// Largest dose of an exercise on one day. A prescription may lower it, never raise it.
struct DoseCap {
  int repetitions = 100;  ///< trials that ran, whether valid or not
  double minutes = 30.0;  ///< active time: warm-up, rests, trials and answers; pauses do not count [min]
  [[nodiscard]] bool operator==(const DoseCap&) const = default;
};

/// Self-ratings at which an exercise ends, 0 .. 10: a rating at or above its limit ends it.
struct RatingLimits {
  int pain = 5;
  int fatigue = 8;
  [[nodiscard]] bool operator==(const RatingLimits&) const = default;
};

/// Limits that an exercise sets below those of its scene. apply_exercise() takes the smaller one of each
/// pair, so that no number here can raise a limit.
struct LoweredLimits {
  std::optional<double> stiffness = {};  ///< of the force law [N/m]
  std::optional<double> force = {};      ///< fingertip force [N]
  std::optional<double> torque = {};     ///< joint torque [Nm]
  [[nodiscard]] bool operator==(const LoweredLimits&) const = default;
};

/// Stimuli of kFeelAndFind; discrimination.h explains them. The stiffest stimulus also respects LoweredLimits
/// and PersonLimits with the device's stable zone.
struct FeelStimuli {
  double softest = 100.0;      ///< [N/m]
  double stiffest = 700.0;     ///< [N/m]
  double largest_force = 3.0;  ///< no end position needs more [N]
  double deep = 5e-3;          ///< deeper one of the two end positions [m]
  [[nodiscard]] bool operator==(const FeelStimuli&) const = default;
};

/// One object of kObjectInHand. All other properties are the scene's.
struct ObjectChoice {
  std::string title = {};       ///< shown as an answer: "a ball"
  std::string kind = "sphere";  ///< "sphere", "box" or "cylinder"
  double size = 0.05;           ///< diameter, edge, or diameter and length [m]
  [[nodiscard]] bool operator==(const ObjectChoice&) const = default;
};

/// Least active motion of each instructed digit that a device needs which resists and does not assist.
struct EntryRequirement {
  double flexion =
      30.0 * kDeg;  ///< largest sum of the digit's three flexion angles less the smallest before it [rad]
  double release = 20.0 * kDeg;  ///< fall of that sum from its largest value, afterwards [rad]
  [[nodiscard]] bool operator==(const EntryRequirement&) const = default;
};

/// Content of an exercise file. The default of each field is that of its key.
struct ExerciseDescription {
  std::string name = {};      ///< the file's name without ".toml"
  std::string title = {};     ///< for people, one line
  std::string title_de = {};  ///< the same in German; empty: none
  ExerciseKind kind = ExerciseKind::kAssessment;
  ExerciseMeasure measure = ExerciseMeasure::kRangeOfMotion;
  std::string scene = {};  ///< name of a scene
  /// Instructed digits. kPinch, kOpposition: the fingers beside the thumb. kIndependence: each of
  /// them in turn.
  std::array<bool, kDigits> digits = {true, true, true, true, true};
  std::string instruction = {};  ///< for the participant, during a trial
  int trials = 3;
  double trial_s = 10.0;   ///< length of a trial [s]
  double rest_s = 5.0;     ///< before each trial [s]
  double warm_up_s = 0.0;  ///< free movement before the first trial [s]
  double target = 0.5;     ///< share of the own force or range, or the centre of the moving target [-]
  double tolerance = 0.1;  ///< half width of the band around the target, as a share of it [-]
  double rate_hz = 0.2;    ///< kForceTracking: frequency of the moving target [Hz]
  std::optional<SuccessRule> success = {};    ///< training only
  std::optional<Difficulty> difficulty = {};  ///< training only
  DoseCap dose = {};
  RatingLimits ratings = {};
  LoweredLimits limits = {};
  FeelStimuli feel = {};                   ///< kFeelAndFind only
  std::vector<ObjectChoice> objects = {};  ///< kObjectInHand only
  EntryRequirement entry = {};             ///< kEntryCheck only
  [[nodiscard]] bool operator==(const ExerciseDescription&) const = default;
};

/// Allowed values of the numbers above, in SI units.
namespace exercise_ranges {
inline constexpr NumberRange kTrials = between(1, 60);
inline constexpr NumberRange kTrialSeconds = between(1, 60);      ///< [s]
inline constexpr NumberRange kRest = between(0, 120);             ///< [s]
inline constexpr NumberRange kWarmUp = between(0, 600);           ///< [s]
inline constexpr NumberRange kShare = between(0.05, 1);           ///< [-]
inline constexpr NumberRange kTolerance = between(0.02, 0.5);     ///< [-]
inline constexpr NumberRange kRate = between(0.02, 2);            ///< [Hz]
inline constexpr NumberRange kDifficulty = between(0, 1);         ///< [-]
inline constexpr NumberRange kTargetSuccess = between(0.5, 0.9);  ///< [-]
inline constexpr NumberRange kBound = between(-1'000, 1'000);     ///< in the score's unit
inline constexpr NumberRange kRepetitions = between(1, 500);
inline constexpr NumberRange kMinutes = between(1, 120);  ///< [min]
inline constexpr NumberRange kRating = between(1, 10);    ///< 0 .. 10; a limit of 0 would end every exercise
inline constexpr NumberRange kStiffness = between(50, 20'000);   ///< [N/m]
inline constexpr NumberRange kForce = above(0, 15);              ///< [N]
inline constexpr NumberRange kTorque = above(0, 5);              ///< [Nm]
inline constexpr NumberRange kDepth = between(1e-3, 0.02);       ///< [m]
inline constexpr NumberRange kObjectSize = between(0.02, 0.12);  ///< [m]
inline constexpr NumberRange kEntryAngle = between(0, kPi);      ///< [rad]
}  // namespace exercise_ranges

/// @returns the number of trials of the whole exercise, of all digits and objects that come in turn;
/// kFeelAndFind: the largest number of pairs
[[nodiscard]] int repetitions_of(const ExerciseDescription& exercise);

/// Checks a description by itself: every number in its range, the keys that its kind and measure
/// need or forbid.
/// @throws ExerciseError naming the key, the value and the remedy. Set-up only.
void check_exercise(const ExerciseDescription& exercise);

/// Smallest and largest angle that the person reached without help [rad].
struct OwnRange {
  double min = 0.0;
  double max = 0.0;
  [[nodiscard]] bool operator==(const OwnRange&) const = default;
};

/// What a person can do, may do, and has done today. It belongs to one person on one device.
struct PersonLimits {
  std::array<std::optional<double>, kDigits> own_force = {};    ///< own maximal force [N]; none: not measured
  std::array<std::optional<OwnRange>, kJoints> own_range = {};  ///< none: not measured
  /// Digits whose angles and forces belong to a sensor and a motor; digits that copy another one are false.
  std::array<bool, kDigits> felt = {true, true, true, true, true};
  /// The calibration does not depend on what this person can reach; without it, angles in degrees
  /// are not measured.
  bool calibration_independent = false;
  double force_cap = 5.0;      ///< largest fingertip force of the station [N]
  double stiffness_cap = 1e5;  ///< largest stiffness for this person [N/m]
  /// Largest stiffness at which this device is stable with this scene and stabiliser: measured, or stated by
  /// the person who answers for the device; none: not known [N/m]
  std::optional<double> stable_stiffness = {};
  bool detects_slips = false;  ///< the scene's contacts can slide, so that a slip is seen
  int repetitions_today = 0;   ///< of this exercise, before this run
  double minutes_today = 0.0;  ///< of this exercise, before this run [min]
  std::optional<double> difficulty =
      {};  ///< of a training's session, from next_difficulty(); none: Difficulty::start
  [[nodiscard]] bool operator==(const PersonLimits&) const = default;
};

/// Checks that this person can do the exercise now. Own force and range are known where a target is a share
/// of them. The instructed digits (one of them at least, if they come in turn) belong to a sensor. The day's
/// dose is not used up. For kFeelAndFind the largest stable stiffness is known; ExerciseRun refuses a stable
/// zone that is too narrow.
/// @throws ExerciseError naming the reason, the value and the remedy (the assessment that measures
/// what is missing).
void check_person(const ExerciseDescription& exercise, const PersonLimits& person);

}  // namespace phalanx
