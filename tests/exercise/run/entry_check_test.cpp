// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "exercise/run/exercise_fixture.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;

/// Entry check of a person whose index finger bends to `most` and then opens to `least`, each spread over
/// two joints [deg].
EntryVerdict verdict_of(double most_deg, double least_deg, PersonLimits person = able_person()) {
  Bench bench(small_exercise(ExerciseMeasure::kEntryCheck), std::move(person));
  bool closed = false;
  bench.act = [&](Observation& observation, const ExerciseView& view) {
    const bool closes = view.target.kind == ExerciseTarget::Kind::kClose;
    if (view.phase != ExercisePhase::kTrial) closed = false;
    closed = closed || closes;
    const double degrees = closes ? most_deg : closed ? least_deg : 0.0;
    observation.angle[idx(joint_index(1, 0))] = 0.5 * degrees * kDeg;
    observation.angle[idx(joint_index(1, 2))] = 0.5 * degrees * kDeg;
  };
  bench.begin();
  EXPECT_TRUE(bench.until(ExercisePhase::kDone));
  return bench.run.result().entry.value_or(EntryVerdict{});
}

TEST(EntryCheck, MeasuresFlexionAndTheReleaseAfterIt) {
  const EntryVerdict verdict = verdict_of(50.0, 15.0);
  EXPECT_TRUE(verdict.suitable);
  EXPECT_EQ(verdict.text, "suitable");
  EXPECT_NEAR(verdict.flexion * kRadToDeg, 50.0, 1e-9);
  EXPECT_NEAR(verdict.release * kRadToDeg, 35.0, 1e-9);
}

TEST(EntryCheck, SaysWhatIsMissing) {
  const EntryVerdict weak = verdict_of(29.0, 0.0);
  EXPECT_FALSE(weak.suitable);
  EXPECT_EQ(
      weak.text,
      "not suitable on this device (it resists, it does not assist): the index flexed by 29 of 30 degrees");
  const EntryVerdict clenched = verdict_of(60.0, 42.0);
  EXPECT_FALSE(clenched.suitable);
  EXPECT_THAT(clenched.text, HasSubstr("the index released by 18 of 20 degrees"));
}

TEST(EntryCheck, WithoutACalibrationThatIsIndependentOfThePersonIsNotKnown) {
  PersonLimits person = able_person();
  person.calibration_independent = false;
  const EntryVerdict verdict = verdict_of(60.0, 0.0, person);
  EXPECT_FALSE(verdict.suitable);
  EXPECT_THAT(verdict.text, HasSubstr("not known: not measured"));
}

}  // namespace
}  // namespace phalanx
