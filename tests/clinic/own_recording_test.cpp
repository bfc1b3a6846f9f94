// SPDX-License-Identifier: Apache-2.0
// What a station records when the patient of its last exercise is deleted, and what a deletion is refused for.
#include <atomic>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "clinic/exercise_clinic.h"
#include "phalanx/record/recordings.h"

namespace phalanx::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class OwnRecordings : public ExerciseClinic {
 protected:
  void SetUp() override {
    begin_station();
    ASSERT_TRUE(until_running());
  }
  /// Lets the station go from a patient's key as the page's thread does, while the owner works. @returns why it is refused
  std::string release_key(const Patient& patient) {
    std::string refused;
    std::atomic<bool> done = false;
    std::thread page([&] {
      try {
        exercises->release_key(patient.record);
      } catch (const std::runtime_error& error) {
        refused = error.what();
      }
      done = true;
    });
    EXPECT_TRUE(until([&] { return done.load(); }));
    page.join();
    return refused;
  }
  /// Deletes a patient as `phalanx patient delete` does: another program with the same files. @returns why it is refused
  std::string delete_by_command(const Patient& patient) const {
    try {
      static_cast<void>(
          make_registry(folder.path() / "clinic", clocks)->delete_patient(Actor::owner(), patient.record));
    } catch (const RegistryError& error) {
      EXPECT_EQ(error.fault(), RegistryFault::kConflict);
      return error.what();
    }
    return {};
  }
  /// Carries out an exercise that ends early. @returns its recording, and the one after it
  std::pair<fs::path, fs::path> carry_out(const Patient& patient) {
    begin_exercise(patient);
    const fs::path file = folder / "rec" / status().recording;
    input(Kind::kAbort);
    EXPECT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
    EXPECT_EQ(status().trouble, "");
    pass(0.5);
    return {file, recorder->recording()->file};
  }
  static std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(OwnRecordings, BeginBeforeTheKeyIsErasedOnTheStationAsItWasBeforeTheFirstExercise) {
  const auto before = session->info();
  const auto [exercise, between] = carry_out(sim1);
  ASSERT_THAT(between.string(), EndsWith(".mcap.enc"));
  ASSERT_NE(session->info()->scene, before->scene);
  static_cast<void>(session->resume());
  ASSERT_TRUE(until_running());
  const FindRecordingKey key = key_of(sim1);

  EXPECT_EQ(release_key(sim1), "");

  const fs::path own = recorder->recording()->file;
  EXPECT_THAT(own.string(), EndsWith(".mcap"));
  EXPECT_EQ(session->info()->scene, before->scene);
  EXPECT_EQ(session->info()->overrides, before->overrides);
  EXPECT_EQ(session->info()->source, before->source);
  EXPECT_TRUE(session->held_stopped()) << "a station that a page has not asked for begins stopped";
  const RecordingSummary last = summarise_recording(between, key);
  EXPECT_EQ(recording_state(last), "whole") << "no step of the patient is lost";
  EXPECT_GT(last.steps, 0U);
  EXPECT_EQ(status().stage, Stage::kNone);
  EXPECT_EQ(status().code, "");
  EXPECT_FALSE(status().result.has_value()) << "the patient's result is forgotten";

  static_cast<void>(registry->delete_patient(Actor::owner(), sim1.record));
  pass(1.0);
  EXPECT_EQ(recorder->recording()->file, own);
  end();
  EXPECT_FALSE(recording_state(summarise_recording(exercise, registry->keys().finder())) == "whole");
  const RecordingSummary summary = summarise_recording(own);
  EXPECT_EQ(recording_state(summary), "whole") << "it needs no key";
  EXPECT_GT(summary.steps, 200U) << "all of the second after the deletion";
  EXPECT_THAT(said, Contains(AllOf(HasSubstr("without a patient's key"), HasSubstr(own.filename().string()),
                                   Not(HasSubstr("SIM1")))));
}

TEST_F(OwnRecordings, KeepASceneThatWasLoadedAfterTheExercise) {
  static_cast<void>(carry_out(sim1));
  ASSERT_EQ(load("pinch_ball"), "");
  ASSERT_EQ(release_key(sim1), "");
  EXPECT_EQ(session->info()->scene, "pinch_ball");
  EXPECT_THAT(session->info()->overrides, IsEmpty()) << "the patient's hand and limits are not in it";
  EXPECT_TRUE(session->held_stopped());
  EXPECT_THAT(recorder->recording()->file.string(), EndsWith(".mcap"));
}

TEST_F(OwnRecordings, HaveNothingOfTheExerciseInPlainText) {
  const auto [exercise, between] = carry_out(sim1);
  ASSERT_EQ(release_key(sim1), "");
  const fs::path own = recorder->recording()->file;
  pass(0.2);
  end();
  const RecordingContent content = read_recording(own);
  for (const auto& event : content.events) {
    EXPECT_THAT(event.code, Not(HasSubstr("exercise"))) << event.text;
    EXPECT_THAT(event.text, AllOf(Not(HasSubstr(sim1.record)), Not(HasSubstr("SIM1"))));
  }
  const RecordingSummary summary = summarise_recording(own);
  EXPECT_EQ(summary.scene, "first_touch") << "it begins with the station's own, not with the patient's";
  EXPECT_THAT(bytes_of(own), Not(HasSubstr(sim1.record)));
}

TEST_F(OwnRecordings, ACommandCannotDeleteAPatientWithWhoseKeyAStationRecords) {
  begin_exercise(sim1);
  EXPECT_EQ(delete_by_command(sim2), "") << "no station has used this key";
  const auto is_refused = AllOf(HasSubstr("records with the key of this patient"), HasSubstr("process"),
                                HasSubstr("on the page of that station"));
  EXPECT_THAT(delete_by_command(sim1), is_refused);
  EXPECT_EQ(session->view().state, SafetyState::kRunning) << "the exercise goes on";
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  pass(0.5);
  EXPECT_THAT(delete_by_command(sim1), is_refused) << "what is recorded now needs the key, too";
  EXPECT_EQ(registry->patient(Actor::owner(), sim1.record).code, "SIM1") << "a refusal erases nothing";
  ASSERT_EQ(release_key(sim1), "");
  EXPECT_EQ(delete_by_command(sim1), "");
  EXPECT_THROW(static_cast<void>(registry->patient(Actor::owner(), sim1.record)), RegistryError);
}

TEST_F(OwnRecordings, ACommandDeletesAfterTheStationsProgramHasEnded) {
  static_cast<void>(carry_out(sim1));
  end();
  exercises.reset();
  EXPECT_EQ(delete_by_command(sim1), "");
}

TEST_F(OwnRecordings, AnExerciseThatRunsIsNotLeft) {
  begin_exercise(sim1);
  EXPECT_THAT(release_key(sim1), HasSubstr("an exercise of this patient runs; end it first"));
  EXPECT_FALSE(session->held_stopped());
  EXPECT_EQ(status().stage, Stage::kRunning);
  EXPECT_EQ(release_key(sim2), "") << "of a patient whose key is not in use nothing is to be left";
  EXPECT_FALSE(session->held_stopped());
}

TEST_F(OwnRecordings, AnotherPatientsExerciseFreesTheKeyOfTheOneBefore) {
  static_cast<void>(carry_out(sim1));
  begin_exercise(sim2);
  EXPECT_EQ(release_key(sim1), "");
  EXPECT_EQ(delete_by_command(sim1), "");
  EXPECT_EQ(session->view().state, SafetyState::kRunning) << "the exercise of the other patient goes on";
  EXPECT_EQ(status().code, "SIM2");
  const fs::path file = folder / "rec" / status().recording;
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  EXPECT_EQ(recording_state(summarise_recording(file, key_of(sim2))), "whole");
}

TEST_F(OwnRecordings, ThatTheDiskRefusesAreNamedAndNothingMoreIsWrittenWithTheKey) {
  const auto [exercise, between] = carry_out(sim1);
  const fs::path moved = folder / "rec_before";
  fs::rename(folder / "rec", moved);
  std::ofstream(folder / "rec") << "no folder";
  EXPECT_EQ(release_key(sim1), "") << "the recording with the key is closed in any case";
  EXPECT_THAT(said, Contains(AllOf(HasSubstr("nothing is recorded until the next exercise"),
                                   HasSubstr("start this program again"))));
  EXPECT_TRUE(session->held_stopped());
  const auto closed = fs::file_size(moved / between.filename());
  EXPECT_EQ(recording_state(summarise_recording(moved / between.filename(), key_of(sim1))), "whole");
  EXPECT_EQ(delete_by_command(sim1), "");
  pass(1.0);
  EXPECT_EQ(fs::file_size(moved / between.filename()), closed);

  fs::remove(folder / "rec");
  begin_exercise(sim2);
  EXPECT_THAT(status().recording, EndsWith(".mcap.enc"));
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return status().stage == Stage::kEnded; }));
  ASSERT_EQ(release_key(sim2), "");
  EXPECT_EQ(session->info()->scene, "first_touch") << "the station of the first patient is not its own";
}

