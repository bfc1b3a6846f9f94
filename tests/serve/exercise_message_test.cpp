// SPDX-License-Identifier: Apache-2.0
#include "serve/exercise_message.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string>

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

ExerciseStatus running() {
  ExerciseStatus status;
  status.stage = ExerciseStatus::Stage::kRunning;
  status.number = 3;
  status.record = std::string(32, 'a');
  status.code = "P07";
  status.symbol = "otter";
  status.side = "left";
  status.exercise.name = "press";
  status.exercise.title = "Press and hold";
  status.exercise.kind = ExerciseKind::kTraining;
  status.exercise.measure = ExerciseMeasure::kPressAndHold;
  status.view.phase = ExercisePhase::kTrial;
  status.view.trial = 2;
  status.view.trials = 5;
  status.view.remaining_s = 1.5;
  status.view.value = 1.25;
  status.view.value_unit = "N";
  status.view.target.kind = ExerciseTarget::Kind::kForce;
  status.view.target.digits = {false, true, false, true, false};
  status.view.target.force = {std::numeric_limits<double>::quiet_NaN(), 2.0, 0.0, 3.0, 0.0};
  status.view.target.low = 1.5;
  status.view.target.high = 2.5;
  status.flexion = {0.0, 0.25, 0.5, 0.75, 1.0};
  Observation newest;
  newest.force = {0.0, 1.25, 0.0, 0.0, 0.0};
  newest.touching = {false, true, false, false, false};
  newest.pad[0] = Vec3(0.01, 0.0, 0.0);
  for (std::size_t d = 1; d < newest.pad.size(); ++d)
    newest.pad[d] = Vec3(0.01, 0.03 * static_cast<double>(d), 0.0);
  status.newest = newest;
  return status;
}

wire::Exercise written(const ExerciseStatus& status) {
  wire::Exercise out;
  out.set_note("of before");
  write_exercise(status, out);
  return out;
}

TEST(ExerciseMessage, HasWhatAPageShowsInItsUnits) {
  const wire::Exercise out = written(running());
  EXPECT_EQ(out.number(), 3U);
  EXPECT_EQ(out.name(), "press");
  EXPECT_EQ(out.title(), "Press and hold");
  EXPECT_EQ(out.measure(), "press_and_hold");
  EXPECT_TRUE(out.training());
  EXPECT_EQ(out.symbol(), "otter");
  EXPECT_EQ(out.side(), "left");
  EXPECT_EQ(out.note(), "");
  EXPECT_EQ(out.stage(), wire::Exercise::STAGE_RUNNING);
  EXPECT_EQ(out.phase(), wire::Exercise::PHASE_TRIAL);
  EXPECT_EQ(out.trial(), 2U);
  EXPECT_EQ(out.trials(), 5U);
  EXPECT_EQ(out.remaining(), 1.5F);
  EXPECT_EQ(out.value(), 1.25F);
  EXPECT_EQ(out.value_unit(), "N");
  EXPECT_EQ(out.target().kind(), wire::Exercise::Target::FORCE);
  EXPECT_THAT(out.target().digit(), ElementsAre(1U, 3U));
  ASSERT_THAT(out.target().force(), SizeIs(5));
  EXPECT_TRUE(std::isnan(out.target().force(0)));
  EXPECT_EQ(out.target().force(1), 2.0F);
  EXPECT_EQ(out.target().low(), 1.5F);
  EXPECT_EQ(out.target().high(), 2.5F);
  EXPECT_THAT(out.flexion(), ElementsAre(0.0F, 0.25F, 0.5F, 0.75F, 1.0F));
  EXPECT_THAT(out.force(), ElementsAre(0.0F, 1.25F, 0.0F, 0.0F, 0.0F));
  EXPECT_THAT(out.touching(), ElementsAre(false, true, false, false, false));
  EXPECT_THAT(out.pad_distance(), ElementsAre(0.03F, 0.06F, 0.09F, 0.12F));
  EXPECT_THAT(out.SerializeAsString(), Not(HasSubstr("P07"))) << "the code is for pages with a session";
  EXPECT_THAT(out.SerializeAsString(), Not(HasSubstr("aaaa")));
}

