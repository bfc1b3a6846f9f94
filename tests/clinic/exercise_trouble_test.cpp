// SPDX-License-Identifier: Apache-2.0
// What becomes of an exercise when its opening, its changes or its end are refused, or the registry does not answer.
#include <algorithm>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include "clinic/exercise_clinic.h"
#include "phalanx/exercise/reasons.h"
#include "phalanx/record/recorded_exercise.h"
#include "phalanx/record/recordings.h"
#include "registry/private_file.h"

namespace phalanx::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class ExerciseTrouble : public ExerciseClinic {
 protected:
  void SetUp() override {
    begin_station();
    ASSERT_TRUE(until_running());
  }
  void own() override {
    const double before = clock.now();
    if (polls) session->poll();
    if (exercises) exercises->tick();
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
    longest_own = std::max(longest_own, clock.now() - before);
  }
  bool until_ended() {
    return until([&] { return status().stage == Stage::kEnded; });
  }
  /// Holds the registry as another program does, or as a disk that does not answer.
  [[nodiscard]] registry::FileLock hold_registry() const {
    return registry::FileLock(folder.path() / "clinic/data/lock");
  }

  /// Asks for changes until the session takes no more, also when its worker has made those that wait.
  void fill_the_queue() {
    for (int refused = 0; refused < 50; sleep(0.001)) {
      try {
        for (;; refused = 0) session->calibrate({.kind = WizardStep::Kind::kSkip}, {});
      } catch (const std::runtime_error&) {
        ++refused;
      }
    }
  }

  bool polls = true;  ///< the owner fetches the session's answers
  double longest_own =
      0.0;  ///< time of the held clock for which the owner's thread has waited in its work [s]
};

// The profile states the side of the hand, and a person may exchange its file at any time. Only the station that has opened
// tells it.
TEST_F(ExerciseTrouble, ARefusalAfterTheOpeningLeavesAStoppedStationWhoseStepsStayEncrypted) {
  Patient patient = ready_patient("SIM3");
  patient.own_force_n.fill(4.0);
  patient.profile = (folder / "share/assets/profiles/large-man.toml").string();
  patient = registry->add_patient(Actor::owner(), patient);
  const fs::path plain = recorder->recording()->file;
  static_cast<void>(order(patient));
  ASSERT_TRUE(until_ended());
  EXPECT_THAT(status().trouble, AllOf(HasSubstr("the exercise cannot begin"), HasSubstr("left hand")));
  EXPECT_THAT(status().trouble_without_code, Not(HasSubstr("SIM3")));
  EXPECT_FALSE(status().result.has_value());
  EXPECT_FALSE(status().forces_off);
  pass(0.5);
  EXPECT_TRUE(session->held_stopped());
  EXPECT_FALSE(any_torque(session->view()));
  const fs::path file = recorder->recording()->file;
  EXPECT_NE(file, plain);
  EXPECT_THAT(file.string(), EndsWith(".mcap.enc")) << "the station has the patient's hand";
  EXPECT_THAT(results(patient), IsEmpty());

  begin_exercise(sim1);
  EXPECT_EQ(recording_state(summarise_recording(file, key_of(patient))), "whole");
  EXPECT_THAT(recorded_exercises(file, key_of(patient)), IsEmpty());
}

TEST_F(ExerciseTrouble, AStationThatCannotBeMadeAgainAtTheEndIsTriedAgainUntilItCan) {
  const fs::path scene = folder / "share/scenes/own_ball.toml";
  fs::copy_file(folder / "share/scenes/index_ball.toml", scene);
  {
    std::ifstream shipped(folder / "share/assets/exercises/short.toml");
    std::string text{std::istreambuf_iterator<char>(shipped), {}};
    const std::string name = "scene = \"index_ball\"";
    text.replace(text.find(name), name.size(), "scene = \"own_ball\"");
    std::ofstream(folder / "share/assets/exercises/own_scene.toml") << text;
  }
  static_cast<void>(order(sim1, "healthy", "own_scene"));
  ASSERT_TRUE(until_stage(Stage::kRunning));
  input(Kind::kBegin);
  ASSERT_TRUE(until([&] { return session->view().state == SafetyState::kRunning; }));
  fs::rename(scene, folder / "gone.toml");
  input(Kind::kAbort);
  ASSERT_TRUE(until([&] { return !status().trouble.empty(); }));
  EXPECT_EQ(status().stage, Stage::kClosing);
  EXPECT_THAT(status().trouble, AllOf(HasSubstr("cannot be ended yet"), HasSubstr("own_ball"),
                                      HasSubstr("It is tried again each 10 s")));
  EXPECT_TRUE(session->held_stopped());
  fs::rename(folder / "gone.toml", scene);
  ASSERT_TRUE(until_ended());
  EXPECT_EQ(status().trouble, "");
  EXPECT_THAT(results(sim1), SizeIs(1));
}

// The session takes no more changes, as when their answers are not fetched.
TEST_F(ExerciseTrouble, AChangeOfTheSceneThatTheSessionDoesNotTakeEndsTheExerciseInWords) {
  static_cast<void>(order(sim1, "healthy", "object_in_hand"));
  ASSERT_TRUE(until_stage(Stage::kRunning));
  polls = false;
  fill_the_queue();
  input(Kind::kBegin);
  input(Kind::kSkip);  // the warm-up
  ASSERT_TRUE(until([&] { return status().stage == Stage::kClosing; }));
  EXPECT_THAT(said, Contains(AllOf(HasSubstr("the scene cannot be changed"), HasSubstr("changes wait"),
                                   HasSubstr("the exercise ends"))));
  EXPECT_TRUE(session->held_stopped());
  polls = true;
  ASSERT_TRUE(until_ended());
  ASSERT_TRUE(status().result.has_value()) << status().trouble;
  EXPECT_TRUE(status().result->interrupted);
}