TEST_F(OwnRecordings, OfAStationThatCannotBeMadeAgainAreNamedToo) {
  const fs::path scene = folder / "own.toml";
  fs::copy_file(folder / "share/scenes/first_touch.toml", scene);
  ASSERT_EQ(load(scene.string()), "");
  static_cast<void>(carry_out(sim1));
  fs::remove(scene);
  EXPECT_EQ(release_key(sim1), "");
  EXPECT_THAT(
      said, Contains(AllOf(HasSubstr("nothing is recorded until the next exercise"), HasSubstr("own.toml"))));
  EXPECT_TRUE(session->held_stopped());
  EXPECT_EQ(delete_by_command(sim1), "");
}

TEST_F(OwnRecordings, AnOwnerWhoDoesNotAnswerPreventsTheDeletionInWords) {
  static_cast<void>(carry_out(sim1));
  std::string refused;
  try {
    exercises->release_key(sim1.record);  // on this thread: nothing serves the station meanwhile
  } catch (const std::runtime_error& error) {
    refused = error.what();
  }
  EXPECT_THAT(refused, AllOf(HasSubstr("is not closed after 15 s"), HasSubstr("then delete the patient")));
  EXPECT_THAT(delete_by_command(sim1), HasSubstr("records with the key"));
  try {
    static_cast<void>(order(sim2));
    ADD_FAILURE() << "it began";
  } catch (const std::runtime_error& busy) {
    EXPECT_THAT(std::string(busy.what()), HasSubstr("own recording is being begun"));
  }
  ASSERT_TRUE(until([&] { return recorder->recording()->file.extension() == ".mcap"; })) << "when it answers";
  pass(0.1);
  EXPECT_EQ(delete_by_command(sim1), "");
  EXPECT_EQ(order(sim2), 2U);
}

}  // namespace
}  // namespace phalanx::test
