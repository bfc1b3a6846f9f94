// SPDX-License-Identifier: Apache-2.0
// A person and a device for tests of exercises: observations in equal steps, with forces and angles that
// a test sets.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/exercise/exercise_run.h"

namespace phalanx {

/// Person who can do every exercise.
inline PersonLimits able_person() {
  PersonLimits person;
  person.own_force.fill(5.0);
  person.own_range.fill(OwnRange{.min = 0.0, .max = 1.2});
  person.calibration_independent = true;
  person.stable_stiffness = 1e4;
  person.detects_slips = true;
  return person;
}

/// An exercise of a measure with short times, which check_exercise() accepts.
inline ExerciseDescription small_exercise(ExerciseMeasure measure) {
  ExerciseDescription exercise;
  exercise.name = "small";
  exercise.title = "a small exercise";
  exercise.scene = "index_ball";
  exercise.instruction = "Do it.";
  exercise.measure = measure;
  exercise.digits = {false, true, false, false, false};
  exercise.trials = 2;
  exercise.trial_s = 6.0;
  exercise.rest_s = 1.0;
  if (measure == ExerciseMeasure::kIndependence) exercise.digits[2] = true;
  if (measure == ExerciseMeasure::kFeelAndFind) exercise.trials = 10;
  if (measure == ExerciseMeasure::kObjectInHand)
    exercise.objects = {{.title = "ball", .kind = "sphere", .size = 0.05},
                        {.title = "cube", .kind = "box", .size = 0.04}};
  return exercise;
}

/// A training of press and hold.
inline ExerciseDescription small_training() {
  ExerciseDescription exercise = small_exercise(ExerciseMeasure::kPressAndHold);
  exercise.kind = ExerciseKind::kTraining;
  exercise.success = SuccessRule{.score = "time_in_target_share", .bound = 0.6, .at_most = false};
  exercise.difficulty = Difficulty{.tolerance = DifficultySpan{.easy = 0.4, .hard = 0.1}};
  return exercise;
}

/// Station and person: makes the observation of each step from what the run demands.
class Bench {
 public:
  static constexpr double kPeriod = 0.02;

  explicit Bench(ExerciseDescription exercise, PersonLimits person = able_person(), std::uint64_t seed = 7)
      : run(std::move(exercise), std::move(person), seed) {
    observation.angle_origin.fill(AngleOrigin::kMeasured);
    observation.measured_force.fill(std::numeric_limits<double>::quiet_NaN());
    observation.sent_stiffness.fill(std::numeric_limits<double>::quiet_NaN());
    observation.depth.fill(std::numeric_limits<double>::quiet_NaN());
  }

  /// Does one step. The station obeys the demand at once, unless `obeys` is false.
  void step() {
    ++observation.tick;
    observation.time = static_cast<double>(observation.tick) * kPeriod;
    observation.sample_time = observation.time;
    if (obeys) {
      observation.torque_on = run.demand().torque;
      observation.factor = run.demand().torque ? 1.0 : 0.0;
      if (run.demand().stiffness) observation.stiffness = *run.demand().stiffness;
    }
    act(observation, run.view());
    run.step(observation);
    answer_ratings();
  }
  void steps(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kPeriod + 0.5); ++i) step();
  }
  /// Steps until the phase begins. @returns true if it did, within a minute
  [[nodiscard]] bool until(ExercisePhase phase) {
    for (int i = 0; i < 3000 && run.view().phase != phase; ++i) step();
    return run.view().phase == phase;
  }
  std::string input(ExerciseInput::Kind kind, double value = 0.0) {
    std::string refused = run.input({.kind = kind, .value = value});
    answer_ratings();
    return refused;
  }
  void answer_ratings() {
    while (rates && run.view().asks) EXPECT_EQ(run.input({.kind = *run.view().asks, .value = rating}), "");
  }
  void begin() { EXPECT_EQ(input(ExerciseInput::Kind::kBegin), ""); }

  ExerciseRun run;
  Observation observation;
  bool obeys = true;
  bool rates = true;  ///< answers each rating that is asked for at once, by `rating`
  double rating = 0.0;
  /// What the person does: it changes the observation.
  std::function<void(Observation&, const ExerciseView&)> act = follow;

  /// Person who follows every target exactly.
  static void follow(Observation& observation, const ExerciseView& view) {
    observation.force.fill(0.0);
    observation.touching.fill(false);
    observation.sent_stiffness.fill(std::numeric_limits<double>::quiet_NaN());
    observation.depth.fill(std::numeric_limits<double>::quiet_NaN());
    const double phase = 0.5 - 0.5 * std::cos(0.5 * kPi * observation.time);
    observation.angle.fill(0.2);
    for (int digit = 0; digit < kDigits; ++digit) {
      const bool instructed = view.target.digits[idx(digit)];
      switch (view.target.kind) {
        case ExerciseTarget::Kind::kForce:
          if (instructed) observation.force[idx(digit)] = view.target.force[idx(digit)];
          break;
        case ExerciseTarget::Kind::kSqueeze:
          if (instructed) observation.force[idx(digit)] = 3.0;
          break;
        case ExerciseTarget::Kind::kClose:
        case ExerciseTarget::Kind::kAngle:
          if (instructed) observation.angle[idx(joint_index(digit, 0))] = 0.2 + phase;
          break;
        case ExerciseTarget::Kind::kExplore:
          if (instructed) {
            const double depth = 4e-3 * 6.0 * view.progress;  // 4 mm/s in a trial of 6 s [m]
            observation.touching[idx(digit)] = true;
            observation.force[idx(digit)] = observation.stiffness * depth;
            observation.sent_stiffness[idx(digit)] = observation.stiffness;
            observation.depth[idx(digit)] = depth;
          }
          break;
        default:
          break;
      }
    }
    observation.pad[0] = Vec3(0.0, 0.0, 0.03);
  }
};

}  // namespace phalanx