TEST_F(ExerciseTrouble, ARegistryThatAnotherProgramHoldsRefusesTheBeginInWords) {
  const registry::FileLock held = hold_registry();
  try {
    static_cast<void>(order(sim1));
    ADD_FAILURE() << "it began";
  } catch (const RegistryError& refused) {
    EXPECT_EQ(refused.fault(), RegistryFault::kBusy);
    EXPECT_THAT(std::string(refused.what()), AllOf(HasSubstr("process"), HasSubstr("has held"),
                                                   HasSubstr("wait until it is done, or end it")));
  }
  EXPECT_EQ(status().stage, Stage::kNone);
  EXPECT_FALSE(session->held_stopped());
}

TEST_F(ExerciseTrouble, ARegistryThatHangsWhileTheStationOpensNeitherDelaysAStopNorBeginsTheExercise) {
  static_cast<void>(order(sim1));
  const registry::FileLock held = hold_registry();
  pass(3.0);
  EXPECT_EQ(status().stage, Stage::kOpening);
  EXPECT_TRUE(session->held_stopped()) << "forces wait for the exercise";
  ASSERT_TRUE(until_ended());
  EXPECT_THAT(status().trouble, AllOf(HasSubstr("the exercise cannot begin"), HasSubstr("has held")));
  EXPECT_EQ(longest_own, 0.0);
}

TEST_F(ExerciseTrouble, AStopActsWithinAStepWhileTheRegistryHangs) {
  begin_exercise(sim1);
  const registry::FileLock held = hold_registry();
  std::jthread page([this] { EXPECT_THROW(static_cast<void>(results(sim1)), RegistryError); });
  pass(1.0);  // the page's thread waits for the registry by now
  ASSERT_EQ(session->view().state, SafetyState::kRunning);
  const double asked = clock.now();
  const std::uint64_t tick = session->view().snapshot.tick;
  input(Kind::kPause);
  EXPECT_EQ(clock.now(), asked) << "the pause waits for nothing";
  ASSERT_TRUE(until([&] { return session->view().state != SafetyState::kRunning; }));
  EXPECT_LE(session->view().snapshot.tick - tick, 2U) << "the step that had begun, and the next one";
  ASSERT_TRUE(until([&] { return session->view().at_rest; }));
  EXPECT_LT(clock.now() - asked, 0.3) << "the ramp of 0.2 s";
  page.join();
  EXPECT_EQ(longest_own, 0.0) << "the owner's thread does not wait for the registry";
}

TEST_F(ExerciseTrouble, AResultWaitsForARegistryThatAnotherProgramHolds) {
  begin_exercise(sim1);
  {
    const registry::FileLock held = hold_registry();
    input(Kind::kAbort);
    ASSERT_TRUE(until([&] { return !status().trouble.empty(); }));
    EXPECT_EQ(status().stage, Stage::kClosing);
    EXPECT_THAT(status().trouble,
                AllOf(HasSubstr("the result waits for the registry"), HasSubstr("process")));
    pass(30.0);
    EXPECT_EQ(status().stage, Stage::kClosing);
    EXPECT_EQ(std::count_if(said.begin(), said.end(),
                            [](const std::string& text) { return text.starts_with("the result waits"); }),
              1);
    EXPECT_EQ(longest_own, 0.0);
  }
  ASSERT_TRUE(until_ended());
  EXPECT_EQ(status().trouble, "");
  EXPECT_THAT(results(sim1), SizeIs(1));
}

TEST_F(ExerciseTrouble, AProgramThatEndsWhileTheRegistryIsHeldKeepsTheRecordingForTheNextExercise) {
  begin_exercise(sim1);
  ASSERT_TRUE(until([&] { return status().view.trial == 2; }));
  {
    const registry::FileLock held = hold_registry();
    end();
  }
  EXPECT_THAT(status().trouble, AllOf(HasSubstr("is kept"), HasSubstr("has held")));
  EXPECT_THAT(results(sim1), IsEmpty());
  EXPECT_THAT(registry->recordings_without_result(Actor::owner(), sim1.record), SizeIs(1));
}

// The lock is freed after the result was refused. A dose in its place would hide the scores from the next exercise.
TEST_F(ExerciseTrouble, AProgramThatEndsShortlyBeforeTheRegistryIsFreeKeepsNoDoseInPlaceOfTheScores) {
  begin_exercise(sim1);
  ASSERT_TRUE(until([&] { return status().view.trial == 2; }));
  std::optional<registry::FileLock> held(std::in_place, folder.path() / "clinic/data/lock");
  const double freed = clock.now() + 12.0;
  std::jthread other([&] {
    clock.sleep_until(freed);
    held.reset();
  });
  end();
  other.join();
  for (const ResultRow& row : results(sim1))
    EXPECT_NE(row.invalid, reason_text<Reason::kNoResultFromRecording>());
  EXPECT_THAT(registry->recordings_without_result(Actor::owner(), sim1.record),
              SizeIs(1 - results(sim1).size()));
}

}  // namespace
}  // namespace phalanx::test
