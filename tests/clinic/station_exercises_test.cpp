// SPDX-License-Identifier: Apache-2.0
#include "phalanx/clinic/station_exercises.h"

#include <algorithm>
#include <stdexcept>

#include "clinic/exercise_clinic.h"
#include "clinic/exercise_order.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/record/recordings.h"

namespace phalanx::test {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class ClinicExercises : public ExerciseClinic {
 protected:
  void SetUp() override { begin_station(); }
};

/// Runs a call that is to be refused. @returns its words
template <class Refusal, class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const Refusal& refused) {
    return refused.what();
  }
  return "it was not refused";
}

TEST_F(ClinicExercises, AnExerciseIsCarriedOutAndItsResultIsKeptForItsPatientAlone) {
  ASSERT_TRUE(until_running());
  begin_exercise(sim1);
  const ExerciseStatus running = status();
  EXPECT_EQ(running.code, "SIM1");
  EXPECT_EQ(running.side, "right");
  EXPECT_TRUE(running.simulated);
  EXPECT_TRUE(running.demo);
  EXPECT_FALSE(running.forces_off);
  EXPECT_THAT(running.recording, EndsWith(".mcap.enc"));
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  EXPECT_EQ(status().trouble, "");
  ASSERT_TRUE(status().result.has_value());
  EXPECT_FALSE(status().result->interrupted) << status().result->ended;
  EXPECT_EQ(status().result->repetitions, 2);
  EXPECT_TRUE(session->held_stopped()) << "the station of the exercise begins again stopped";
  ASSERT_THAT(results(sim1), SizeIs(1));
  EXPECT_TRUE(results(sim1).front().valid) << results(sim1).front().invalid;
  EXPECT_EQ(results(sim1).front().recording, running.recording);
  EXPECT_THAT(results(sim2), IsEmpty());
}

TEST_F(ClinicExercises, WhatIsRecordedFromAnExerciseOnOpensWithItsPatientsKeyAlone) {
  std::vector<fs::path> all = {recorder->recording()->file};
  for (const Patient& patient : {sim1, sim2}) {
    begin_exercise(patient);
    all.push_back(folder / "rec" / status().recording);
    input(Kind::kAbort);
    ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
    pass(1.0);
    all.push_back(recorder->recording()->file);
  }
  end();
  EXPECT_THAT(files(), SizeIs(5)) << "before, SIM1, between, SIM2, after";
  EXPECT_THAT(all[0].string(), EndsWith(".mcap"));
  for (std::size_t i = 1; i < all.size(); ++i) {
    SCOPED_TRACE(all[i].string());
    EXPECT_THAT(all[i].string(), EndsWith(".mcap.enc"));
    const bool first = i < 3;
    const RecordingSummary own = summarise_recording(all[i], key_of(first ? sim1 : sim2));
    const RecordingSummary other = summarise_recording(all[i], key_of(first ? sim2 : sim1));
    EXPECT_EQ(recording_state(own), "whole");
    EXPECT_NE(recording_state(other), "whole");
  }
  EXPECT_THAT(recorded_exercises(all[1], key_of(sim1)), SizeIs(1));
  EXPECT_THAT(recorded_exercises(all[2], key_of(sim1)), IsEmpty());
}

TEST_F(ClinicExercises, AStopOfAnOnlookerPausesAndOnlyAResumeOfTheExerciseBringsForcesBack) {
  begin_exercise(sim1);
  session->stop();
  ASSERT_TRUE(until_phase(ExercisePhase::kPaused));
  EXPECT_TRUE(status().forces_off);
  pass(2.0);
  EXPECT_TRUE(session->held_stopped()) << "a simulated participant does not resume it";
  static_cast<void>(session->resume());  // a page of the cockpit
  ASSERT_TRUE(until([&] { return session->held_stopped(); }));
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(status().view.phase, ExercisePhase::kPaused);
  input(Kind::kResume);
  ASSERT_TRUE(until([&] { return session->view().state == SafetyState::kRunning; }));
  EXPECT_FALSE(session->held_stopped());
}

TEST_F(ClinicExercises, APauseStopsTheTorqueBeforeItReturns) {
  begin_exercise(sim1);
  ASSERT_FALSE(session->held_stopped());
  input(Kind::kPause);
  EXPECT_TRUE(session->held_stopped());
  ASSERT_TRUE(until_phase(ExercisePhase::kPaused));
  pass(1.0);
  EXPECT_TRUE(session->held_stopped());
  input(Kind::kResume);
  ASSERT_TRUE(until_phase(ExercisePhase::kTrial));
  input(Kind::kPain, 10.0);
  EXPECT_TRUE(session->held_stopped());
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  ASSERT_TRUE(status().result.has_value());
  EXPECT_THAT(status().result->ended, HasSubstr("pain 10 of 10"));
}

