// SPDX-License-Identifier: Apache-2.0
// What a recording that was found late may still change of a patient, by take_late().
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "phalanx/clinic/exercise_patient.h"

namespace phalanx {
namespace {

constexpr double kNoon = 1'772'366'400.0;  // 2026-03-01T12:00:00Z [s since 1970]

/// A recorded own force of the index finger, that has its result.
RecordedExercise own_force(double force, double utc) {
  RecordedExercise out;
  out.number = 1;
  out.begin_utc = utc;
  out.start.record = std::string(32, 'a');
  out.start.exercise.name = "own_force";
  out.start.exercise.measure = ExerciseMeasure::kOwnForce;
  out.start.conditions = {{"side", "right"}};
  out.result.name = "own_force";
  out.result.kind = ExerciseKind::kAssessment;
  out.result.measure = ExerciseMeasure::kOwnForce;
  out.result.scores = {{.name = "index_peak_force_n",
                        .unit = "N",
                        .value = force,
                        .origin = ScoreOrigin::kRendered,
                        .invalid = {}}};
  return out;
}

Patient patient_with(double force) {
  Patient out;
  out.record = std::string(32, 'a');
  out.code = "P07";
  out.own_force_n[1] = force;
  return out;
}

TEST(LateMeasurement, FillsInAnOwnForceThatIsNotKnown) {
  Patient patient = patient_with(0.0);
  EXPECT_TRUE(take_late(patient, own_force(6.5, kNoon), "a.mcap", {}));
  EXPECT_EQ(patient.own_force_n[1], 6.5);
}

// 4 N that a person has entered, perhaps after the recording: 12 N would raise targets of forces.
TEST(LateMeasurement, NeverReplacesAnOwnForceThatAPersonHasEntered) {
  Patient patient = patient_with(4.0);
  EXPECT_FALSE(take_late(patient, own_force(12.0, kNoon), "a.mcap", {}));
  EXPECT_EQ(patient.own_force_n[1], 4.0);
}

TEST(LateMeasurement, ReplacesAnOwnForceThatAnEarlierResultHasMeasured) {
  const std::vector<ResultRow> known = {result_row(own_force(5.25, kNoon - 86400.0), "before.mcap")};
  Patient patient = patient_with(5.25);
  EXPECT_TRUE(take_late(patient, own_force(6.5, kNoon), "a.mcap", known));
  EXPECT_EQ(patient.own_force_n[1], 6.5);
}

TEST(LateMeasurement, NeverReplacesWhatALaterResultHasMeasured) {
  const std::vector<ResultRow> known = {result_row(own_force(5.25, kNoon + 86400.0), "later.mcap")};
  Patient patient = patient_with(5.25);
  EXPECT_FALSE(take_late(patient, own_force(6.5, kNoon), "a.mcap", known));
  EXPECT_EQ(patient.own_force_n[1], 5.25);
}

TEST(LateMeasurement, TakesNothingFromARecordingThatStatesNoSideOrTheOther) {
  Patient patient = patient_with(0.0);
  RecordedExercise exercise = own_force(6.5, kNoon);
  exercise.start.conditions.clear();
  EXPECT_FALSE(take_late(patient, exercise, "a.mcap", {}));
  exercise.start.conditions = {{"side", "left"}};
  EXPECT_FALSE(take_late(patient, exercise, "a.mcap", {}));
  EXPECT_EQ(patient.own_force_n[1], 0.0);
}

}  // namespace
}  // namespace phalanx