TEST(ExerciseMessage, OfAHiddenSceneHasNeitherHandNorContactsNorForces) {
  ExerciseStatus status = running();
  status.view.hides_scene = true;
  status.view.value.reset();
  status.view.target.kind = ExerciseTarget::Kind::kExplore;
  status.view.target.depth = 0.004;
  status.view.target.sponge = 1;
  const wire::Exercise out = written(status);
  EXPECT_TRUE(out.hides_scene());
  EXPECT_THAT(out.flexion(), IsEmpty());
  EXPECT_THAT(out.force(), IsEmpty());
  EXPECT_THAT(out.touching(), IsEmpty());
  EXPECT_THAT(out.pad_distance(), IsEmpty());
  EXPECT_FALSE(out.has_value());
  EXPECT_EQ(out.target().depth(), 0.004F);
  EXPECT_EQ(out.target().sponge(), 1);
  EXPECT_THAT(out.target().force(), IsEmpty());
}

TEST(ExerciseMessage, AsksForTheRatingAndNamesTheAnswers) {
  ExerciseStatus status = running();
  status.view.phase = ExercisePhase::kRating;
  status.view.asks = ExerciseInput::Kind::kFatigue;
  status.view.choices = {"first", "second"};
  status.newest.reset();
  const wire::Exercise out = written(status);
  EXPECT_EQ(out.phase(), wire::Exercise::PHASE_RATING);
  EXPECT_EQ(out.asks(), wire::Feel::TIRED);
  EXPECT_THAT(out.choice(), ElementsAre("first", "second"));
  EXPECT_THAT(out.force(), IsEmpty()) << "no step has been observed";
  EXPECT_THAT(out.pad_distance(), IsEmpty());
}

TEST(ExerciseMessage, BeforeTheFirstExerciseIsEmpty) {
  const wire::Exercise out = written({});
  EXPECT_EQ(out.number(), 0U);
  EXPECT_THAT(out.SerializeAsString(), IsEmpty());
}

TEST(ExerciseMessage, AnExerciseRunsFromItsOrderToItsResult) {
  using Stage = ExerciseStatus::Stage;
  for (const Stage stage : {Stage::kOpening, Stage::kRunning, Stage::kClosing})
    EXPECT_TRUE(exercise_runs({.stage = stage}));
  for (const Stage stage : {Stage::kNone, Stage::kEnded}) EXPECT_FALSE(exercise_runs({.stage = stage}));
}

TEST(PatientState, TellsOfTorqueAndFaultsAndOfNothingElse) {
  wire::State state;
  state.set_safety(wire::SAFETY_FAULT);
  state.set_held_stopped(true);
  state.set_stops(4);
  state.mutable_fault()->set_name("no_sample");
  state.mutable_fault()->set_report("/home/p07");
  state.set_scene("two_sponges");
  state.set_operator_name("Anna");
  state.add_value()->set_key("force.stiffness_n_per_mm");
  state.set_range("p07.toml");
  state.set_geometry(9);
  state.set_busy("force.stiffness_n_per_mm = 0.3");
  wire::State out;
  write_patient_state(state, out);
  EXPECT_EQ(out.safety(), wire::SAFETY_FAULT);
  EXPECT_TRUE(out.held_stopped());
  EXPECT_EQ(out.stops(), 4U);
  EXPECT_EQ(out.fault().name(), "no_sample");
  EXPECT_EQ(out.geometry(), 0U);
  for (const char* text : {"p07", "two_sponges", "Anna", "stiffness"})
    EXPECT_THAT(out.SerializeAsString(), Not(HasSubstr(text)));
}

}  // namespace
}  // namespace phalanx