TEST_F(ClinicExercises, AStopAfterAResumeWins) {
  begin_exercise(sim1);
  input(Kind::kPause);
  ASSERT_TRUE(until_phase(ExercisePhase::kPaused));
  input(Kind::kResume);
  session->stop();  // before the owner's thread has taken the resume
  pass(1.0);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_THAT(said, ::testing::Contains(HasSubstr("not resumed: another stop has come since")));
  input(Kind::kResume);
  EXPECT_TRUE(until([&] { return !session->held_stopped(); }));
}

TEST_F(ClinicExercises, AResumeEndsNoStopThatItsPersonHasNotSeen) {
  begin_exercise(sim1);
  input(Kind::kPause);
  ASSERT_TRUE(until_phase(ExercisePhase::kPaused));
  const std::uint64_t seen = status().stops;
  session->stop();
  EXPECT_THAT(refusal<std::runtime_error>(
                  [&] { exercises->input({.kind = Kind::kResume}, {.stops = seen, .account = "chief"}); }),
              HasSubstr("another stop has come since"));
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  exercises->input({.kind = Kind::kResume}, {.stops = status().stops, .account = "chief"});
  EXPECT_TRUE(until([&] { return !session->held_stopped(); }));
  EXPECT_THAT(said, ::testing::Contains("the exercise was resumed by chief"));
}

TEST_F(ClinicExercises, AStopWhileTheStationOpensKeepsForcesOffUntilAResume) {
  ASSERT_TRUE(until_running());
  static_cast<void>(order(sim1));
  session->stop();
  ASSERT_TRUE(until_stage(Stage::kRunning));
  input(Kind::kBegin);
  pass(1.0);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_TRUE(status().forces_off);
  input(Kind::kResume);
  EXPECT_TRUE(until([&] { return !session->held_stopped(); }));
}

TEST_F(ClinicExercises, APauseWhileTheStationOpensIsCountedOnce) {
  ASSERT_TRUE(until_running());
  static_cast<void>(order(sim1));
  input(Kind::kPause);
  ASSERT_TRUE(until_stage(Stage::kRunning));
  // Both before the first look at the inputs: the resume is older than the stop.
  input(Kind::kResume);
  session->stop();
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_THAT(said, ::testing::Contains(HasSubstr("not resumed")));
}

TEST_F(ClinicExercises, AnAbortedOpeningLeavesNoStepOfThePatientInThePlainRecording) {
  ASSERT_TRUE(until_running());
  const fs::path plain = recorder->recording()->file;
  static_cast<void>(order(sim1));
  ASSERT_TRUE(until([&] { return !session->info()->busy.empty() || status().stage != Stage::kOpening; }));
  if (status().stage == Stage::kOpening) input(Kind::kAbort);
  ASSERT_TRUE(until([&] {
    if (status().stage == Stage::kRunning) input(Kind::kAbort);
    return status().stage == Stage::kEnded;
  }));
  EXPECT_NE(recorder->recording()->file, plain) << "the station of the patient is in a recording of its own";
  EXPECT_THAT(recorder->recording()->file.string(), EndsWith(".mcap.enc"));
  for (const ResultRow& row : results(sim1)) EXPECT_EQ(row.repetitions, 0);
}

TEST_F(ClinicExercises, NoWordForTheLogNamesThePatientsCode) {
  begin_exercise(sim1);
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  EXPECT_THAT(said, Not(IsEmpty()));
  EXPECT_THAT(said, ::testing::Each(Not(HasSubstr("SIM1"))));
  EXPECT_EQ(without_code("SIM1 was changed; SIM12, xSIM1 and (SIM1)", "SIM1"),
            "the patient was changed; SIM12, xSIM1 and (the patient)");
  EXPECT_EQ(without_code("nothing", ""), "nothing");
}

TEST_F(ClinicExercises, AFaultPausesAndNeedsAResetAndAResume) {
  begin_exercise(sim1);
  EXPECT_EQ(status().fault, Fault::kNone);
  overload();
  ASSERT_TRUE(until([&] { return status().forces_off; }));
  EXPECT_EQ(status().fault, Fault::kOverload);
  input(Kind::kResume);
  pass(0.5);
  EXPECT_TRUE(status().forces_off) << "the fault is not reset";
  exercises->reset();
  ASSERT_TRUE(until([&] { return session->view().state != SafetyState::kFault; }));
  pass(2.0);
  EXPECT_EQ(status().fault, Fault::kNone);
  EXPECT_TRUE(session->held_stopped()) << "a reset alone brings no forces back";
  input(Kind::kResume);
  EXPECT_TRUE(until([&] { return session->view().state == SafetyState::kRunning; }));
}

TEST_F(ClinicExercises, WhatMustNotBeginIsRefusedInWordsBeforeTheStationChanges) {
  ASSERT_TRUE(until_running());
  const auto refuses = [&](const Patient& patient, ExerciseOrder wish) {
    wish.record = patient.record;
    return refusal<std::invalid_argument>([&] { static_cast<void>(exercises->begin(Actor::owner(), wish)); });
  };
  EXPECT_THAT(refuses(sim1, {.record = {}, .exercise = "short", .confirm = "SIM2", .demo = "healthy"}),
              HasSubstr("'SIM2' is not the code of patient SIM1"));
  EXPECT_THAT(refuses(sim1, {.record = {}, .exercise = "../short", .confirm = "SIM1", .demo = "healthy"}),
              HasSubstr("choose one of the list"));
  EXPECT_THAT(refuses(sim1, {.record = {}, .exercise = "no_such", .confirm = "SIM1", .demo = "healthy"}),
              HasSubstr("no_such"));
  const Patient person = registry->add_patient(Actor::owner(), ready_patient("P07"));
  EXPECT_THAT(refuses(person, {.record = {}, .exercise = "short", .confirm = "P07", .demo = "healthy"}),
              HasSubstr("never join those of a person"));
  EXPECT_THAT(refuses(person, {.record = {}, .exercise = "short", .confirm = "P07"}),
              HasSubstr("never join those of a person"))
      << "the simulated device";
  Patient without = ready_patient("SIM3");
  without.consent = false;
  without = registry->add_patient(Actor::owner(), without);
  EXPECT_THAT(refuses(without, {.record = {}, .exercise = "short", .confirm = "SIM3", .demo = "healthy"}),
              HasSubstr("consent"));
  EXPECT_EQ(status().stage, Stage::kNone);
  pass(0.2);
  EXPECT_FALSE(session->held_stopped());
  EXPECT_THAT(files(), SizeIs(1));
  EXPECT_THAT(refusal<std::invalid_argument>([&] { input(Kind::kPause); }), HasSubstr("no exercise runs"));
  static_cast<void>(order(sim1));
  EXPECT_THAT(refusal<std::runtime_error>([&] { static_cast<void>(order(sim2)); }),
              HasSubstr("another exercise runs"));
}

TEST_F(ClinicExercises, AnExerciseThatRunsWhenTheProgramEndsKeepsWhatItHasMeasured) {
  begin_exercise(sim1);
  pass(0.5);
  end();
  EXPECT_EQ(status().stage, Stage::kEnded);
  ASSERT_TRUE(status().result.has_value()) << status().trouble;
  EXPECT_TRUE(status().result->interrupted);
  ASSERT_THAT(results(sim1), SizeIs(1));
  EXPECT_TRUE(results(sim1).front().interrupted);
  EXPECT_THAT(refusal<std::runtime_error>([&] { static_cast<void>(order(sim1)); }),
              HasSubstr("the program ends"));
}

TEST_F(ClinicExercises, ARecordingThatAKilledProgramHasLeftIsTakenUpBeforeTheNextExercise) {
  begin_exercise(sim1);
  ASSERT_TRUE(until([&] { return status().view.trial == 2; }));
  // The file as a program that is killed now leaves it, under another name.
  const fs::path torn = folder / "rec" / "torn.mcap.enc";
  pass(0.5);
  fs::copy_file(folder / "rec" / status().recording, torn);
  registry->add_recording(Actor::owner(), sim1.record, "torn.mcap.enc");
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  ASSERT_THAT(results(sim1), SizeIs(1));
  static_cast<void>(order(sim1));
  const std::vector<ResultRow> rows = results(sim1);
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [](const ResultRow& row) {
    return row.recording == "torn.mcap.enc" && row.repetitions == 1;
  }));
}

/// A disk without room for another recording.
class ClinicWithoutRoom : public ExerciseClinic {
 protected:
  StationExercisesSettings clinic_settings() override {
    StationExercisesSettings settings = ExerciseClinic::clinic_settings();
    settings.recording.least_room = ~std::uint64_t{0};
    return settings;
  }
};

TEST_F(ClinicWithoutRoom, AnExerciseThatCannotBeRecordedDoesNotBegin) {
  begin_station();
  ASSERT_TRUE(until_running());
  const std::string scene = session->info()->scene;
  static_cast<void>(order(sim1));
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  EXPECT_THAT(status().trouble, HasSubstr("the exercise cannot begin"));
  EXPECT_FALSE(status().result.has_value());
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(session->info()->scene, scene);
  EXPECT_THAT(files(), SizeIs(1));
}

/// A station that logs its steps.
class ClinicWithLog : public ExerciseClinic {
 protected:
  StationExercisesSettings clinic_settings() override {
    StationExercisesSettings settings = ExerciseClinic::clinic_settings();
    settings.plain_log = "steps.csv";
    return settings;
  }
};

TEST_F(ClinicWithLog, APlainLogOfTheStepsPreventsExercises) {
  begin_station();
  EXPECT_THAT(refusal<std::runtime_error>([&] { static_cast<void>(order(sim1)); }),
              HasSubstr("--log steps.csv"));
}

}  // namespace
}  // namespace phalanx::test
